"""Connections that are kept: made when both ports are there, and again when one comes back."""

import pytest
from support.system import NO_MARKS
from support.wait import HANG, wait_until

import yarpy
from yarpy.errors import UnknownName
from yarpy.kits.launch.application.application import Connection
from yarpy.kits.launch.document.problem import Where
from yarpy.kits.launch.supervise import connections as connections_
from yarpy.kits.launch.supervise.connections import Connections


def test_a_connection_is_made_and_made_again(network: yarpy.LocalNames) -> None:
    connections = Connections([Connection("/out", "/in", "fast_tcp")], network)
    (link,) = connections.links
    connections.start()
    try:
        wait_until(lambda: link.detail == "for /out")
        with yarpy.Port("/out", names=network) as out:
            wait_until(lambda: link.detail == "for /in")
            for made in (1, 2):
                with yarpy.BufferedPort("/in", names=network):
                    connections.touch()
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
        connections.close()


def test_a_port_that_does_not_come_may_have_another_name(
    network: yarpy.LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(connections_, "_HURRY", 0.0)
    connections = Connections([Connection("/robot/camera", "/in")], network)
    (link,) = connections.links
    with yarpy.Port("/robot/cameras", names=network), yarpy.BufferedPort("/in", names=network):
        connections.start()
        try:
            wait_until(lambda: link.detail == 'for /robot/camera: did you mean "/robot/cameras"?')
            with yarpy.Port("/robot/camera", names=network):
                wait_until(lambda: link.state == "connected" and not link.detail)
        finally:
            connections.close()


def test_one_that_is_refused_says_why(network: yarpy.LocalNames) -> None:
    connections = Connections([Connection("/out", "/in", "nonsense")], network)
    (link,) = connections.links
    with yarpy.Port("/out", names=network), yarpy.Port("/in", names=network):
        connections.start()
        try:
            wait_until(lambda: link.state == "refused")
            assert "nonsense" in link.detail
        finally:
            connections.close()


def test_only_connections_of_others_are_ended(network: yarpy.LocalNames) -> None:
    both = Connection("/out", "/in", source_external=True, target_external=True)
    own = Connection("/out", "/own", source_external=True)
    connections = Connections([both, own], network)
    with (
        yarpy.Port("/out", names=network) as out,
        yarpy.BufferedPort("/in", names=network),
        yarpy.BufferedPort("/own", names=network),
    ):
        connections.start()
        wait_until(lambda: all(link.made and not link.busy for link in connections.links))
        connections.close()
        assert [one.target for one in out.outputs] == ["/own"]


@pytest.mark.skipif(bool(NO_MARKS), reason=NO_MARKS)
def test_priorities_are_asked_for(network: yarpy.LocalNames) -> None:
    wanted = Connection("/out", "/in", source_qos="level:high")
    connections = Connections([wanted], network)
    with yarpy.Port("/out", names=network), yarpy.BufferedPort("/in", names=network):
        connections.start()
        try:
            wait_until(lambda: connections.links[0].state == "connected")
            sender, _ = yarpy.network.qos.granted("/out", "/in", network)
            assert sender.tos == 144
        finally:
            connections.close()


def test_one_that_is_let_go_stays_so_until_it_is_taken_up(network: yarpy.LocalNames) -> None:
    connections = Connections([Connection("/out", "/in")], network)
    (link,) = connections.links
    with yarpy.Port("/out", names=network) as out, yarpy.BufferedPort("/in", names=network):
        connections.start()
        try:
            wait_until(lambda: link.state == "connected" and not link.busy)
            connections.let_go("/out", "/in")
            wait_until(lambda: not out.outputs)
            connections.touch()
            assert link.state == "off" and link.settled and link.made == 1
            connections.take_up("/out", "/in")
            wait_until(lambda: link.made == 2)
            with pytest.raises(UnknownName, match="has no connection /out -> /other"):
                connections.let_go("/out", "/other")
        finally:
            connections.close()


def test_others_instead(network: yarpy.LocalNames) -> None:
    stays, goes = Connection("/out", "/a"), Connection("/out", "/b")
    connections = Connections([stays, goes], network)
    with (
        yarpy.Port("/out", names=network) as out,
        yarpy.BufferedPort("/a", names=network),
        yarpy.BufferedPort("/b", names=network),
        yarpy.BufferedPort("/c", names=network),
    ):
        connections.start()
        try:
            wait_until(lambda: all(one.made and not one.busy for one in connections.links))
            moved = Connection("/out", "/a", where=Where("f", 7, 1))
            connections.replace([moved, Connection("/out", "/c")])
            wait_until(lambda: {one.target for one in out.outputs} == {"/a", "/c"})
            assert connections.links[0].made == 1
        finally:
            connections.close()


def test_nothing_is_made_at_rest(network: yarpy.LocalNames) -> None:
    connections = Connections([Connection("/out", "/in")], network)
    with yarpy.Port("/out", names=network) as out, yarpy.BufferedPort("/in", names=network):
        connections.rest()
        connections.start()
        try:
            connections.touch()
            assert connections.links[0].state == "off" and not out.outputs
            connections.take_up("/out", "/in")
            assert out.wait_for_outputs(timeout=HANG)
        finally:
            connections.close()
