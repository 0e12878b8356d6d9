"""Virtual environments that hold foreign programs, each made once per machine.

They lie outside this repository: below $YARPY_PEERS_DIR, else $XDG_CACHE_HOME/yarpy-peers, else
~/.cache/yarpy-peers. Rules: standard library only (they are made before anything is installed);
several processes may ask at once, one installs; what is missing is said in one sentence that tells
what to do.
"""

import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

from support.file_lock import hold


class MissingPeer(Exception):
    """A peer cannot be had on this machine; the text says why and what to do."""


def peers_directory() -> Path:
    """Where the environments are or would be made."""
    peers = os.environ.get("YARPY_PEERS_DIR")
    cache = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(peers) if peers else Path(cache) / "yarpy-peers"


def make_once(directory: Path, fill: Callable[[], object]) -> Path:
    """The directory; if it is not ready, `fill` makes it. Or MissingPeer."""
    ready = directory / ".ready"
    if ready.exists():
        return directory
    try:
        directory.parent.mkdir(parents=True, exist_ok=True)
        lock = (directory.parent / f"{directory.name}.lock").open("w")
    except OSError as error:
        raise MissingPeer(
            f"cannot write {directory.parent}: {error}; set YARPY_PEERS_DIR"
        ) from error
    with lock:
        hold(lock)
        if ready.exists():  # another process made it while we waited
            return directory
        shutil.rmtree(directory, ignore_errors=True)
        fill()
        ready.touch()
    return directory


def install(python: Path | str, directory: Path, *packages: str) -> None:
    """Make an environment for that Python, with these packages. Or MissingPeer."""
    run([str(python), "-m", "venv", str(directory)], "make a virtual environment")
    pip = [str(directory / "bin/python"), "-m", "pip", "--disable-pip-version-check", "install"]
    named = [one for one in packages if not one.startswith("-")]
    run([*pip, "--quiet", *packages], f"install {', '.join(named)}")


def environment() -> dict[str, str]:
    """Ours without what points a Python at the modules of another one."""
    return {k: v for k, v in os.environ.items() if k not in ("PYTHONHOME", "PYTHONPATH")}


def run(command: list[str], purpose: str) -> None:
    """Run a command to its end. MissingPeer with what it said, if it fails."""
    try:
        subprocess.run(
            command, env=environment(), check=True, capture_output=True, text=True, timeout=600
        )
    except subprocess.CalledProcessError as error:
        words = (error.stderr or error.stdout).strip().splitlines() or ["no message"]
        reason = next((line for line in words if line.startswith("ERROR")), words[-1])
        raise MissingPeer(f"could not {purpose}: {reason}") from error
    except (OSError, subprocess.TimeoutExpired) as error:
        raise MissingPeer(f"could not {purpose}: {error}") from error
