"""A reader that is interrupted at any moment, and reads on, misses nothing that was acknowledged.

`python tests/life/interrupting.py` is the long form.
"""

from __future__ import annotations

import pytest
from life.interrupting import CARRIERS, SIZES, interrupt_reader
from support.system import NO_TIMER

RUNS = [*((carrier, "strict") for carrier in CARRIERS), ("tcp", "plain"), ("tcp", "buffered")]


@pytest.mark.skipif(bool(NO_TIMER), reason=NO_TIMER)
@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize(("carrier", "reader"), RUNS)
def test_reader_goes_on_after_interrupts(carrier: str, reader: str, size: int) -> None:
    outcome = interrupt_reader(carrier, reader, size, "2000", 30)
    assert outcome.interrupts == 30
    assert outcome.wedged == 0
    assert outcome.twice == 0
    assert outcome.swallowed == 0
    if carrier != "udp":  # where the kernel loses what it likes
        assert outcome.gaps == 0
