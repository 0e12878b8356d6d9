"""Compile the core while a wheel is built, if YARPY_COMPILE is set: `make wheel`.

Rules: the same files, by mypyc; those below pay for themselves, as `docs/performance.md` shows. The
wheel has the sources too, so that tracebacks show them. Without a compiler nothing is missing: the
core in pure Python is what people read, test and debug.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

CORE = (
    *("data/codec", "data/reader", "data/walker", "data/writer"),
    *("wire/aside_stream", "wire/framing", "wire/lending_stream", "wire/shared_stream"),
    *("wire/stream", "link/byte_driver", "link/counter", "link/driver", "link/object_driver"),
    *("link/receive/receiver", "link/receive/turn"),
    *(
        "link/send/backlog",
        "link/send/dated",
        "link/send/direct",
        "link/send/followed",
        "link/send/lossy",
    ),
    *("link/send/outbound", "link/send/outbox", "link/send/question", "link/send/queued"),
    *("link/send/recent", "link/send/sender", "link/send/window"),
)
_COMPILE = """
import sys
from mypyc.build import mypycify
from setuptools import setup
config, made, *files = sys.argv[1:]
# The files alone: where pip builds there are no other libraries.
alone = ["--follow-imports", "silent", "--ignore-missing-imports"]
modules = mypycify(
    ["--config-file", config, *alone, *files],
    opt_level="2",
    group_name="yarpy",
    target_dir=made + "/c",
)
setup(
    name="yarpy",
    packages=[],
    ext_modules=modules,
    script_args=["-q", "build_ext", "--build-lib", made + "/lib", "--build-temp", made + "/o"],
)
"""


class CompiledCore(BuildHookInterface[Any]):
    """Puts compiled modules beside their sources."""

    def dependencies(self) -> list[str]:
        """What pip makes ready before it builds: `YARPY_COMPILE=1 pip install .`."""
        return ["mypy~=2.4", "setuptools>=65"] if _wanted() else []

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile into a temporary folder; hatchling takes the modules from there."""
        if self.target_name != "wheel" or version == "editable" or not _wanted():
            return
        root = Path(self.root)
        self._made = tempfile.TemporaryDirectory(prefix="yarpy-core-")
        files = [f"yarpy/{name}.py" for name in CORE]
        config = root / "pyproject.toml"
        command = [sys.executable, "-c", _COMPILE, str(config), self._made.name, *files]
        try:
            subprocess.run(command, cwd=root / "src", check=True)
        except subprocess.CalledProcessError as error:
            raise SystemExit(
                "the core cannot be compiled: that takes a C compiler, the headers of Python and "
                "`pip install -e '.[build]'`; without YARPY_COMPILE the wheel is pure Python"
            ) from error
        library = Path(self._made.name, "lib")
        for path in library.rglob("*"):
            if path.is_file():
                build_data["force_include"][str(path)] = str(path.relative_to(library))
        build_data["pure_python"] = False
        build_data["infer_tag"] = True

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """The wheel is written."""
        if hasattr(self, "_made"):
            self._made.cleanup()


def _wanted() -> bool:
    return os.environ.get("YARPY_COMPILE", "") not in ("", "0")
