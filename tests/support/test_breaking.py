"""What would break for programs of the last release, of a package made for it."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest
from support import breaking

OLD = """
class Port:
    def write(self, value, timeout=None):
        '''Write.'''

    def read(self): ...

def gone(): ...
def _own(): ...
"""
NEW = """
class Port:
    def write(self, value): ...
    def read(self, timeout=None): ...

def more(): ...
"""


@pytest.fixture
def released(tmp_path: Path) -> Path:
    """A checkout whose version 1 was released, and which has gone on."""
    if shutil.which("git") is None:
        pytest.skip("releases are tags of git: install it (apt-get install git)")
    folder = tmp_path / "src" / "thing"
    folder.mkdir(parents=True)

    def git(*words: str) -> None:
        who = ("-c", "user.name=a", "-c", "user.email=a@b.c", "-c", "commit.gpgsign=false")
        subprocess.run(["git", *who, *words], cwd=tmp_path, check=True, capture_output=True)

    git("init", "-q")
    assert breaking.last_release(tmp_path) == ""
    (folder / "parts.py").write_text(OLD)
    (folder / "__init__.py").write_text(
        'from thing.parts import Port, gone, _own\n__all__ = ["Port", "gone"]\n'
    )
    git("add", "-A")
    git("commit", "-qm", "one")
    git("tag", "v1.0.0")
    (folder / "parts.py").unlink()
    (folder / "elsewhere.py").write_text(NEW)
    (folder / "__init__.py").write_text(
        'from thing.elsewhere import Port, more\n__all__ = ["Port", "more"]\n'
    )
    git("add", "-A")
    git("commit", "-qm", "two")
    return tmp_path


def test_what_is_gone_is_told_and_what_came_or_moved_is_not(
    released: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(breaking, "PUBLIC", ("", "nothing"))
    assert breaking.last_release(released) == "v1.0.0"
    assert dict(breaking.broken(released, "thing", "v1.0.0")) == {
        "gone": "it is gone",
        "Port.write(timeout)": "Parameter was removed",
    }
