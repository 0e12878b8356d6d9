"""Waiting for ports, for their answers, and for other programs."""

import threading
from types import SimpleNamespace

import pytest
from support.wait import wait_until

import yarpy
from yarpy.kits.launch.application.application import Module, Need
from yarpy.kits.launch.supervise.waiting import Waiting

NEVER = threading.Event()


def waiting(names: yarpy.LocalNames, **units: str) -> Waiting:
    def find(label: str):
        return SimpleNamespace(state=units[label])

    return Waiting(find, 0.3, names)


def unit(*needs: Need, after: tuple[str, ...] = (), node: str = ""):
    module = Module("a", "a", needs=needs, after=after, node=node)
    return SimpleNamespace(module=module, detail="")


def test_a_port_that_comes(network: yarpy.LocalNames) -> None:
    one = unit(Need("/later", 30.0))
    said: list[str] = []
    thread = threading.Thread(target=lambda: said.append(waiting(network).wait(one, NEVER)))
    thread.start()
    wait_until(lambda: one.detail == "for /later")
    assert said == []
    with yarpy.Port("/later", names=network):
        thread.join()
    assert said == [""]


@pytest.mark.parametrize("timeout", [0.0, 0.2, None])
def test_one_that_does_not(network: yarpy.LocalNames, timeout: float | None) -> None:
    seconds = 0.3 if timeout is None else timeout
    said = waiting(network).wait(unit(Need("/never", timeout)), NEVER)
    assert said == f'"/never" is not there after {seconds:g} s'


def test_a_computer_that_boots_later(network: yarpy.LocalNames) -> None:
    one = unit(node="/node")
    said = waiting(network).wait(one, NEVER)
    assert '"/node" (`yarpy run --server /node`) after 0.3 s' in said
    booting: list[str] = []
    patient = Waiting(lambda label: one, 30.0, network)
    thread = threading.Thread(target=lambda: booting.append(patient.wait(one, NEVER)))
    thread.start()
    wait_until(lambda: one.detail.startswith("for /node: "))
    with yarpy.Port("/node", names=network):
        thread.join()
    assert booting == [""]


def test_answers(network: yarpy.LocalNames) -> None:
    with yarpy.RpcServer("/asked", lambda *words: ["Ready", 2], names=network):
        good = Need("/asked", 0.0, "are you", "ready 2")
        assert waiting(network).wait_for(good, NEVER) == ""
        bad = Need("/asked", 0.0, "are you", "no")
        assert '"/asked" answers "Ready 2", not "no"' in waiting(network).wait_for(bad, NEVER)


def test_others(network: yarpy.LocalNames) -> None:
    assert waiting(network, b="running").wait(unit(after=("b",)), NEVER) == ""
    assert waiting(network, b="ended").wait(unit(after=("b",)), NEVER) == ""
    said = waiting(network, b="failed").wait(unit(after=("b",)), NEVER)
    assert said == '"b", after which it starts, has failed'


def test_stopping_ends_it(network: yarpy.LocalNames) -> None:
    stop = threading.Event()
    stop.set()
    one = unit(Need("/x", 600.0), after=("b",))
    assert waiting(network, b="waiting").wait(one, stop) == ""
    assert waiting(network).wait_for(Need("/x", 600.0), stop) == ""
