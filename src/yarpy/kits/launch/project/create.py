"""Writes a new project: a module with options, an application, and a test that passes.

Rules: what is there already is never touched. The files are texts in `template`, in which only
`$name`, `$package` and the programs that run it are filled in.
"""

from __future__ import annotations

import json
import re
import shutil
import sys
from importlib.resources import files
from keyword import iskeyword
from pathlib import Path
from string import Template
from typing import Final

from yarpy.errors import LocalProtocolError

_NAME: Final = re.compile(r"[a-z][a-z0-9]*(?:[_-][a-z0-9]+)*", re.ASCII)
_LONGEST: Final = 50
_TAKEN: Final = ("yarp", "yarpy", "test", "tests", "pytest")
_FILES: Final = {
    "pyproject.toml.txt": "pyproject.toml",
    "README.md.txt": "README.md",
    "name.ini.txt": "{name}.ini",
    "name.toml.txt": "{name}.toml",
    "init.py.txt": "{package}/__init__.py",
    "module.py.txt": "{package}/module.py",
    "test_module.py.txt": "tests/test_module.py",
}


def create(name: str, folder: Path) -> list[Path]:
    """Write a project called `name` into a new folder of that name in `folder`; return its files.
    Raises LocalProtocolError for a name that is none, or a folder that is there; OSError where it
    cannot be written, and nothing is left of it."""
    package = name.replace("-", "_")
    if not _NAME.fullmatch(name) or len(name) > _LONGEST:
        text = f'"{name}" cannot be the name of a project: write small letters, as in ball_tracker'
        raise LocalProtocolError(text)
    if package in _TAKEN or package in sys.stdlib_module_names or iskeyword(package):
        raise LocalProtocolError(f'Python has something called "{package}": take another name')
    place = folder / name
    if place.exists():
        raise LocalProtocolError(f"{place} is there already: take another name, or remove it")
    try:
        return _write(place, {"name": name, "package": package, **_programs()})
    except OSError as error:  # such as a full disk: half a project is none, and keeps its name
        shutil.rmtree(place, ignore_errors=True)
        raise OSError(error.errno, error.strerror, error.filename or str(place)) from error


def _write(place: Path, words: dict[str, str]) -> list[Path]:
    written = []
    for source, target in _FILES.items():
        text = files(__package__).joinpath("template", source).read_text("utf-8")
        path = place / target.format(**words)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(Template(text).substitute(words), "utf-8")
        written.append(path)
    return written


def _programs() -> dict[str, str]:
    """Return how Python and yarpy are called where the project is made, as words of TOML: by their
    names, if these mean the ones that run now."""
    own = Path(sys.executable)
    found = shutil.which("python")
    python = "python" if found and Path(found).absolute() == own.absolute() else str(own)
    beside = shutil.which("yarpy", path=str(own.parent))
    yarpy = shutil.which("yarpy")
    if yarpy is not None and yarpy == beside:
        return {"python": '"python"', "yarpy": '"yarpy"'}
    word = json.dumps(python)
    return {"python": word, "yarpy": f'{word}, "-m", "yarpy"'}
