"""The words that `ros2 run` and `ros2 launch` give to a node on the command line of its program.

    --ros-args -r __node:=left -r __ns:=/robot -r chatter:=/news -p gain:=2.5 --params-file f.yaml

Rules: the words, and which of several counts, are those of rcl. A rule of one node has its name
and a colon in front. Values are YAML as rcl reads it: what is not a number, a truth value or a list
is text. Everything else of a command line is the program's own.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, NamedTuple

from yarpy.errors import AddressError, UnknownPlugin
from yarpy.peers.ros2.name import Node, check_node, check_topic

BEGIN: Final = "--ros-args"
END: Final = "--"
_REMAP: Final = ("-r", "--remap")
_PARAMETER: Final = ("-p", "--param")
_FILE: Final = "--params-file"
#: what they say is not for us: where logs go, and which enclave of SROS 2 the node is in
_SKIPPED: Final = ("-e", "--enclave", "--log-config-file", "--log-file-name")
_LEVEL: Final = "--log-level"
_LOGS: Final = re.compile(r"--(?:enable|disable)-(rosout|stdout|external-lib)-logs")

#: as rcl's parser of YAML has them
_TRUE: Final = {"y", "Y", "yes", "Yes", "YES", "true", "True", "TRUE", "on", "On", "ON"}
_FALSE: Final = {"n", "N", "no", "No", "NO", "false", "False", "FALSE", "off", "Off", "OFF"}
_INTEGER = re.compile(r"[-+]?(?:0[xX][0-9a-fA-F]{1,16}|[0-9]{1,19})")
_DOUBLE = re.compile(
    r"[-+]?(?:(?:[0-9]++\.?[0-9]*+|\.[0-9]++)(?:[eE][-+]?[0-9]++)?|\.(?:inf|Inf|INF|nan|NaN|NAN))"
)
_KEY: Final = "ros__parameters"


class Rule(NamedTuple):
    """`node`: whom it is for, "" for every node; `old` and `new` are names as they were written."""

    node: str
    old: str
    new: str


class Given(NamedTuple):
    """Parameters for the nodes that `pattern` names: `/**`, `/robot/*`, `/robot/arm`."""

    pattern: str
    values: dict[str, Any]


@dataclass(frozen=True)
class Arguments:
    """The arguments; `rest` is the program's own. `log_level` is a name of rcutils, or ""."""

    rules: tuple[Rule, ...] = ()
    parameters: tuple[Given, ...] = ()
    rest: tuple[str, ...] = ()
    log_level: str = ""
    rosout: bool = True

    def node(self, asked: Node) -> Node:
        """Return what a node is called that its program calls `asked`. Raises AddressError."""
        rules = [rule for rule in self.rules if rule.node in ("", asked.name)]
        for rule in rules:
            if rule.old in ("__node", "__name"):
                asked = Node(asked.namespace, check_node(rule.new).name)
                break
        for rule in rules:
            if rule.old == "__ns":
                asked = Node("/" + rule.new.strip("/"), asked.name)
                break
        return check_node(str(asked))

    def remap(self, whole: str, node: Node, kind: str = "rostopic") -> str:
        """Return what takes the place of a topic (or, `kind` being "rosservice", a service) with
        its name in full. Raises AddressError."""
        for rule in self.rules:
            if rule.old.startswith("__") or rule.node not in ("", node.name):
                continue
            scheme, found, name = rule.old.partition("://")
            if found and scheme != kind:
                continue
            if expand(name if found else rule.old, node) == whole:
                return expand(rule.new, node)
        return whole

    def parameters_of(self, node: Node) -> dict[str, Any]:
        """Return the parameters that are set for a node; of several that which was said last."""
        found: dict[str, Any] = {}
        for given in self.parameters:
            if _matches(given.pattern, node):
                found.update(given.values)
        return found


def expand(name: str, node: Node) -> str:
    """Return the name in full of a topic or service of a node: `~/x` is below the node's name,
    `x` beside the node. Raises AddressError."""
    if name.startswith("~"):
        return check_topic(f"{node}/{name[1:].strip('/')}")
    if not name.startswith("/"):
        return check_topic(f"{node.namespace.rstrip('/')}/{name}")
    return check_topic(name)


def parse_arguments(argv: Sequence[str]) -> Arguments:
    """Read a command line, without the name of the program or with it. Raises AddressError for
    words of ROS that are none."""
    rules: list[Rule] = []
    given: list[Given] = []
    rest: list[str] = []
    level, rosout = "", True
    words = iter(argv)
    for word in words:
        if word != BEGIN:
            rest.append(word)
            continue
        for said in words:
            if said == END:
                break
            if said in _REMAP:
                rules.append(_rule(_next(words, said)))
            elif said in _PARAMETER:
                given.append(_parameter(_next(words, said)))
            elif said == _FILE:
                given += read_file(_next(words, said))
            elif said == _LEVEL:
                level = _next(words, said).rpartition(":=")[2]
            elif logs := _LOGS.fullmatch(said):
                rosout = rosout if logs[1] != "rosout" else said.startswith("--enable")
            elif said in _SKIPPED:
                _next(words, said)
            elif said == BEGIN:
                continue
            elif ":=" in said:  # as before -r was needed
                rules.append(_rule(said))
            else:
                raise AddressError(
                    f'"{said[:80]}" behind {BEGIN} is nothing that ROS 2 knows: '
                    f"-r OLD:=NEW, -p NAME:=VALUE, {_FILE} FILE, {END}"
                )
    return Arguments(tuple(rules), tuple(given), tuple(rest), level, rosout)


