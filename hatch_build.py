"""What is done while a wheel is built: its software bill of materials is written, and its core is
compiled if YARPY_COMPILE is set: `make wheel`.

Rules: nothing in the bill depends on when or where it is written. What is compiled are the same
files, by mypyc; those below pay for themselves, as `docs/performance.md` shows. The wheel has the
sources too, so that tracebacks show them. Without a compiler nothing is missing: the core in pure
Python is what people read, test and debug.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
import uuid
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

CORE = (
    *("data/codec", "data/reader", "data/walker", "data/writer"),
    *("wire/aside_stream", "wire/frame_stream", "wire/framing", "wire/lending_stream"),
    *("wire/shared_stream", "wire/stream"),
    *("link/byte_driver", "link/counter", "link/driver", "link/object_driver"),
    *("link/receive/receiver", "link/receive/turn", "link/receive/gather"),
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


# Every script, style sheet and picture of the package is its own: there is nothing to list here.
_VENDORED: tuple[dict[str, Any], ...] = ()


def bill_of_materials(name: str, version: str, dependencies: list[str]) -> str:
    """Return the bill as CycloneDX 1.6: the package, and what pip fetches for it. A wheel says
    which versions it allows, not which it will meet."""
    own = f"pkg:pypi/{name}@{version}"
    components: list[dict[str, Any]] = []
    for line in sorted(dependencies):
        needed = re.split(r"[^\w.-]", line, maxsplit=1)[0].lower()
        allowed = {"name": "pypi:version-specifier", "value": line[len(needed) :].strip()}
        reference = f"pkg:pypi/{needed}"
        components.append(
            {
                "type": "library",
                "bom-ref": reference,
                "name": needed,
                "purl": reference,
                "scope": "required",
                "properties": [allowed],
            }
        )
    components += _VENDORED
    bill = {
        "bomFormat": "CycloneDX",
        "specVersion": "1.6",
        "serialNumber": f"urn:uuid:{uuid.uuid5(uuid.NAMESPACE_URL, own)}",
        "version": 1,
        "metadata": {
            "component": {
                "type": "library",
                "bom-ref": own,
                "name": name,
                "version": version,
                "purl": own,
                "licenses": [{"license": {"id": "BSD-3-Clause"}}],
            }
        },
        "components": components,
        "dependencies": [{"ref": own, "dependsOn": [one["bom-ref"] for one in components]}],
    }
    return json.dumps(bill, indent=1) + "\n"


class CompiledCore(BuildHookInterface[Any]):
    """Adds the bill, and puts compiled modules beside their sources."""

    def dependencies(self) -> list[str]:
        """What pip makes ready before it builds: `YARPY_COMPILE=1 pip install .`."""
        return ["mypy~=2.4", "setuptools>=65"] if _wanted() else []

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Write and compile into a temporary folder; hatchling takes all from there."""
        if self.target_name != "wheel" or version == "editable":
            return
        self._made = tempfile.TemporaryDirectory(prefix="yarpy-wheel-")
        about = self.metadata
        bill = Path(self._made.name, f"{about.name}.cdx.json")
        text = bill_of_materials(about.name, about.version, about.core.dependencies)
        bill.write_text(text, encoding="utf-8")
        # hatchling before 1.28 knows of no such files, and leaves them out.
        build_data.setdefault("sbom_files", []).append(str(bill))
        if _wanted():
            self._compile(build_data)

    def _compile(self, build_data: dict[str, Any]) -> None:
        root = Path(self.root)
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
