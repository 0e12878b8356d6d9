"""Drawings for Graphviz."""

from yarpy.kits.launch.application.application import Application, Connection, Module
from yarpy.kits.launch.manager.drawing import dot


def test_programs_ports_and_connections() -> None:
    found = dot(
        Application(
            modules=[Module('a"b', "x")],
            connections=[Connection("/a", "/b", "udp"), Connection("/a", "/c")],
        )
    )
    assert found.splitlines() == [
        "digraph G {",
        "rankdir=LR;",
        '"a\\"b" [shape=component];',
        '"/a" [shape=ellipse];',
        '"/b" [shape=ellipse];',
        '"/c" [shape=ellipse];',
        '"/a" -> "/b" [label="udp"];',
        '"/a" -> "/c" [label="tcp"];',
        "}",
    ]
