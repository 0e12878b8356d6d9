"""What the pages say of each foreign system: every row that works names a test that there is, and
every other one a reason."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
HEAD = "| feature | works | test |\n|---|---|---|\n"
PAGES = (
    # carriers: those of MPI
    *(
        f"docs/{name}.md"
        for name in ("carriers", "mqtt", "ros", "ros2", "thrift", "zenoh", "zeromq")
    ),
    "compat/wrapyfi/README.md",
)
_LINK = re.compile(r"\[(\w+)\]\((?:\.\./)+(tests/[\w/]+\.py)\)")


def rows(page: str) -> list[list[str]]:
    text = (ROOT / page).read_text("utf-8")
    assert text.count(HEAD) == 1, f"{page} has one table of features"
    lines = text.partition(HEAD)[2].split("\n\n")[0].splitlines()
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


@pytest.mark.parametrize("page", PAGES)
def test_rows_have_their_tests(page: str) -> None:
    found = rows(page)
    assert len({feature for feature, *_ in found}) == len(found) > 10
    for feature, works, test in found:
        if not test:
            assert re.match(r"no: .", works), f"{feature}: say why not"
            continue
        link = _LINK.fullmatch(test)
        assert link is not None, f"{feature}: {test}"
        tree = ast.parse((ROOT / link[2]).read_text("utf-8"))
        names = {item.name for item in tree.body if isinstance(item, ast.FunctionDef)}
        assert link[1] in names, f"{feature}: {link[2]} has no {link[1]}"
