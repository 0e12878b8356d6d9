"""C++ YARP around our name server beside a ROS master. The C++ YARP that can be had speaks no
tcpros, so it is the registrations that are compared; data flows in tests/nameserver."""

import pytest
from support.cpp import CppYarp
from support.patience import patience
from support.ros_graph import ros_graph
from support.wait import wait_until

import yarpy


def test_topics_of_cpp_are_known_to_the_master(
    cpp: CppYarp, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """`yarp read` and `yarp write` with topics: C++ leaves the calls to the name server."""
    with (
        ros_graph(tmp_path_factory.mktemp("ros")) as graph,
        yarpy.NameServer(ros=graph.uri) as server,
        cpp.at("127.0.0.1", server.port, ROS_MASTER_URI=graph.uri) as peer,
    ):
        with peer.popen("read", "/msg@/cpp_reader"), peer.popen("write", "/chatter@/cpp_writer"):
            for node in ("/cpp_reader", "/cpp_writer"):
                wait_until(lambda node=node: graph.master.node(node), patience(20), node)
            publishers, subscribers, _ = graph.master.state()
            assert ["/chatter", ["/cpp_writer"]] in publishers
            assert ["/msg", ["/cpp_reader"]] in subscribers
            where = graph.master.node("/cpp_reader")
            known = server.client.query("/cpp_reader")
            assert where is not None and known is not None and where.port == known.port
        for node in ("/cpp_reader", "/cpp_writer"):
            wait_until(lambda node=node: graph.master.node(node) is None, patience(20), node)
