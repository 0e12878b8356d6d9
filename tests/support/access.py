"""An access.toml for this process, while a test runs."""

from __future__ import annotations

from pathlib import Path

import pytest

OPEN = '[[allow]]\nwho = "loopback"\nmay = "all"\n'


def allow(
    folder: Path, monkeypatch: pytest.MonkeyPatch, may: str, who: str = "loopback", ports: str = "*"
) -> Path:
    """One rule: who may do what, rights between blanks."""
    rights = ", ".join(f'"{right}"' for right in may.split())
    return write(
        folder, monkeypatch, f'[[allow]]\nwho = "{who}"\nmay = [{rights}]\nports = "{ports}"\n'
    )


def write(folder: Path, monkeypatch: pytest.MonkeyPatch, text: str) -> Path:
    """A file with that text, in force for ports that are opened from now on."""
    number = len(list(folder.glob("access*.toml")))
    file = folder / f"access{number}.toml"  # a file is read once: each has a name of its own
    file.write_text(text)
    monkeypatch.setenv("YARPY_ACCESS", str(file))
    return file
