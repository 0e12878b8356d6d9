"""`.thrift` files and texts to interfaces, each with the files that it includes.

Rules: a file is looked for beside the one that includes it, then in the folders that are given. A
file that includes itself, over whatever others, is refused; each file is read once.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

from yarpy.errors import DecodeError
from yarpy.kits.thrift.file.check import checked
from yarpy.kits.thrift.file.interface import Interface
from yarpy.kits.thrift.file.parse import parse
from yarpy.limit import (
    THRIFT_DECLARATIONS,
    THRIFT_INCLUDES,
    THRIFT_TEXT,
)

Read = Callable[[Path], str]


def read_interface(path: Path, folders: Iterable[Path] = (), read: Read | None = None) -> Interface:
    """The interface in a file. What it includes is looked for beside it, then in `folders`.
    DecodeError, OSError."""
    files = _Files([*folders], read or _read)
    return files.interface(path.resolve(), str(path), [])


def text_interface(text: str, name: str = "text") -> Interface:
    """The interface of a text, which includes nothing."""
    document = parse(text, name)
    for include, line in document.includes:
        raise DecodeError(f"{name}:{line}: a text cannot include {include!r}: load a file")
    return checked(Interface(document, None, {}))


def _read(path: Path) -> str:
    with path.open("rb") as file:
        data = file.read(4 * THRIFT_TEXT + 1)  # as many bytes has a text at most
    if len(data) > 4 * THRIFT_TEXT:
        raise DecodeError(f"{path} has more than {THRIFT_TEXT} characters")
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise DecodeError(f"{path}:{line}: the file is not UTF-8 text") from None


class _Files:
    def __init__(self, folders: list[Path], read: Read) -> None:
        self.folders = folders
        self.read = read
        self.known: dict[Path, Interface] = {}
        self.declarations = 0

    def interface(self, path: Path, shown: str, chain: list[Path]) -> Interface:
        found = self.known.get(path)
        if found is not None:
            return found
        document = parse(self.read(path), shown)
        self.declarations += len(document.declarations)
        if self.declarations > THRIFT_DECLARATIONS or len(self.known) > THRIFT_INCLUDES:
            raise DecodeError(f"{shown}: more than {THRIFT_DECLARATIONS} declarations in all")
        includes: dict[str, Interface] = {}
        for include, line in document.includes:
            inner = self._path(include, path)
            if inner is None:
                looked = ", ".join(map(str, [path.parent, *self.folders]))
                raise DecodeError(f'{shown}:{line}: no file "{include}" in {looked}')
            if inner in (*chain, path):
                names = " -> ".join(each.name for each in (*chain, path, inner))
                raise DecodeError(f"{shown}:{line}: files include each other: {names}")
            if inner.stem in includes:
                raise DecodeError(f'{shown}:{line}: two files are called "{inner.stem}"')
            beside = str(Path(shown).parent / include)
            includes[inner.stem] = self.interface(inner, beside, [*chain, path])
        found = self.known[path] = checked(Interface(document, path, includes))
        return found

    def _path(self, include: str, path: Path) -> Path | None:
        for folder in (path.parent, *self.folders):
            candidate = folder / include
            if candidate.is_file():
                return candidate.resolve()
        return None
