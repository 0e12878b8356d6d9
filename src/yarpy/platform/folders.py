"""The folders in which YARP looks for settings and data, the same as those of C++ YARP.

                    settings of a user          data of a user
    Linux           ~/.config/yarp              ~/.local/share/yarp
    macOS           ~/Library/Preferences/yarp  ~/Library/Application Support/yarp
    Windows         %APPDATA%\\yarp\\config       %APPDATA%\\yarp

                    settings of the system      data of the system
    Linux           /etc/xdg/yarp               /usr/local/share/yarp, /usr/share/yarp
    macOS           /etc/yarp and               as on Linux
                    /Library/Preferences/yarp
    Windows         %ALLUSERSPROFILE%\\yarp\\config, %ALLUSERSPROFILE%\\yarp

Rules: `YARP_CONFIG_HOME`, `YARP_DATA_HOME`, `YARP_CONFIG_DIRS` and `YARP_DATA_DIRS` come first, the
four `XDG_` ones on Linux alone. Functions of an environment; nothing is made or looked for.
platformdirs knows other folders on macOS and Windows, where C++ YARP would not look.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

from yarpy.errors import AddressError


@lru_cache(maxsize=256)
def folder(*parts: str) -> Path:
    """A path of these parts. Every port asks for the same few, and making one takes a while."""
    return Path(*parts)


def home_directory(environment: Mapping[str, str], platform: str = sys.platform) -> str:
    """The home of this user: where services and cron set no HOME, as the system knows it; never the
    current folder, in which another program of the same user would not look."""
    named = environment.get("USERPROFILE" if platform == "win32" else "HOME")
    if named:
        return named
    known = os.path.expanduser("~")  # the entry of this user in the system's list
    if known == "~":
        raise AddressError("nobody knows your home directory: set HOME, or YARP_CONFIG_HOME")
    return known


def conf_directory(environment: Mapping[str, str], platform: str = sys.platform) -> Path:
    """The settings of this user."""
    if "YARP_CONFIG_HOME" in environment:
        return folder(environment["YARP_CONFIG_HOME"])
    if platform == "win32":
        return folder(_roaming(environment), "yarp", "config")
    if platform == "darwin":
        return folder(home_directory(environment, platform), "Library", "Preferences", "yarp")
    if environment.get("XDG_CONFIG_HOME"):
        return folder(environment["XDG_CONFIG_HOME"], "yarp")
    return folder(home_directory(environment, platform), ".config", "yarp")


def data_home(environment: Mapping[str, str], platform: str = sys.platform) -> Path:
    """The data of this user."""
    if "YARP_DATA_HOME" in environment:
        return folder(environment["YARP_DATA_HOME"])
    if platform == "win32":
        return folder(_roaming(environment), "yarp")
    if platform == "darwin":
        home = home_directory(environment, platform)
        return folder(home, "Library", "Application Support", "yarp")
    if environment.get("XDG_DATA_HOME"):
        return folder(environment["XDG_DATA_HOME"], "yarp")
    return folder(home_directory(environment, platform), ".local", "share", "yarp")


def configuration_directories(
    environment: Mapping[str, str], platform: str = sys.platform
) -> list[Path]:
    """The settings of the system."""
    default = ["/etc", "/Library/Preferences"] if platform == "darwin" else ["/etc/xdg"]
    found = _directories(environment, platform, "CONFIG_DIRS", default)
    if platform == "win32" and "YARP_CONFIG_DIRS" not in environment:
        return [path / "config" for path in found]
    return found


def data_directories(environment: Mapping[str, str], platform: str = sys.platform) -> list[Path]:
    """The data of the system."""
    return _directories(environment, platform, "DATA_DIRS", ["/usr/local/share", "/usr/share"])


def _roaming(environment: Mapping[str, str]) -> str:
    """Return the folder in which programs of Windows keep what goes along with a user to another
    computer."""
    known = environment.get("APPDATA")
    return known or os.path.join(home_directory(environment, "win32"), "AppData", "Roaming")


def _directories(
    environment: Mapping[str, str], platform: str, name: str, default: list[str]
) -> list[Path]:
    if f"YARP_{name}" in environment:
        return [folder(part) for part in environment[f"YARP_{name}"].split(os.pathsep) if part]
    if platform == "win32":
        said, default = environment.get("ALLUSERSPROFILE", ""), ["C:\\ProgramData"]
    else:
        said = environment.get(f"XDG_{name}", "") if platform != "darwin" else ""
    parts = [part for part in said.split(os.pathsep) if part]
    return [folder(part, "yarp") for part in parts or default]
