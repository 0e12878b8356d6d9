"""What the registry says of nodes' calls is what nodes and other ports answer."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest
from support.wait import HANG

import yarpy
from yarpy.names.node_name import NodeName
from yarpy.peers.ros.node.slave import CALLS
from yarpy.peers.ros.port_graph import ANSWERS, RosGraph


def test_the_calls_are_those_of_the_registry() -> None:
    assert sorted(CALLS) == sorted(call.name for call in RosGraph.calls)
    assert sorted(ANSWERS) == sorted(call.name for call in RosGraph.calls if call.everywhere)


def test_any_port_answers_nodes_and_hangs_up() -> None:
    names = yarpy.LocalNames()
    with yarpy.Port("/arm", names=names) as port:
        for words, value in (
            (["getPid", "/me"], os.getpid()),
            (["pid"], os.getpid()),
            (["rtop", "/me", "/arm"], ["TCPROS", port.contact.host, port.contact.port]),
            (["requestTopic", "/me", "/arm"], ["TCPROS", port.contact.host, port.contact.port]),
        ):
            answered = yarpy.admin("/arm", *words, names=names)
            assert (answered[0], answered[2]) == (1, value)
        assert yarpy.admin("/arm", "rpup", names=names) == [1, "ok"]


def test_a_role_is_found_where_there_is_no_master(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROS_MASTER_URI", raising=False)
    role = RosGraph().role_of(NodeName("/n", "/out", "+"), "", yarpy.LocalNames())
    assert role.port_name == "/out+@/n"
    assert role.declared.graph == "ros"


def test_it_is_imported_without_the_rest_of_the_guest() -> None:
    code = "import sys, yarpy.peers.ros.port_graph; print(*sys.modules)"
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, capture_output=True, text=True, timeout=HANG, check=True)
    assert "yarpy.peers.ros.port_graph" in done.stdout.split()
    assert "yarpy.peers.ros.role" not in done.stdout.split()