def read_file(path: str) -> list[Given]:
    """The parameters of a file: nodes, or `/**`, with `ros__parameters` below. Raises AddressError
    for a file that is none; UnknownPlugin without a reader of YAML."""
    try:
        text = Path(path).read_text("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise AddressError(f"{_FILE} {path}: {error}") from error
    found: list[Given] = []
    _walk(_plain(text, path), "", found, path)
    return found


def parse_value(text: str) -> Any:
    """The value of a parameter as it is written. Raises AddressError."""
    return _plain(text, text)


def _next(words: Iterator[str], said: str) -> str:
    found = next(words, None)
    if found is None:
        raise AddressError(f"{said} needs a word behind it")
    return found


def _rule(text: str) -> Rule:
    old, found, new = text.partition(":=")
    scheme, parted, plain = old.partition("://")
    node, colon, name = (plain if parted else old).partition(":")
    if not colon:
        node, name = "", node
    if not found or not name or not new:
        raise AddressError(f'"{text[:80]}" is no remapping: OLD:=NEW, or NODE:OLD:=NEW')
    return Rule(node, f"{scheme}://{name}" if parted else name, new)


def _parameter(text: str) -> Given:
    old, found, value = text.partition(":=")
    node, colon, name = old.partition(":")
    if not colon:
        node, name = "", node
    if not found or not name:
        raise AddressError(f'"{text[:80]}" is no parameter: NAME:=VALUE, or NODE:NAME:=VALUE')
    return Given(f"/**/{node}" if node else "/**", {name: parse_value(value)})


def _walk(tree: Any, where: str, found: list[Given], path: str) -> None:
    """Find the nodes in a file, whose names may be nested by their namespaces."""
    if not isinstance(tree, dict):
        raise AddressError(f'{path}: below "{where or "/"}" are nodes, with {_KEY} below them')
    for key, below in tree.items():
        if key == _KEY:
            found.append(Given(where or "/**", dict(_flat(below, "", path))))
        else:
            _walk(below, f"{where}/{str(key).strip('/')}", found, path)


def _flat(tree: Any, prefix: str, path: str) -> Iterator[tuple[str, Any]]:
    if not isinstance(tree, dict):
        raise AddressError(f"{path}: below {_KEY} are names with values")
    for key, value in tree.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{prefix}{key}.", path)
        else:
            yield f"{prefix}{key}", value


def _matches(pattern: str, node: Node) -> bool:
    """`*` stands for one part of a name, `**` for any number of them."""
    parts = [part for part in pattern.split("/") if part]
    regular = "".join(
        r"(?:/\w+)*" if part == "**" else r"/\w+" if part == "*" else re.escape(f"/{part}")
        for part in parts
    )
    return re.fullmatch(regular, str(node), re.ASCII) is not None


def _plain(text: str, where: str) -> Any:
    """The values of YAML, as rcl has them."""
    try:
        import yaml
    except ImportError as error:
        raise UnknownPlugin("parameters on the command line: pip install 'yarpy[ros2]'") from error
    try:
        return _made(yaml.compose(text, Loader=yaml.SafeLoader), where)
    except (yaml.YAMLError, RecursionError) as error:
        raise AddressError(f"{where[-80:]}: {str(error)[:200]}") from error


def _made(item: Any, where: str) -> Any:
    if item is None:
        return ""
    if isinstance(item.value, str):
        return item.value if item.style in ("'", '"', "|", ">") else _scalar(item.value)
    if item.id == "mapping":
        if any(key.id != "scalar" for key, _ in item.value):
            raise AddressError(f"{where[-80:]}: a name in it is a list")
        return {key.value: _made(value, where) for key, value in item.value}
    values = [_made(each, where) for each in item.value]
    if {int, float} == {type(value) for value in values}:
        values = [float(value) for value in values]
    if len({type(value) for value in values}) > 1:
        raise AddressError(f"{where[-80:]}: the values of a list are of one type")
    return values


def _scalar(text: str) -> bool | int | float | str:
    if text in _TRUE or text in _FALSE:
        return text in _TRUE
    if _INTEGER.fullmatch(text):
        number = int(text, 16 if "x" in text.lower() else 10)
        if -(2**63) <= number < 2**63:
            return number
    if _DOUBLE.fullmatch(text):
        special = text[-3:].lower() in ("inf", "nan")
        return float(text.replace(".", "", 1) if special else text)
    return text
