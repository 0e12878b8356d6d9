"""The words that roslaunch and rosrun give to a node of ROS 1 on the command line of its program.

    __name:=left  __ns:=/robot  chatter:=/news  _gain:=2.5

Rules: the words are those of rospy; ROS_NAMESPACE counts where `__ns` is not said. Everything that
has no `:=` in it is the program's own. Names with a slash in front are full ones.
"""

from __future__ import annotations

import ast
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

from yarpy.peers.ros.graph_name import check_graph_name

NAMESPACE: Final = "ROS_NAMESPACE"
_WORD: Final = ":="
_TRUTH: Final = {"true": True, "false": False, "yes": True, "no": False, "null": None}


@dataclass(frozen=True)
class Arguments:
    """The arguments: `special` words (`__name` without the lines), `remaps` of names as they were
    written, and `parameters` of the node; `rest` is the program's own."""

    special: Mapping[str, str] = field(default_factory=dict)
    remaps: Mapping[str, str] = field(default_factory=dict)
    parameters: Mapping[str, Any] = field(default_factory=dict)
    rest: tuple[str, ...] = ()
    namespace: str = ""  # of the environment

    def node(self, asked: str) -> str:
        """Return the full name of a node that its program calls `asked`. Raises AddressError."""
        said = self.special.get("ns", self.namespace).strip("/")
        named = self.special.get("name", "")
        if not named and asked.startswith("/") and "ns" not in self.special:
            return check_graph_name(asked)
        inner, _, last = asked.strip("/").rpartition("/")
        parts = (said or inner, named.strip("/") or last)
        return check_graph_name("/" + "/".join(part for part in parts if part))

    def remap(self, whole: str, node: str) -> str:
        """Return what takes the place of a topic, service or parameter with its name in full.
        Raises AddressError."""
        for old, new in self.remaps.items():
            if expand(old, node) == whole:
                return expand(new, node)
        return whole


def expand(name: str, node: str) -> str:
    """Return the name in full: `~x` is below the node's own name, `x` beside the node. Raises
    AddressError."""
    if name.startswith("~"):
        name = f"{node}/{name[1:].lstrip('/')}"
    elif not name.startswith("/"):
        name = f"{node.rpartition('/')[0]}/{name}"
    return check_graph_name(name)


def parse_arguments(argv: Sequence[str], environment: Mapping[str, str] = os.environ) -> Arguments:
    """Read a command line, without the name of the program or with it."""
    special: dict[str, str] = {}
    remaps: dict[str, str] = {}
    parameters: dict[str, Any] = {}
    rest = []
    for word in argv:
        name, found, value = word.partition(_WORD)
        if not found or not name or word.startswith("-"):
            rest.append(word)
        elif name.startswith("__"):
            special[name[2:]] = value
        elif name.startswith("_"):
            parameters[name[1:]] = parse_value(value)
        else:
            remaps[name] = value
    return Arguments(special, remaps, parameters, tuple(rest), environment.get(NAMESPACE, ""))


def parse_value(text: str) -> Any:
    """The value of a parameter as it is written: a number, a truth value, a list or dict of them,
    else the text itself, as of YAML what can be written in one word of a command line."""
    if text.lower() in _TRUTH:
        return _TRUTH[text.lower()]
    try:
        import yaml
    except ImportError:
        return _literal(text)
    try:
        return yaml.safe_load(text)
    except (yaml.YAMLError, ValueError, RecursionError):
        return text


def _literal(text: str) -> Any:
    try:
        return ast.literal_eval(text)
    except (ValueError, SyntaxError, MemoryError, RecursionError):
        return text
