"""What type checkers say about decorated methods."""

from pathlib import Path

import pytest
from support.type_check import CHECKERS, faults

PROGRAM = """\
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from yarpy import wrap


class Eyes:
    @wrap.on("/left")
    def look(self, zoom: int = 1) -> NDArray[np.uint8]:
        return np.zeros(3, np.uint8)

    @wrap.on("/pose")
    @wrap.on("/angle")
    def both(self) -> tuple[int, float]:
        return 1, 2.0

    @wrap.on("/many")
    def many(self) -> Iterator[int]:
        yield 1

    @wrap.on("/later")
    async def later(self) -> int:
        return 1


@wrap.on("/name")
def name(of: int) -> str:
    return str(of)


eyes = Eyes()
print(eyes.look(timeout=5).mean(), eyes.look(3).mean(), Eyes.look(eyes).mean())
print(eyes.both()[1].is_integer(), name(1).upper(), name(1, timeout=2.0).upper())
with wrap.listen(eyes.look) as listening:
    print(listening().mean(), listening.closed)
for picture in wrap.stream(eyes.look):
    print(picture.mean())
for number in wrap.stream(eyes.many):
    print(number.bit_length())


async def wait() -> int:
    async for picture in wrap.stream(eyes.look):
        print(picture.mean())
    return await eyes.later()


eyes.look("far")  # mistake
name(1, timeout="soon")  # mistake
print(wrap.listen(eyes.look)().upper())  # mistake
print(eyes.both()[0].upper())  # mistake
wrap.publich(eyes.look)  # mistake
"""


@pytest.mark.timeout(300)
@pytest.mark.parametrize("checker", CHECKERS)
def test_calls_have_the_types_of_the_method_and_a_time_limit(tmp_path: Path, checker: str) -> None:
    (tmp_path / "program.py").write_text(PROGRAM)
    wrong = {at for at, line in enumerate(PROGRAM.splitlines(), 1) if "# mistake" in line}
    assert {fault.line for fault in faults(checker, tmp_path, "program.py")} == wrong
