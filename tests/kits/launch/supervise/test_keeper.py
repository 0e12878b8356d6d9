"""Connections that are kept: made when both ports are there, and again when one comes back."""

import pytest
from support.system import NO_MARKS
from support.wait import HANG, wait_until

import yarpy
from yarpy.errors import UnknownName
from yarpy.kits.launch.application.application import Connection
from yarpy.kits.launch.document.problem import Where
from yarpy.kits.launch.supervise import keeper as keeper_
from yarpy.kits.launch.supervise.keeper import Keeper


def test_a_connection_is_made_and_made_again(network: yarpy.LocalNames) -> None:
    keeper = Keeper([Connection("/out", "/in", "fast_tcp")], network)
    (link,) = keeper.links
    keeper.start()
    try:
        wait_until(lambda: link.detail == "for /out")
        with yarpy.Port("/out", names=network) as out:
            wait_until(lambda: link.detail == "for /in")
            for made in (1, 2):
                with yarpy.BufferedPort("/in", names=network):
                    keeper.touch()
                    assert out.wait_for_outputs(timeout=HANG)
                    wait_until(lambda made=made: link.made == made and link.state == "connected")
                    assert [one.target for one in out.outputs] == ["/in"]
                wait_until(lambda: link.state == "waiting")
            with yarpy.BufferedPort("/in", names=network):
                wait_until(lambda: link.state == "connected")
                out.disconnect("/in")  # somebody else does
                wait_until(lambda: link.made == 4 or (out.outputs and link.made == 3))
                assert out.wait_for_outputs(timeout=HANG)
    finally:
        keeper.close()


def test_a_port_that_does_not_come_may_have_another_name(
    network: yarpy.LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(keeper_, "_HURRY", 0.0)
    keeper = Keeper([Connection("/robot/camera", "/in")], network)
    (link,) = keeper.links
    with yarpy.Port("/robot/cameras", names=network), yarpy.BufferedPort("/in", names=network):
        keeper.start()
        try:
            wait_until(lambda: link.detail == 'for /robot/camera: did you mean "/robot/cameras"?')
            with yarpy.Port("/robot/camera", names=network):
                wait_until(lambda: link.state == "connected" and not link.detail)
        finally:
            keeper.close()


def test_one_that_is_refused_says_why(network: yarpy.LocalNames) -> None:
    keeper = Keeper([Connection("/out", "/in", "nonsense")], network)
    (link,) = keeper.links
    with yarpy.Port("/out", names=network), yarpy.Port("/in", names=network):
        keeper.start()
        try:
            wait_until(lambda: link.state == "refused")
            assert "nonsense" in link.detail
        finally:
            keeper.close()


def test_only_connections_of_others_are_ended(network: yarpy.LocalNames) -> None:
    both = Connection("/out", "/in", source_external=True, target_external=True)
    own = Connection("/out", "/own", source_external=True)
    keeper = Keeper([both, own], network)
    with (
        yarpy.Port("/out", names=network) as out,
        yarpy.BufferedPort("/in", names=network),
        yarpy.BufferedPort("/own", names=network),
    ):
        keeper.start()
        wait_until(lambda: all(link.made and not link.busy for link in keeper.links))
        keeper.close()
        assert [one.target for one in out.outputs] == ["/own"]


@pytest.mark.skipif(bool(NO_MARKS), reason=NO_MARKS)
def test_priorities_are_asked_for(network: yarpy.LocalNames) -> None:
    wanted = Connection("/out", "/in", source_qos="level:high")
    keeper = Keeper([wanted], network)
    with yarpy.Port("/out", names=network), yarpy.BufferedPort("/in", names=network):
        keeper.start()
        try:
            wait_until(lambda: keeper.links[0].state == "connected")
            sender, _ = yarpy.network.qos.granted("/out", "/in", network)
            assert sender.tos == 144
        finally:
            keeper.close()


def test_one_that_is_let_go_stays_so_until_it_is_taken_up(network: yarpy.LocalNames) -> None:
    keeper = Keeper([Connection("/out", "/in")], network)
    (link,) = keeper.links
    with yarpy.Port("/out", names=network) as out, yarpy.BufferedPort("/in", names=network):
        keeper.start()
        try:
            wait_until(lambda: link.state == "connected" and not link.busy)
            keeper.let_go("/out", "/in")
            wait_until(lambda: not out.outputs)
            keeper.touch()
            assert link.state == "off" and link.settled and link.made == 1
            keeper.take_up("/out", "/in")
            wait_until(lambda: link.made == 2)
            with pytest.raises(UnknownName, match="has no connection /out -> /other"):
                keeper.let_go("/out", "/other")
        finally:
            keeper.close()


def test_others_instead(network: yarpy.LocalNames) -> None:
    stays, goes = Connection("/out", "/a"), Connection("/out", "/b")
    keeper = Keeper([stays, goes], network)
    with (
        yarpy.Port("/out", names=network) as out,
        yarpy.BufferedPort("/a", names=network),
        yarpy.BufferedPort("/b", names=network),
        yarpy.BufferedPort("/c", names=network),
    ):
        keeper.start()
        try:
            wait_until(lambda: all(one.made and not one.busy for one in keeper.links))
            moved = Connection("/out", "/a", where=Where("f", 7, 1))
            keeper.replace([moved, Connection("/out", "/c")])
            wait_until(lambda: {one.target for one in out.outputs} == {"/a", "/c"})
            assert keeper.links[0].made == 1
        finally:
            keeper.close()


def test_nothing_is_made_at_rest(network: yarpy.LocalNames) -> None:
    keeper = Keeper([Connection("/out", "/in")], network)
    with yarpy.Port("/out", names=network) as out, yarpy.BufferedPort("/in", names=network):
        keeper.rest()
        keeper.start()
        try:
            keeper.touch()
            assert keeper.links[0].state == "off" and not out.outputs
            keeper.take_up("/out", "/in")
            assert out.wait_for_outputs(timeout=HANG)
        finally:
            keeper.close()
