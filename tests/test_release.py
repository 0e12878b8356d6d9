"""What is released: a wheel of pure Python, and what it is made from.

Rules: built by hatchling as pip does it, in a process of its own.
"""

from __future__ import annotations

import hashlib
import json
import re
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest
import yaml
from support.wait import HANG

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def built(kind: str, folder: Path, source: Path = ROOT) -> Path:
    """Build it, without a compiled core."""
    command = [sys.executable, "-m", "hatchling", "build", "-t", kind, "-d", str(folder)]
    done = subprocess.run(
        command,
        cwd=source,
        env={"YARPY_COMPILE": "0", "PATH": ""},
        capture_output=True,
        text=True,
        timeout=4 * HANG,
    )
    assert done.returncode == 0, done.stderr
    (made,) = folder.iterdir()
    return made


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return built("wheel", tmp_path_factory.mktemp("wheel"))


def test_what_is_built_from_the_sources_is_the_same_wheel(wheel: Path, tmp_path: Path) -> None:
    """Whoever has the source distribution can make the wheel again, byte by byte."""
    source = built("sdist", tmp_path / "source")
    with tarfile.open(source) as tar:
        tar.extraction_filter = getattr(tarfile, "data_filter", None)  # Python 3.11.2 has none
        tar.extractall(tmp_path / "unpacked")
    (unpacked,) = (tmp_path / "unpacked").iterdir()
    again = built("wheel", tmp_path / "again", unpacked)
    first, second = (hashlib.sha256(path.read_bytes()).hexdigest() for path in (wheel, again))
    assert wheel.name == again.name
    assert first == second


def test_the_wheel_says_what_it_is_made_of(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as found:
        (name,) = (one for one in found.namelist() if ".dist-info/sboms/" in one)
        bill = json.loads(found.read(name))
    assert (bill["bomFormat"], bill["specVersion"]) == ("CycloneDX", "1.6")
    own = bill["metadata"]["component"]
    assert (own["name"], own["version"]) == (PROJECT["name"], PROJECT["version"])
    told = {one["name"] + one["properties"][0]["value"] for one in bill["components"]}
    assert told == set(PROJECT["dependencies"])


def test_the_licence_comes_along(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as found:
        (name,) = (one for one in found.namelist() if one.endswith("/LICENSE"))
        assert found.read(name) == (ROOT / "LICENSE").read_bytes()


def test_the_version_is_told_once() -> None:
    import yarpy

    assert yarpy.__version__ == PROJECT["version"]


def test_all_is_every_extra_of_users() -> None:
    extras = PROJECT["optional-dependencies"]
    (text,) = extras["all"]
    named = re.fullmatch(r"yarpy\[(.*)\]", text)
    assert named is not None
    assert set(named[1].split(",")) == set(extras) - {"all", "test", "build", "bench"}


def test_extras_are_called_as_the_peers_that_they_are_for() -> None:
    peers = {
        path.name for path in (ROOT / "src/yarpy/peers").iterdir() if (path / "carrier.py").exists()
    }
    assert len(peers) == 6 and peers <= set(PROJECT["optional-dependencies"])


def test_the_recipe_of_conda_says_the_same() -> None:
    recipe = yaml.safe_load((ROOT / "packaging" / "conda" / "recipe.yaml").read_text("utf-8"))
    assert recipe["package"] == {"name": PROJECT["name"], "version": PROJECT["version"]}
    python, *others = (line.replace(" ", "") for line in recipe["requirements"]["run"])
    assert python == f"python{PROJECT['requires-python']}"
    assert others == PROJECT["dependencies"]


def test_the_package_of_debian_says_the_same() -> None:
    first = (ROOT / "packaging" / "debian" / "changelog").read_text("utf-8").splitlines()[0]
    assert first.startswith(f"{PROJECT['name']} ({PROJECT['version']})")
