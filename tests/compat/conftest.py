"""compat, as programs see it: a directory on the path, and a place where its tests may write.

Rules: nothing has to be installed; `compat/src` is put in front for this process and for programs.
"""

import importlib.util
import os
import sys
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).parents[2]
COMPAT = ROOT / "compat"
SOURCE = COMPAT / "src"
sys.path.insert(0, str(SOURCE))


@pytest.fixture
def environment(tmp_path: Path) -> Mapping[str, str]:
    """For programs that `import yarp` and know no name server."""
    clean = {k: v for k, v in os.environ.items() if not k.startswith(("YARP", "XDG_"))}
    return {
        **clean,
        "PYTHONPATH": str(SOURCE),
        "YARP_CONFIG_HOME": str(tmp_path / "config"),
        "YARP_DATA_HOME": str(tmp_path / "data"),
    }


@pytest.fixture
def generate() -> ModuleType:
    """compat/generate.py as a module."""
    spec = importlib.util.spec_from_file_location(
        "compat_generate", ROOT / "compat" / "generate.py"
    )
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
