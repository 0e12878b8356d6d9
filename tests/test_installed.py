"""Entry points of installed packages are found, and nothing is asked where there are none."""

from __future__ import annotations

import subprocess
import sys
import zipfile
from importlib import metadata
from pathlib import Path

import pytest

from yarpy import installed

ENTRIES = "[yarpy.carriers]\nother = stranger:Other\n"


def put(site: Path, info: str, entries: str) -> None:
    """As much of an installed package as finding it needs."""
    folder = site / info
    folder.mkdir(parents=True)
    (folder / "METADATA").write_text("Metadata-Version: 2.1\nName: stranger\nVersion: 1.0\n")
    (folder / "entry_points.txt").write_text(entries)


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The groups for which the library was asked; only packages of these folders are there."""
    groups: list[str] = []
    ask = metadata.entry_points

    def entry_points(*, group: str) -> metadata.EntryPoints:
        groups.append(group)
        return ask(group=group)

    monkeypatch.setattr(metadata, "entry_points", entry_points)
    return groups


@pytest.mark.parametrize("info", ["stranger-1.0.dist-info", "stranger.egg-info"])
def test_those_of_a_package_are_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, asked: list[str], info: str
) -> None:
    put(tmp_path, info, ENTRIES)
    monkeypatch.setattr(sys, "path", [str(tmp_path)])
    assert [entry.name for entry in installed.entry_points("yarpy.carriers")] == ["other"]
    assert asked == ["yarpy.carriers"]


def test_where_nobody_has_any_the_library_is_not_asked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, asked: list[str]
) -> None:
    put(tmp_path, "stranger-1.0.dist-info", "[console_scripts]\nyarpy = yarpy.cli:main\n")
    (tmp_path / "old.egg-info").write_text("a file, as some have\n")
    (tmp_path / "bare-1.0.dist-info").mkdir()
    monkeypatch.setattr(sys, "path", [str(tmp_path), str(tmp_path / "gone")])
    assert [*installed.entry_points("yarpy.carriers")] == []
    assert asked == []


def test_those_in_an_archive_are_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, asked: list[str]
) -> None:
    put(tmp_path / "made", "stranger-1.0.dist-info", ENTRIES)
    archive = tmp_path / "stranger.zip"
    with zipfile.ZipFile(archive, "w") as file:
        for path in (tmp_path / "made").glob("*/*"):
            file.write(path, path.relative_to(tmp_path / "made"))
    monkeypatch.setattr(sys, "path", [str(archive)])
    assert [entry.name for entry in installed.entry_points("yarpy.carriers")] == ["other"]


def test_a_finder_of_others_is_asked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, asked: list[str]
) -> None:
    class Finder:
        def find_spec(self, *arguments: object) -> None:
            return None

        def find_distributions(self, context: object = None) -> list[metadata.Distribution]:
            return [metadata.Distribution.at(tmp_path / "stranger-1.0.dist-info")]

    put(tmp_path, "stranger-1.0.dist-info", ENTRIES)
    monkeypatch.setattr(sys, "path", [str(tmp_path / "gone")])
    monkeypatch.setattr(sys, "meta_path", [*sys.meta_path, Finder()])
    assert [entry.name for entry in installed.entry_points("yarpy.carriers")] == ["other"]


def test_opening_a_port_does_not_load_the_library() -> None:
    if [*installed.entry_points("yarpy.carriers")]:
        pytest.skip("needs an environment without packages that bring plug-ins")
    code = (
        "import sys, yarpy\n"
        "with yarpy.Port('/installed', names=yarpy.LocalNames()):\n"
        "    print('importlib.metadata' in sys.modules)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout) == (0, "False\n"), done.stderr
