"""The layout of robometry's files: a tree of structures, in each leaf the numbers of a channel.

    NAME.mat   NAME.description_list, NAME.yarp_robot_name, NAME.arm.state.{data, dimensions,
               elements_names, units_of_measure, name, timestamps}
    NAME.json  the configuration that writes such files

Rules: pure. `data` has the shape of a sample and, behind it, the number of samples. A part of a
port's name is a field of a structure, with the letters that MATLAB takes; `name` has the name of
the port itself, and is believed where it is one.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any, Final

DESCRIPTION: Final = "description_list"
ROBOT: Final = "yarp_robot_name"
ENDING: Final = ".mat"
NAMED: Final = 1024  # numbers of a channel whose names are written; pixels have none
CONFIGURATION: Final = ".json"
NEEDS: Final = 'files of MATLAB need a library: pip install "yarpy[matlab]"'
LONGEST: Final = 63  # letters of a field
_NAMES: Final = ("elements_names", "units_of_measure")
DEPTH: Final = 30  # structures in structures


def place(tree: dict[str, Any], port: str, leaf: dict[str, Any]) -> None:
    """Put the leaf of a port into a tree; where a name is both a leaf and more, it gets a `_`."""
    *parts, last = [field_name(part) for part in port.split("/") if part] or ["x"]
    for part in parts:
        while is_leaf(tree.get(part)):
            part += "_"
        tree = tree.setdefault(part, {})
    while last in tree:
        last += "_"
    tree[last] = leaf


def field_name(text: str) -> str:
    """Return a name as MATLAB takes it.

    >>> field_name("state:o"), field_name("3d")
    ('state_o', 'x3d')
    """
    found = re.sub(r"[^A-Za-z0-9_]", "_", text)
    return (found if found[:1].isalpha() else f"x{found}")[: LONGEST - 3]


def is_leaf(item: object) -> bool:
    """Return whether it is a channel."""
    return isinstance(item, Mapping) and "timestamps" in item and "data" in item


def leaves(
    tree: Mapping[str, Any], path: str = "", depth: int = DEPTH
) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Yield the channels of a tree, and what their ports are called."""
    for name, item in tree.items():
        if is_leaf(item):
            said = item.get("name")
            yield said if isinstance(said, str) and said[:1] == "/" else f"{path}/{name}", item
        elif isinstance(item, Mapping) and depth:
            yield from leaves(item, f"{path}/{name}", depth - 1)


def configuration(
    name: str, robot: str, lines: list[str], tree: Mapping[str, Any]
) -> dict[str, Any]:
    """Return the configuration of robometry that writes such files into its own folder."""
    found = [*_by_fields(tree)]
    return {
        ROBOT: robot,
        DESCRIPTION: lines or [""],
        "path": "",
        "filename": name,
        "n_samples": max((len(leaf["timestamps"]) for _, leaf in found), default=0),
        "save_period": 0.01,
        "data_threshold": 0,
        "auto_save": True,
        "save_periodically": False,
        "channels": [
            {
                "name": channel,
                "dimensions": [int(size) for size in leaf["dimensions"][:-1]],
                **{key: [*map(str, leaf[key].flat)] for key in _NAMES},
            }
            for channel, leaf in found
        ],
        "enable_compression": False,
        "file_indexing": "time_since_epoch",
        "mat_file_version": "default",
    }


def _by_fields(tree: Mapping[str, Any], path: str = "") -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Yield the channels, and what robometry calls them: `arm::state`."""
    for name, item in tree.items():
        if is_leaf(item):
            yield f"{path}{name}", item
        elif isinstance(item, Mapping):
            yield from _by_fields(item, f"{path}{name}::")
