"""compat, as programs see it: a directory on the path, and a place where its tests may write.

Rules: nothing has to be installed; `compat/src` is put in front for this process and for programs.
"""

import os
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "compat" / "src"
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
