"""Bottle text against C++ YARP itself: thousands of odd lines, read and printed by both."""

import json
import random

from support.cpp import CppYarp

from yarpy.data.bottle import Bottle
from yarpy.data.value import GROUP_MASK
from yarpy.data.writer import list_blocks

_CPP = """
import json, sys, yarp
for line in sys.stdin:
    bottle = yarp.Bottle()
    bottle.fromString(bytes.fromhex(line.strip()).decode())
    codes = [bottle.get(i).getCode() for i in range(bottle.size())]
    print(json.dumps([codes, bottle.toString()]))
"""

_CHARACTERS = '()[]{}"\\ ,.0123456789abefinxX+-\t\n\r tru null false0x.eE\u00e9\u65e5\x01\x0b'
_PIECES = (
    "0x 0x1.8 1e - + .5 (1_2) {1_-2_x} [abc] [é] é null inf nan -inf -nan true fal\\se \\ "
    "\\n 9999999999 99999999999999999999 -9223372036854775809 010 08 0x80000000 0xffffffffff 1-2 "
    "1.5e3 1.5-2 ( (( ) } { , a\\_b 0x-5 00x1 -0x1.8 [ [a_b] ß \x01 0x1p3 1_0 [éa] "
    '{true_[ab]_null_3.7} {1e99_-5_300} {é_"5"_(1)_9999999999_1e300} "a_b" "x\\"y" "\\0" "a"b'
)


def lines(count: int) -> list[str]:
    """Lines of random characters and of random pieces with a meaning, always the same ones."""
    rng = random.Random(7)
    pieces = _PIECES.split()
    found = []
    for index in range(count):
        if index % 2:
            found.append("".join(rng.choices(_CHARACTERS, k=rng.randrange(1, 24))))
        else:
            words = rng.choices(pieces, k=rng.randrange(1, 7))
            found.append(rng.choice((" ", "", ", ")).join(words).replace("_", " "))
    return found


def test_both_read_and_print_the_same(cpp: CppYarp) -> None:
    texts = lines(6000)
    answers = cpp.python(_CPP, input="".join(text.encode().hex() + "\n" for text in texts)).stdout
    printed = [json.loads(line) for line in answers.splitlines() if line.startswith("[[")]
    assert len(printed) == len(texts)
    newer = {20: 10} if cpp.version >= (4, 0) else {}  # what YARP 4 calls a float64
    for text, (codes, shown) in zip(texts, printed, strict=True):
        bottle = Bottle.from_text(text)
        # (the code of a list leaves out what kind of list; that of a vocab or number does not)
        ours = [_code(item) for item in bottle]
        if 18 in codes:
            continue  # a vocab of more than four letters, which only YARP 4 has
        theirs = [newer.get(_plain(code), _plain(code)) for code in codes]
        assert (ours, bottle.to_text()) == (theirs, shown), repr(text)


def _code(item: object) -> int:
    head = b"".join(list_blocks([item, item, []]))
    return _plain(int.from_bytes(head[8:12], "little"))


def _plain(code: int) -> int:
    return code & GROUP_MASK or code
