"""`.thrift` files and texts to modules, without a build step.

Rules: a module is what `yarpy idl thrift` would write, run at once; so both have the same classes,
and a file is read again only if it, or one that it includes, has changed.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from types import ModuleType
from typing import Final

from yarpy.kits.thrift.file.include import read_interface, text_interface
from yarpy.kits.thrift.file.interface import Interface
from yarpy.kits.thrift.generate.module import import_line, python

_Stamp = tuple[tuple[str, int, int], ...]

_KNOWN: Final[dict[tuple[str, ...], tuple[_Stamp, ModuleType]]] = {}


def load(
    file: str | os.PathLike[str], folders: Iterable[str | os.PathLike[str]] = ()
) -> ModuleType:
    """The module of a `.thrift` file: its structs, enums, constants and services. Included files
    are looked for beside it, then in `folders`; they are modules in it.

    The same module each time, unless a file has changed. Raises DecodeError (file, line, what was
    expected), OSError, UnknownPlugin without lark.
    """
    paths = [Path(folder) for folder in folders]
    key = (str(Path(file).resolve()), *map(str, paths))
    found = _KNOWN.get(key)
    if found is not None and found[0] == _stamp(each for each, _, _ in found[0]):
        return found[1]
    interface = read_interface(Path(file), paths)
    module = run(interface, {})
    _KNOWN[key] = _stamp(_files(interface, [])), module
    return module


def loads(text: str, name: str = "text") -> ModuleType:
    """The module of an interface that is given as text."""
    return run(text_interface(text, name), {})


def run(interface: Interface, known: dict[int, ModuleType]) -> ModuleType:
    """The module of an interface, with those of the files that it includes."""
    found = known.get(id(interface))
    if found is not None:
        return found
    text = python(interface)
    lines = text.split("\n")
    for name in interface.includes:  # they are there already, wherever they came from
        lines = ["" if line == import_line(name) else line for line in lines]
    made = ModuleType(interface.name, f"The interface {interface.name}.")
    made.__file__ = str(interface.path) if interface.path is not None else None
    space = vars(made)
    for name, other in interface.includes.items():
        space[name] = run(other, known)
    code = compile("\n".join(lines), f"<{interface.document.file}>", "exec", dont_inherit=True)
    exec(code, space)
    for value in list(space.values()):
        own = isinstance(value, type) and value.__module__ == interface.name
        if own and hasattr(value, "_namespace"):
            value._namespace = space  # where its annotations find the names that they mention
    known[id(interface)] = made
    return made


def _files(interface: Interface, found: list[str]) -> list[str]:
    if interface.path is not None and str(interface.path) not in found:
        found.append(str(interface.path))
        for other in interface.includes.values():
            _files(other, found)
    return found


def _stamp(paths: Iterable[str]) -> _Stamp:
    found = []
    for path in paths:
        try:
            status = os.stat(path)
        except OSError:
            found.append((path, 0, 0))
        else:
            found.append((path, status.st_mtime_ns, status.st_size))
    return tuple(found)
