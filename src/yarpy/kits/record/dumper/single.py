"""One folder of C++ yarpdatadumper, whoever sends: what its classical program writes.

Rules: info.log is there from the beginning. What is no picture has no place in a folder of
pictures: it is refused, so the recorder counts it as lost. A folder that is there is not touched,
unless it is to be written anew: then the logs and the numbered pictures of the recording before go.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from yarpy.errors import LocalProtocolError
from yarpy.kits.record.dumper.part import BOTTLE, DATA, INFO, TYPES, Part, Times, event
from yarpy.kits.record.kind import kind_of

_STORED: Final = re.compile(r"\d{8}\.(?:ppm|pgm|png|jpg|float|floatzip)")


class SingleFolder:
    """A folder at `path` for all that comes.

    type_: `Bottle`, `Image`, `Image:jpg`, `Image:png`, `Depth`, `DepthCompressed`. times: what
    `--rxTime` and `--txTime` of C++ choose, see DumperWriter. every: 3 keeps the third message, the
    sixth, and so on. overwrite: write a folder that is there anew. Raises FileExistsError;
    LocalProtocolError for another type.
    """

    def __init__(
        self,
        path: str | Path,
        type_: str = BOTTLE,
        times: Times = "",
        every: int = 1,
        overwrite: bool = False,
    ) -> None:
        if type_ not in TYPES:
            raise LocalProtocolError(f'no folder of type "{type_}": there are {", ".join(TYPES)}')
        self.path = Path(path)
        self.path.mkdir(parents=True, exist_ok=overwrite)
        for file in self.path.iterdir():
            if file.name in (INFO, DATA) or _STORED.fullmatch(file.name):
                file.unlink()
        self._pictures = type_ != BOTTLE
        self._every = max(1, every)
        self._came = 0
        self.pending = 0
        self._part = Part(self.path, type_, times)

    @property
    def size(self) -> int:
        """Return how many bytes were written."""
        return self._part.size

    def add(self, port: str, envelope: str, received: int, payload: bytes | memoryview) -> None:
        """Take a message. Raises OSError; LocalProtocolError for what cannot be stored."""
        self._came += 1
        if self._came % self._every:
            return
        if self._pictures and kind_of(payload) != "yarp/image":
            raise LocalProtocolError(f"a message of {port} is no picture")
        self._part.add(envelope, received, payload)
        self.pending += 1

    def note(self, what: Mapping[str, Any], received: int) -> None:
        """Take a note about the recording; of connections only, as in C++."""
        port, word = what.get("port"), what.get("what")
        if isinstance(port, str) and word in ("connected", "disconnected"):
            self._part.tell(event(port, received, str(word)))

    def add_metadata(self, name: str, values: Mapping[str, str]) -> None:
        """Do nothing: the format has no place for it."""

    def flush(self) -> None:
        """Hand everything to the system. Raises OSError."""
        self._part.file.flush()
        self.pending = 0

    def sync(self) -> None:
        """The system writes it in its own time."""

    def close(self) -> None:
        """Finish the files. Raises OSError."""
        self._part.file.close()


def classical_folder(wanted: str, overwrite: bool = False) -> Path:
    """Return the folder that C++ chooses for a name, below the working directory: also for one that
    begins with a slash. If it is there, it is the first free one of NAME_00001, NAME_00002 ...,
    unless it is to be written anew.

    >>> classical_folder("/we:ird*/x", overwrite=True).as_posix()
    'we_ird_/x'
    """
    words = [word if word.strip(".") else "_" * len(word) for word in wanted.split("/") if word]
    found = first = Path(*(re.sub(r"[:*?|><\0]", "_", one) for one in words))
    number = 0
    while found.exists() and not overwrite:
        number += 1
        found = first.with_name(f"{first.name}_{number:05}")
    return found
