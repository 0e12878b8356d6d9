"""Scripts that print the same text, line by line, under compat and under the C++ binding.

What C++ YARP prints is kept in `expected/`, so that compat is tested without it, too; where it is
installed, it has to print that. `python tests/compat/record.py` writes `expected/` anew.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest
from support import fork_server
from support.cpp import CppYarp
from support.peer import brings
from support.port import free_block
from support.process import Process
from support.wait import HANG

HERE = Path(__file__).parent
SCRIPTS = sorted((HERE / "scripts").glob("*.py"))
RUNNER = HERE / "runner.py"
RANKED = HERE.parents[1] / "compat" / "ranked.txt"


def expected(script: Path) -> list[str]:
    return (HERE / "expected" / f"{script.stem}.txt").read_text("utf-8").splitlines()


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_compat_prints_what_cpp_prints(script: Path, environment: Mapping[str, str]) -> None:
    command = [sys.executable, RUNNER, script]
    spelled = {**environment, "PYTHONUTF8": "1"}  # as `expected` is
    with Process(command, env=spelled, start=fork_server.start) as process:
        code = process.wait(HANG)
    said = process.stdout
    if sys.platform == "win32" and script.stem in ("network", "resources"):  # tell of paths
        said = said.replace("\\ ;", "/ :").replace("\\", "/")
    assert said.splitlines() == expected(script), process.stderr
    assert code == 0, process.stderr


@pytest.fixture(scope="module")
@brings("cpp")
def cpp(tmp_path_factory: pytest.TempPathFactory) -> CppYarp:
    return CppYarp.prepare(tmp_path_factory.mktemp("cpp"))


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_cpp_prints_it(script: Path, cpp: CppYarp) -> None:
    if cpp.version != (3, 5):
        pytest.skip("what is expected was recorded of 3.5, whose older names are among it")
    # Without a name server C++ numbers its ports from here on.
    environment = {**cpp.environment, "YARP_PORT_RANGE": str(free_block(200))}
    with Process([cpp.interpreter, RUNNER, script], env=environment) as process:
        process.wait(HANG)
    assert process.stdout.splitlines() == expected(script), process.stderr


def test_every_expectation_has_its_script() -> None:
    kept = {path.stem for path in (HERE / "expected").glob("*.txt")}
    assert kept == {path.stem for path in SCRIPTS}


def test_the_names_that_are_used_most_are_among_them() -> None:
    """Each of the first eighty. What needs a robot is in `programs`, and run against one."""
    rows = [line.split() for line in RANKED.read_text().splitlines() if line[:1].isalpha()]
    rows.sort(key=lambda row: -int(row[1]))
    texts = [path.read_text() for path in (*SCRIPTS, *(HERE / "programs").glob("*.py"))]
    for name, _ in rows[:80]:
        word = re.compile(rf"\b{name.rpartition('.')[2]}\b")
        assert any(word.search(text) for text in texts), f"no script uses {name}"
