"""Controllers and variables of a remote board: what is asked for them."""

import pytest

from yarpy.kits.devices.control_board.remote_parts import RemotePids, RemoteVariables


def test_controllers(parrot, ask):
    pids = RemotePids(ask, "vel")
    numbers = " ".join(f"{value}.0" for value in range(10))
    parrot.answers |= {
        "[get] [pid] [pids] [vel]": f"[is] [pid] (({numbers}) ({numbers}) ({numbers})) [ok]",
        "[get] [pid] [errs] [vel]": "[is] [pid] (1.0 2.0 3.0) [ok]",
        "[get] [pid] [outs] [vel]": "[is] [pid] (1.0 2.0 3.0) [ok]",
        "[get] [pid] [ena] [vel] 0": "[is] [pid] 1 [ok]",
        "[get] [pid] [ena] [vel] 1": "[is] [pid] 0 [ok]",
        "[get] [pid] [ena] [vel] 2": "[is] [pid] 0 [ok]",
    }
    assert pids.gains[2].ki == 2.0 and pids.offsets == (5.0, 5.0, 5.0)
    assert pids.errors() == pids.outputs() == [1.0, 2.0, 3.0]
    assert pids.enabled == (True, False, False)
    parrot.heard.clear()
    pids.enabled = (False, True, True)
    pids.targets = (1.0, 2.0, 3.0)
    pids.offsets = (1.0, 2.0, 3.0)
    pids.reset([1])
    pids.gains = [range(10)] * 3
    assert parrot.heard == [
        "[set] [pid] [dis] [vel] 0",
        "[set] [pid] [ena] [vel] 1",
        "[set] [pid] [ena] [vel] 2",
        "[set] [pid] [refs] [vel] (1.0 2.0 3.0)",
        "[set] [pid] [off] [vel] 0 1.0",
        "[set] [pid] [off] [vel] 1 2.0",
        "[set] [pid] [off] [vel] 2 3.0",
        "[set] [pid] [res] [vel] 1",
        "[set] [pid] [pids] [vel] ((0 1 2 3 4 5 6 7 8 9) (0 1 2 3 4 5 6 7 8 9) "
        "(0 1 2 3 4 5 6 7 8 9))",
    ]


def test_variables(parrot, ask):
    variables = RemoteVariables(ask)
    parrot.answers |= {
        "[get] [ivar] [lvar]": "[is] [ivar] (gain limit) [ok]",
        "[get] [ivar] [mvar] gain": "[is] [ivar] (1.5 low) [ok]",
        "[get] [ivar] [mvar] none": "[fail]",
    }
    assert [*variables] == ["gain", "limit"] and len(variables) == 2
    assert variables["gain"] == [1.5, "low"]
    assert variables.get("none") is None
    parrot.heard.clear()
    variables["gain"] = [2, "high"]
    variables["limit"] = 7.5
    assert parrot.heard == ["[set] [ivar] [mvar] gain 2 high", "[set] [ivar] [mvar] limit 7.5"]
    with pytest.raises(TypeError):
        del variables["gain"]
