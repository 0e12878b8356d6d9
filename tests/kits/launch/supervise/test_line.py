"""Lines of programs: cut anywhere, too long, without an end, not of UTF-8."""

import pytest

from yarpy.kits.launch.supervise.line import Lines
from yarpy.limit import OUTPUT_LINE


def lines(*pieces: bytes) -> list[str]:
    reading = Lines()
    return [line for piece in pieces for line in reading.feed(piece)] + [*reading.rest()]


@pytest.mark.parametrize(
    ("pieces", "expected"),
    [
        ([b"a\nb\n"], ["a", "b"]),
        ([b"a", b"b\n", b"c"], ["ab", "c"]),
        ([b"\n\n"], ["", ""]),
        ([b"a\r\nb\r\n"], ["a", "b"]),
        ([b" 10 %\r 90 %\r100 %\n"], ["100 %"]),
        ([b"\xc3", b"\xa9\n"], ["\u00e9"]),
        ([b"\xff\n"], ["\udcff"]),
        ([], []),
    ],
)
def test_lines(pieces: list[bytes], expected: list[str]) -> None:
    assert lines(*pieces) == expected
    whole = b"".join(pieces)
    assert lines(*(whole[n : n + 1] for n in range(len(whole)))) == expected


def test_a_line_without_end_is_cut_and_what_is_left_out_is_counted() -> None:
    size = OUTPUT_LINE
    found = lines(*[b"x" * 65536] * 20, b"\nshort\n")
    assert found == ["x" * size + f" ... and {20 * 65536 - size} bytes more", "short"]
    exact = b"y" * size
    assert lines(exact + b"\n") == [exact.decode()]
