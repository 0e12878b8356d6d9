"""A page of the documentation as a program: its Python runs, its terminal sessions are replayed.

    ```python       runs, block after block, in one program; `print(x)  # text` must print text
    ```console      a session in another terminal: `$ command`, then all that it prints. A line
                    `...` stands for any lines. After a last line `^C` it is interrupted.
    ```console cpp  the same with the programs of C++ YARP; where they are not installed, the page
                    ends here

Other blocks are only read. Rules: a page is written as if its name server had the port number
10000; the numbers from 10000 to 10099 stand for those of the server it really gets. Numbers of six
digits or with four decimals (times, mostly), and an integer before one (a stamp), may be any.
"""

import json
import os
import re
import signal
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from support import fork_server
from support.port import free_block
from support.process import Process
from support.wait import HANG

FIRST = 10000  # the port number of the name server in the text
# Pages that other name servers of this computer, such as those of other tests, would be seen on.
ALONE = ("doctor.md",)
SIZE = 100

_FENCE = re.compile(r"( *)```(\S*) ?(\S*)\s*$")
_NUMBER = re.compile(r"(?:\b\d+ )?(?:\d+\.\d{4,}|\d{6,}(?:\.\d+)?)|(?<=\bfor )\d+\.\d(?= s\b)")
_PRINTED = re.compile(r"\bprint\(.*\)  # (.*)$")


@dataclass(frozen=True)
class Block:
    """What stands between two fences, and the number of its first line."""

    kind: str
    note: str
    line: int
    lines: tuple[str, ...]

    @property
    def text(self) -> str:
        return "".join(line + "\n" for line in self.lines)


def blocks(page: Path) -> Iterator[Block]:
    """The blocks of code of a page."""
    inside: re.Match[str] | None = None
    start, found = 0, []
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), start=1):
        fence = _FENCE.match(line)
        if inside is None and fence:
            inside, start, found = fence, number + 1, []
        elif inside is not None and line == f"{inside[1]}```":
            yield Block(inside[2], inside[3], start, tuple(found))
            inside = None
        elif inside is not None:
            found.append(line.removeprefix(inside[1]))
    assert inside is None, f"{page}: a block that begins above line {start} does not end"


def program(page: Path, cpp: bool) -> str:
    """The Python of a page, each line where it stands in the page."""
    lines = [""] * len(page.read_text(encoding="utf-8").splitlines())
    for block in blocks(page):
        if block.note == "cpp" and not cpp:
            break
        if block.kind == "python":
            lines[block.line - 1 : block.line - 1 + len(block.lines)] = block.lines
        elif block.kind == "console":
            lines[block.line - 1] = f"replay({block.lines!r}, {block.note!r})"
    assert not lines[0], f"{page} begins with a title"
    lines[0] = "from support.page import replay"
    return "".join(line + "\n" for line in lines)


def printed(source: str) -> list[str]:
    """What the comments behind `print(...)` say that it prints."""
    return [found[1] for line in source.splitlines() if (found := _PRINTED.search(line))]


def run(page: Path, directory: Path, port: int, cpp: Mapping[str, str] | None = None) -> None:
    """Run a page with the name server at `port`. AssertionError for what it says wrongly.

    cpp: the environment of C++ programs that use this server, None if there are none.
    """
    source = program(page, cpp is not None)
    script = directory / page.name
    script.write_text(_renumbered(source, FIRST, port))
    with Process(
        [sys.executable, script],
        cwd=directory,
        start=fork_server.start,
        env={
            **_clean(),
            "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
            "PYTHONPATH": str(Path(__file__).parents[1]),
            "YARP_CONFIG_HOME": str(directory / "config"),
            "YARPY_SERVER": f"127.0.0.1:{port}",
            **({"YARP_PORT_RANGE": str(port)} if page.name in ALONE else {}),
            "PAGE_PORT": str(port),
            "PAGE_CPP": json.dumps(cpp),
        },
    ) as done:
        done.end_input()
        code = done.wait(3 * HANG)
    said = f"{done.stdout}\n{done.stderr}"
    assert code == 0, f"{page.name} fails:\n{said}"
    output = _renumbered(done.stdout, port, FIRST).splitlines()
    for text in printed(source):
        while output and _comparable(output[0]) != _comparable(text):
            del output[0]
        assert output, f"{page.name} does not print {text!r} (at its place):\n{said}"


def free_port() -> int:
    """A number for the name server of a page; those that it hands out are free too."""
    return free_block(SIZE)


# --- in the page's program


def replay(lines: Sequence[str], note: str) -> None:
    """Type the commands of a session, and compare what they say."""
    while lines:
        command, count = lines[0].removeprefix("$ "), 1
        assert lines[0].startswith("$ "), f"a session begins with `$ command`, not {lines[0]!r}"
        while count < len(lines) and lines[count].startswith("> "):
            command += "\n" + lines[count][2:]
            count += 1
        end = next((n for n in range(count, len(lines)) if lines[n].startswith("$ ")), len(lines))
        _replay(command, lines[count:end], note)
        lines = lines[end:]


def _replay(command: str, expected: Sequence[str], note: str) -> None:
    expected = list(expected)
    interrupted = expected[-1:] == ["^C"]
    environment = json.loads(os.environ["PAGE_CPP"]) if note == "cpp" else os.environ
    with Process(["bash", "-c", f"exec 2>&1; {command}"], env=environment) as process:
        if interrupted:
            del expected[-1]
            last = expected[-1]
            pattern = ".*".join(map(re.escape, _NUMBER.split(last)))
            process.wait_line(pattern, count=expected.count(last), timeout=HANG)
            os.killpg(process.pid, signal.SIGINT)
        else:
            process.end_input()
            process.wait(HANG)
        said = process.stdout.rstrip("\n")  # C++ likes an empty line at the end
    if not _agree(expected, said.splitlines(), interrupted):
        port = int(os.environ["PAGE_PORT"])
        wanted = "\n".join(expected)
        both = f"`{command}` says\n\n{said}\n\nand not\n\n{wanted}"
        raise AssertionError(_renumbered(both, port, FIRST))


def _agree(expected: Sequence[str], said: Sequence[str], more: bool) -> bool:
    """Whether a session went as it stands in the page; with `more`, it may have gone on."""
    if not expected:
        return more or not said
    if expected[0] == "...":
        return any(_agree(expected[1:], said[skip:], more) for skip in range(len(said) + 1))
    if not said or _comparable(expected[0]) != _comparable(said[0]):
        return False
    return _agree(expected[1:], said[1:], more)


# --- numbers and environments


def _comparable(line: str) -> str:
    return _NUMBER.sub("#", line).rstrip()


def _renumbered(text: str, first: int, other: int) -> str:
    """`text` with the port numbers from `first` on as those from `other` on."""

    def change(found: re.Match[str]) -> str:
        number = int(found[0])
        return str(number - first + other) if first <= number < first + SIZE else found[0]

    return re.sub(r"(?<![\d.])\d{5}(?![\d.]\d)(?!\d)", change, text)


def _clean() -> dict[str, str]:
    return {
        name: value for name, value in os.environ.items() if not name.startswith(("YARP", "XDG_"))
    }
