"""The documentation says what is so: code runs, sessions replay, links lead somewhere."""

import ast
import re
from collections.abc import Mapping
from pathlib import Path

import pytest
from support import page as pages
from support.cpp import CppYarp

import yarpy

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
PAGES = sorted([*DOCS.glob("*.md"), *ROOT.glob("*.md")])
RUNNABLE = [
    page for page in PAGES if any(b.kind in ("python", "console") for b in pages.blocks(page))
]


def needs(page: Path) -> tuple[str, ...]:
    """Return the peers whose programs the sessions of a page call."""
    typed = [line for b in pages.blocks(page) if b.kind == "console" for line in b.lines]
    words = " ".join(typed).split()
    return tuple(name for name in ("nc", "curl") if name in words)


_LINK = re.compile(r"\[[^\]]*\]\(([^)\s#]+)(#[^)\s]*)?\)")


@pytest.mark.parametrize(
    "page",
    [
        pytest.param(
            page, marks=pytest.mark.peer(*needs(page)) if needs(page) else (), id=page.name
        )
        for page in RUNNABLE
    ],
)
def test_code_and_sessions(page: Path, tmp_path: Path):
    port = pages.free_port()
    with yarpy.NameServer(port):
        pages.run(page, tmp_path, port)


@pytest.mark.peer("cpp")
@pytest.mark.parametrize(
    "page",
    [page for page in RUNNABLE if any(b.note == "cpp" for b in pages.blocks(page))],
    ids=lambda page: page.name,
)
def test_sessions_with_cpp(page: Path, tmp_path: Path):
    port = pages.free_port()
    with yarpy.NameServer(port), CppYarp.prepare(tmp_path).at("127.0.0.1", port) as cpp:
        if cpp.version != (3, 5):
            pytest.skip("the pages show what C++ YARP 3.5 says: leave YARPY_CPP_YARP out")
        pages.run(page, tmp_path, port, with_programs(cpp))


def with_programs(cpp: CppYarp) -> Mapping[str, str]:
    """The environment in which `yarp` is the C++ program."""
    found = cpp.environment
    return {**found, "PATH": f"{cpp.program().parent}:{found['PATH']}"}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path):
    for target, _ in _LINK.findall(page.read_text(encoding="utf-8")):
        if "://" not in target:
            assert (page.parent / target).exists(), f"{page.name} links to {target}"


def test_every_page_is_on_the_map():
    listed = {target for target, _ in _LINK.findall((DOCS / "index.md").read_text())}
    assert {page.name for page in DOCS.glob("*.md")} - {"index.md"} <= listed


def test_every_lock_of_the_core_is_explained() -> None:
    """Which lock guards what, and what it may be held across: of all that a class of ours has."""
    there: set[str] = set()
    for file in sorted((ROOT / "src" / "yarpy").rglob("*.py")):
        if {"kits", "peers", "cli", "testing"} & set(file.parts):
            continue
        text = file.read_text("utf-8")
        for kind in ast.walk(ast.parse(text)) if re.search("[Ll]ock\\(|Condition", text) else ():
            if isinstance(kind, ast.ClassDef):
                there |= {f"{kind.name}.{name}" for name in _locks_of(kind)}
    text = (DOCS / "internals.md").read_text("utf-8")
    table = text.partition("## Locks")[2].partition("## Words")[0]
    told = {
        name
        for line in table.splitlines()
        if line.startswith("| `")
        for name in re.findall(r"`(\w+\.\w+)`", line.split("|")[1])
    }
    assert told - {"Fifo._room"} == there  # which is made of the lock beside it


def _locks_of(kind: ast.ClassDef) -> set[str]:
    """Return the attributes of a class that are set to a lock of their own."""
    found = set()
    local: set[str] = set()
    for node in ast.walk(kind):
        if isinstance(node, ast.Assign | ast.AnnAssign) and node.value is not None:
            target = node.targets[0] if isinstance(node, ast.Assign) else node.target
            made = ast.unparse(node.value)
            own = (
                re.match(r"threading\.(R?Lock|Condition)\(\)|fork\.lock\(\)", made) or made in local
            )
            if own and isinstance(target, ast.Name):
                local.add(target.id)
            elif own and isinstance(target, ast.Attribute):
                found.add(target.attr)
    return found
