"""What is derived from compat's code: its stub and the table of its README are up to date."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType

import pytest
from support.type_check import type_check
from support.wait import HANG

COMPAT = Path(__file__).parents[2] / "compat"


def test_stub_and_readme_are_up_to_date(generate: ModuleType) -> None:
    again = "run `python compat/generate.py`"
    assert generate.STUB.read_text() == generate.stub(), again
    assert generate.README.read_text() == generate.readme(), again


def test_nearly_every_use_in_public_programs_is_covered(generate: ModuleType) -> None:
    names, uses, missing = generate.coverage()
    assert uses >= 0.98
    assert names >= 0.98
    assert not any(name in missing for name, count in generate.ranked() if count > 6), (
        f"{missing} are used a lot"
    )


def test_readme_runs(environment: Mapping[str, str]) -> None:
    text = (COMPAT / "README.md").read_text()
    code = text.partition("```python\n")[2].partition("```")[0]
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        timeout=HANG,
        env=environment,
    )
    assert done.stdout.strip() == "hello 42", done.stderr


@pytest.mark.timeout(300)  # mypy may begin without its cache
def test_types_are_seen(tmp_path: Path, environment: Mapping[str, str]) -> None:
    """A type checker knows the names, and what they take."""
    (tmp_path / "good.py").write_text(
        "import yarp\n"
        "reply: yarp.Bottle = yarp.Bottle('a')\n"
        "reveal: bool = yarp.Network_connect('/a', '/b')\n"
        "mode: int = yarp.VOCAB_CM_POSITION\n"
    )
    (tmp_path / "bad.py").write_text("import yarp\nyarp.Bottle().addInt32('x')\nyarp.nonsense\n")
    path = {**environment, "MYPYPATH": str(COMPAT / "src")}
    said = type_check(tmp_path, "good.py", "bad.py", env=path).stdout
    assert "good.py" not in said
    assert "incompatible type" in said and "nonsense" in said
