"""The runner of documentation notices what is not so."""

from pathlib import Path

import pytest
from support import page as pages

import yarpy

GOOD = """\
# A title

```python
import yarpy

port = yarpy.BufferedPort("/p", strict=True)
print(port.address)  # 127.0.0.1:10002
```

```console
$ yarpy name query /p
registration name /p ip 127.0.0.1 port 10002 type tcp
$ for number in 1 2 3
> do echo $number; done
1
...
3
$ echo 12 1234.56789 now; sleep 20
7 999.00001 now
^C
$ true
```

```sh
false
```

```python
port.close()
```
"""


def run(text: str, directory: Path) -> None:
    (directory / "page").mkdir()
    page = directory / "page.md"
    page.write_text(text)
    port = pages.free_port()
    with yarpy.NameServer(port):
        pages.run(page, directory / "page", port)


def test_a_true_page(tmp_path: Path):
    run(GOOD, tmp_path)


@pytest.mark.parametrize(
    ("true", "false"),
    [
        ("# 127.0.0.1:10002", "# 127.0.0.1:10003"),
        ("port 10002 type tcp", "port 10003 type tcp"),
        ("...\n3", "...\n4"),
        ("1\n...", "2\n..."),
        ("...\n", ""),
        ("$ true", "$ echo not so"),
        ("port.close()", "port.shut()"),
    ],
)
def test_a_false_page(true: str, false: str, tmp_path: Path):
    assert true in GOOD
    with pytest.raises(AssertionError, match=r"page\.md"):
        run(GOOD.replace(true, false), tmp_path)


def test_lines_keep_their_numbers(tmp_path: Path):
    page = tmp_path / "page.md"
    page.write_text(GOOD)
    lines = pages.program(page, cpp=False).splitlines()
    assert len(lines) == len(GOOD.splitlines())
    assert lines[5] == GOOD.splitlines()[5] != ""


def test_a_page_ends_where_its_programs_are_missing(tmp_path: Path):
    page = tmp_path / "page.md"
    page.write_text("# Title\n\n```console cpp\n$ yarp\n```\n\n```python\nnonsense()\n```\n")
    assert "nonsense" not in pages.program(page, cpp=False)
    assert "nonsense" in pages.program(page, cpp=True)
