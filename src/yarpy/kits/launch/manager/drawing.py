"""Drawings of applications in the language of Graphviz: programs as boxes, ports as ellipses.

Rules: pure. Each name stands in quotes, with what quotes need escaped.
"""

from __future__ import annotations

from collections.abc import Iterator

from yarpy.kits.launch.application.application import Application


def dot(application: Application) -> str:
    """Return a directed graph of the programs, and of the connections between ports."""
    return "\n".join(["digraph G {", "rankdir=LR;", *_lines(application), "}"]) + "\n"


def _lines(application: Application) -> Iterator[str]:
    for one in application.modules:
        yield f"{_quoted(one.label)} [shape=component];"
    ports = dict.fromkeys(
        end for one in application.connections for end in (one.source, one.target)
    )
    for port in ports:
        yield f"{_quoted(port)} [shape=ellipse];"
    for link in application.connections:
        label = _quoted(link.carrier or "tcp")
        yield f"{_quoted(link.source)} -> {_quoted(link.target)} [label={label}];"


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", " ")
    return f'"{escaped}"'
