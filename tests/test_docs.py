"""The documentation says what is so: code runs, sessions replay, links lead somewhere."""

import re
import shutil
from collections.abc import Mapping
from pathlib import Path

import pytest
from support import page as pages
from support.cpp import CppYarp
from support.cpp_venv import environment_directory

import yarpy

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
PAGES = sorted([*DOCS.glob("*.md"), *ROOT.glob("*.md")])
RUNNABLE = [
    page for page in PAGES if any(b.kind in ("python", "console") for b in pages.blocks(page))
]

_LINK = re.compile(r"\[[^\]]*\]\(([^)\s#]+)(#[^)\s]*)?\)")


@pytest.mark.parametrize("page", RUNNABLE, ids=lambda page: page.name)
def test_code_and_sessions(page: Path, tmp_path: Path):
    for program in ("bash", "nc", "curl"):
        if f" {program} " in page.read_text() and not shutil.which(program):
            pytest.skip(f"{program} is not installed")
    port = pages.free_port()
    with yarpy.NameServer(port):
        if not (environment_directory() / ".ready").exists():
            pages.run(page, tmp_path, port)
            return
        with CppYarp.prepare(tmp_path).at("127.0.0.1", port) as cpp:
            pages.run(page, tmp_path, port, with_programs(cpp))


def with_programs(cpp: CppYarp) -> Mapping[str, str]:
    """The environment in which `yarp` is the C++ program."""
    found = cpp.environment
    return {**found, "PATH": f"{cpp.program().parent}:{found['PATH']}"}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path):
    for target, _ in _LINK.findall(page.read_text()):
        if "://" not in target:
            assert (page.parent / target).exists(), f"{page.name} links to {target}"


def test_every_page_is_on_the_map():
    listed = {target for target, _ in _LINK.findall((DOCS / "index.md").read_text())}
    assert {page.name for page in DOCS.glob("*.md")} - {"index.md"} <= listed
