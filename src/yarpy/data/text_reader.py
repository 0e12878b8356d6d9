"""Text to the elements of a Bottle, as C++ YARP reads it to the letter.

    word "two words" 12 0x1f 3.5 [voc] true (a list) {1 2 255}

Rules: reading works on bytes and never fails: unfinished and unbalanced parts vanish. The single
exception is nesting beyond MAX_DEPTH, a DecodeError. What the lists are made of, the caller says:
this file does not know Bottle. `text.py` prints what is read here.
"""

from __future__ import annotations

import re
import sys
from typing import Any, Final

from yarpy.data.value import (
    MAX_DEPTH,
    Vocab,
    vocab_code,
    vocab_of,
)
from yarpy.errors import DecodeError
from yarpy.limit import limits

#: bytes of a text that are too few to count its elements
_FREE: Final = 1 << 10

#: bytes of nested text that are always read, however deep
_FREE_WORK: Final = 1 << 22

_INT64_MAX: Final = 0x7FFFFFFFFFFFFFFF

#: Everything the tokeniser has to look at: an escape, a quote, a bracket or a separator.
_MARK = re.compile(rb'\\.|["(){}]|[, \t\r\n]', re.DOTALL)

#: What makes a text more than words between separators.
_NESTING = re.compile(rb'[\\"(){}]')
_WORD = re.compile(rb"[^, \t\r\n]++")

#: The same where quotes are allowed: an even number of them closes each that was opened.
_DEEPER = re.compile(rb"[\\(){}]")
_TOKEN = re.compile(rb'(?>(?:"[^"]*+"|[^", \t\r\n]++)+)')
_SEPARATORS: Final = bytes.maketrans(b",\t\r\n", b"    ")

#: Leading zeros, signs and x, then digits: anything else makes a token a word.
_NUMBER = re.compile(rb"([0+\-xX]*+)([0-9.eE+\-a-fA-F]*+)")
_C_INT = re.compile(rb"([+-]?)(?:0[xX]([0-9a-fA-F]+)|(0[0-7]*)|([1-9][0-9]*))")
_C_FLOAT = re.compile(rb"[+-]?(?:[0-9]++(?:\.[0-9]*+)?|\.[0-9]++)(?:[eE][+-]?[0-9]++)?")
_C_HEX_FLOAT = re.compile(rb"[+-]?0[xX](?:[0-9a-fA-F]++(?:\.[0-9a-fA-F]*+)?|\.[0-9a-fA-F]++)")
_ESCAPE = re.compile(rb"\\(.?)", re.DOTALL)
_ESCAPED: Final = {b"n": b"\n", b"r": b"\r", b"0": b"\0"}


def parse_text(text: str | bytes, make_list: type[list[Any]] = list) -> list[Any]:
    """The elements that a line of text stands for; DecodeError only for hundreds of brackets.

    Lists among them are made by `make_list(elements)`.
    """
    data = text.encode("utf-8", "surrogateescape") if isinstance(text, str) else bytes(text)
    most = len(data) if len(data) <= _FREE else limits().elements
    return _parse(data, [max(_FREE_WORK, 8 * len(data)), most], make_list)


class Balance:
    """Tells whether the quotes and brackets of a text that comes piece by piece are closed; if not,
    a text peer sends more lines. Every byte is read once.

    `feed(first_line)`, then `feed(b"\\n" + next_line)` and so on until it says True.
    """

    __slots__ = ("_curly", "_escaped", "_quoted", "_round")

    def __init__(self) -> None:
        self._quoted = self._escaped = False
        self._round = self._curly = 0

    def feed(self, piece: bytes) -> bool:
        """Take the next piece of the text; return whether everything is closed at its end."""
        at = 1 if self._escaped and piece else 0
        for mark in _MARK.finditer(piece, at):
            char = mark.group()
            if char == b'"':
                self._quoted = not self._quoted
            elif not self._quoted:
                self._round += (char == b"(") - (char == b")")
                self._curly += (char == b"{") - (char == b"}")
            at = mark.end()
        if piece:  # a last backslash waits for its character
            self._escaped = piece.find(b"\\", at) >= 0
        return not (self._quoted or self._round or self._curly)


def _parse(data: bytes, work: list[int], make_list: type[list[Any]]) -> list[Any]:
    # The inside of a list is read once more for every list around it. `work` is how many bytes may
    # still be read, so that deep and long text cannot keep us busy for minutes, and how many
    # elements may still be made.
    work[0] -= len(data)
    if work[0] < 0:
        raise DecodeError("text with lists too deeply nested for its length")
    found = tokens(data, work[1])
    work[1] -= len(found)
    return [_classify(token, work, make_list) for token in found]


