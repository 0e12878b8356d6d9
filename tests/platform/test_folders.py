"""YARP's folders, as C++ YARP's own tests of them and its sources have them for each system."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

import pytest

from yarpy.platform.folders import (
    conf_directory,
    configuration_directories,
    data_directories,
    data_home,
)

MAC = "/h/Library"
XDG = {
    "XDG_CONFIG_HOME": "/c",
    "XDG_DATA_HOME": "/d",
    "XDG_CONFIG_DIRS": os.pathsep.join(("/e", "/f", "")),
    "XDG_DATA_DIRS": "/g",
}
OWN = {
    "YARP_CONFIG_HOME": "/1",
    "YARP_DATA_HOME": "/2",
    "YARP_CONFIG_DIRS": "/3",
    "YARP_DATA_DIRS": os.pathsep.join(("/4", "/5")),
}
SHARED = ["/usr/local/share/yarp", "/usr/share/yarp"]
PROGRAMS = Path("C:\\ProgramData", "yarp")


@pytest.mark.parametrize("platform", ["linux", "darwin", "win32"])
def test_yarp_s_own_variables_come_first(platform: str) -> None:
    _same({**XDG, "APPDATA": "/app", **OWN}, platform, "/1", "/2", ["/3"], ["/4", "/5"])
    _same({**OWN, "YARP_CONFIG_HOME": "", "YARP_CONFIG_DIRS": ""}, platform, ".", "/2", [])


def test_linux() -> None:
    home = {"HOME": "/h", "USERPROFILE": "/u", "APPDATA": "/app"}
    _same(home, "linux", "/h/.config/yarp", "/h/.local/share/yarp", ["/etc/xdg/yarp"], SHARED)
    _same(XDG, "linux", "/c/yarp", "/d/yarp", ["/e/yarp", "/f/yarp"], ["/g/yarp"])


def test_macos() -> None:
    own = (f"{MAC}/Preferences/yarp", f"{MAC}/Application Support/yarp")
    system = ["/etc/yarp", "/Library/Preferences/yarp"]
    _same({"HOME": "/h", **XDG}, "darwin", *own, system, SHARED)


def test_windows() -> None:
    named = {"APPDATA": "/app", "ALLUSERSPROFILE": "/all", "USERPROFILE": "/u", **XDG}
    _same(named, "win32", "/app/yarp/config", "/app/yarp", ["/all/yarp/config"], ["/all/yarp"])
    roaming = "/u/AppData/Roaming/yarp"
    shared = ([PROGRAMS / "config"], [PROGRAMS])
    _same({"USERPROFILE": "/u", "HOME": "/h"}, "win32", f"{roaming}/config", roaming, *shared)


def test_without_a_home_the_system_knows_it() -> None:
    """As of services and cron: not the current folder, where others would not look."""
    assert conf_directory({}, "linux") == Path(os.path.expanduser("~"), ".config", "yarp")
    assert conf_directory({}, "linux").is_absolute()


def _same(
    environment: Mapping[str, str],
    platform: str,
    settings: str,
    data: str,
    *system: list[str] | list[Path],
) -> None:
    """Compare the four, or those of them that are said."""
    assert conf_directory(environment, platform) == Path(settings)
    assert data_home(environment, platform) == Path(data)
    for found, wanted in zip((configuration_directories, data_directories), system, strict=False):
        assert found(environment, platform) == [Path(each) for each in wanted]
