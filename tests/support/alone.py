"""Run the tests of the core in a copy from which guests were deleted: `make alone`.

    python tests/support/alone.py            # all guests at once, and all kits
    python tests/support/alone.py zenoh ros  # one run without each of these

Rules: a guest that others stand on takes those with it. The copy has the core's tests alone, those
of bytes, ports and links; one that needs a guest says so with `guest`, and is skipped.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
#: who stands on a guest
STANDS_ON = {"ros": ["ros2"], "zenoh": ["ros2"]}


def copy(target: Path, gone: list[str]) -> None:
    """Copy the checkout without these folders of `src/yarpy`, and without their tests."""
    ignore = shutil.ignore_patterns("__pycache__", ".*_cache", "output")
    for name in ("src", "tests", "examples", "docs"):
        shutil.copytree(ROOT / name, target / name, ignore=ignore)
    for name in ("pyproject.toml", "hatch_build.py", "README.md", "SECURITY.md"):
        shutil.copy(ROOT / name, target / name)
    for folder in gone:
        shutil.rmtree(target / "src" / "yarpy" / folder)
        shutil.rmtree(target / "tests" / folder, ignore_errors=True)


def run(gone: list[str], arguments: list[str]) -> int:
    """Run the stages of the core without these folders; pytest's exit code."""
    with tempfile.TemporaryDirectory(prefix="yarpy-alone-") as folder:
        target = Path(folder)
        copy(target, gone)
        environment = {**os.environ, "PYTHONPATH": str(target / "src")}
        code = 0
        for stage in ("pure", "links"):
            command = [sys.executable, "-m", "pytest", "-m", "not peer", "--stage", stage]
            done = subprocess.run([*command, *arguments], cwd=target, env=environment)
            code = code or done.returncode
        return code


def main(words: list[str]) -> int:
    """Run once without each guest that is named, or once without any guest or kit."""
    guests = [word for word in words if not word.startswith("-")]
    arguments = [word for word in words if word.startswith("-")]
    arguments += ["--dist", "worksteal"] if any(word.startswith("-n") for word in arguments) else []
    if not guests:
        return run(["peers", "kits"], arguments)
    code = 0
    for guest in guests:
        gone = [f"peers/{name}" for name in (guest, *STANDS_ON.get(guest, []))]
        print(f"without {', '.join(gone)}", flush=True)
        code = code or run(gone, arguments)
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