def tokens(data: bytes, most: int = sys.maxsize) -> list[bytes]:
    """The tokens of a text, still with their quotes, brackets and escapes.

    DecodeError for more than MAX_DEPTH round brackets in each other, whatever they mean, and for
    more than `most` tokens.
    """
    found: list[bytes] = []
    if _NESTING.search(data) is None:
        if len(data) > most and sum(1 for _ in _WORD.finditer(data)) > most:
            raise _too_many()
        return [word for word in data.translate(_SEPARATORS).split(b" ") if word]
    if _DEEPER.search(data) is None and not data.count(b'"') & 1:
        words = _TOKEN.findall(data)
        if len(words) > most:
            raise _too_many()
        return words
    start = 0
    quoted = False
    round_depth = curly_depth = 0
    data += b" "  # the last token needs an end, a last backslash something to take
    for mark in _MARK.finditer(data):
        char = mark.group()
        if char == b'"':
            quoted = not quoted
        elif quoted:
            continue
        elif char == b"(":
            round_depth += 1
            if round_depth > MAX_DEPTH:
                raise DecodeError(f"text with lists nested more than {MAX_DEPTH} deep")
        elif char == b")":
            round_depth -= 1
        elif char == b"{":
            curly_depth += 1
        elif char == b"}":
            curly_depth -= 1
        elif len(char) == 1 and not round_depth and not curly_depth:
            end = mark.start()
            if end > start:
                if len(found) >= most:
                    raise _too_many()
                found.append(data[start:end])
            start = end + 1
    return found


def _too_many() -> DecodeError:
    return DecodeError(f"a text of more than {limits().elements} elements (YARPY_MAX_ELEMENTS)")


def _classify(token: bytes, work: list[int], make_list: type[list[Any]]) -> Any:
    first = token[:1]
    if first in b"0123456789+-.in":
        number = _number(token)
        if number is not None:
            return number
        if token == b"null":
            return Vocab("null")
    elif first == b"(":
        return make_list(_parse(token[1:-1], work, make_list))
    elif first == b"[":
        return vocab_of(vocab_code(token[1:-1]))
    elif first == b"{":
        return bytes(map(_byte, tokens(token[1:-1], work[1])))
    elif first == b'"':
        return _unescape(token[1:-1])
    word = _unescape(token)
    if word == "true":
        return True
    if word == "false":
        return False
    return word


def _unescape(word: bytes) -> str:
    if b"\\" in word:
        word = _ESCAPE.sub(lambda match: _ESCAPED.get(match[1], match[1]), word)
    return word.decode("utf-8", "surrogateescape")


def _byte(token: bytes) -> int:
    """One byte of a blob: the low bits of the token's value as an integer."""
    if token == b"null":
        return ord("n")
    first = token[:1]
    if first == b"[":
        return vocab_code(token[1:-1]) & 0xFF
    if first in b"0123456789+-.in":
        number = _number(token)
        if isinstance(number, float):
            # beyond 32 bits the processor answers with a value whose low bits are zero
            return int(number) & 0xFF if -0x80000000 <= number < 0x80000000 else 0
        if number is not None:
            return number & 0xFF
    if first not in b'"({' and _unescape(token) == "true":
        return 0x31
    return 0


def _number(token: bytes) -> int | float | None:
    """The number a token stands for; None if it is a word."""
    if token.isdigit() and token[:1] != b"0" and len(token) < 19:
        return int(token)
    if token == b"inf" or token == b"-inf" or token == b"nan":
        return float(token)
    match = _NUMBER.fullmatch(token)
    if match is None or token == b".":
        return None
    lead, rest = match.groups()
    if lead.count(b"+") + lead.count(b"-") > 1 or rest.count(b".") > 1:
        return None
    marker = max(lead.rfind(b"x"), lead.rfind(b"X"))
    if marker >= 0:
        if len(token) - marker - 1 > 8:
            return None
        return _c_float(token) if b"." in rest else _c_int(token)
    if rest.strip(b"0123456789.eE+-"):
        return None
    if b"." in rest or b"e" in rest or b"E" in rest:
        return _c_float(token)
    return _c_int(token)


def _c_int(token: bytes) -> int:
    """strtoll with base 0: as far as it goes, a leading 0 means octal, saturating at 64 bits."""
    match = _C_INT.match(token)
    if match is None:
        return 0
    sign, hexadecimal, octal, decimal = match.groups()
    if decimal:
        # (the interpreter refuses to convert thousands of digits)
        value = int(decimal) if len(decimal) < 20 else _INT64_MAX + 1
    else:
        value = int(hexadecimal, 16) if hexadecimal else int(octal, 8)
    if sign == b"-":
        return max(-value, -_INT64_MAX - 1)
    return min(value, _INT64_MAX)


def _c_float(token: bytes) -> float:
    """strtod, and 0.0 unless all of the token is a number."""
    if _C_FLOAT.fullmatch(token):
        return float(token)
    if _C_HEX_FLOAT.fullmatch(token):
        return float.fromhex(token.decode("ascii"))
    return 0.0
