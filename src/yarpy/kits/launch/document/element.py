"""Elements of an XML file with their places: what the readers of applications stand on.

Rules: pure. Declarations of entities are refused, so is an element too many or too deep, before
memory is taken for it; a document type is only noted, and nothing is fetched. Two slips that the
parser of C++ YARP forgives are forgiven here, too: two hyphens inside a comment, and an ampersand
that stands alone.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Final
from xml.parsers import expat

from yarpy.errors import DecodeError
from yarpy.kits.launch.document.problem import Where
from yarpy.limit import APPLICATION_DEPTH, APPLICATION_ELEMENTS, APPLICATION_FILE

_ENCODING: Final = re.compile(rb"""\A\s*<\?xml[^>]{0,200}?encoding\s*=\s*["']([\w.-]{1,40})["']""")
_ENCODINGS: Final = ("utf-8", "us-ascii", "ascii", "iso-8859-1", "latin1", "windows-1252", "utf-16")
_ASIDE: Final = (("<!--", "-->"), ("<![CDATA[", "]]>"))
_LETTERS: Final = re.compile(r"[^\n]")
_HEAD: Final = re.compile(r"\A\s*<\?xml[^>]{0,400}\?>")
_ALONE: Final = re.compile(r"&(?!(?:#\d{1,7}|#x[0-9A-Fa-f]{1,6}|amp|lt|gt|quot|apos);)")
_AND: Final = "\ufdd0"  # stands for an ampersand, in the same column


@dataclass(frozen=True, slots=True)
class Doctype:
    """A document type: the tag that it is for, and its identifiers."""

    tag: str
    public: str
    system: str
    where: Where


@dataclass(slots=True)
class Element:
    """A tag with its attributes, the text directly in it, and the tags in it; `doctype` is that of
    the file, at its root."""

    tag: str
    where: Where
    attributes: dict[str, str] = field(default_factory=dict)
    text: str = ""
    children: list[Element] = field(default_factory=list)
    doctype: Doctype | None = None

    def all(self, tag: str) -> Iterator[Element]:
        """Yield the children that are called so, exactly."""
        return (child for child in self.children if child.tag == tag)


class BadFile(DecodeError):
    """A file that is no XML, or more than a file may be; `where` says where."""

    def __init__(self, where: Where, text: str) -> None:
        super().__init__(f"{where}: {text}")
        self.where = where
        self.text = text


def parse(data: bytes, file: str) -> Element:
    """Return the root of a file. Raises BadFile."""
    if len(data) > APPLICATION_FILE:
        raise BadFile(Where(file), f"the file has more than {APPLICATION_FILE} bytes")
    text = _forgiven(_decoded(data, file))
    reading = _Reading(file)
    try:
        return reading.run(text)
    except expat.ExpatError as error:
        said = expat.ErrorString(error.code) or str(error)
        where = Where(file, error.lineno, error.offset + 1)
        raise BadFile(where, f"this is no XML: {said}") from None


def _decoded(data: bytes, file: str) -> str:
    found = _ENCODING.match(data.removeprefix(b"\xef\xbb\xbf"))
    name = found[1].decode().lower() if found else "utf-8"
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        name = "utf-16"
    if name not in _ENCODINGS:
        raise BadFile(
            Where(file, 1), f'the encoding "{name}" is not known: write the file in utf-8'
        )
    text = decoded(data, file, name)
    return _HEAD.sub(lambda head: _LETTERS.sub(" ", head[0]), text, count=1)


def decoded(data: bytes, file: str, name: str) -> str:
    """Return the text of bytes in the encoding `name`. Raises BadFile."""
    try:
        return data.decode("utf-8-sig" if name == "utf-8" else name)
    except UnicodeDecodeError as error:
        before = data[: error.start]
        line = before.count(b"\n") + 1
        column = len(before) - (before.rfind(b"\n") + 1) + 1
        raise BadFile(Where(file, line, column), f"these bytes are not {name}") from None


def _forgiven(text: str) -> str:
    """The text with comments blanked out, and stray ampersands replaced; no place moves."""
    parts: list[str] = []
    place = 0
    while (start := text.find("<!", place)) >= 0:
        begin, end = next((pair for pair in _ASIDE if text.startswith(pair[0], start)), ("<!", ""))
        stop = text.find(end, start + len(begin)) if end else start + len(begin)
        if stop < 0:
            break  # the parser says what is open
        stop += len(end)
        parts.append(_ALONE.sub(_AND, text[place:start]))
        inside = text[start:stop]
        parts.append(_LETTERS.sub(" ", inside) if begin == "<!--" else inside)
        place = stop
    parts.append(_ALONE.sub(_AND, text[place:]))
    return "".join(parts)


class _Reading:
    """One pass of the parser."""

    def __init__(self, file: str) -> None:
        self._file = file
        self._root: Element | None = None
        self._open: list[Element] = []
        self._texts: list[list[str]] = []
        self._count = 0
        self._doctype: Doctype | None = None
        self._parser = parser = expat.ParserCreate("utf-8")
        parser.buffer_text = True
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        parser.CharacterDataHandler = self._data
        parser.StartDoctypeDeclHandler = self._type
        parser.EntityDeclHandler = self._entity
        parser.UnparsedEntityDeclHandler = self._entity
        parser.ExternalEntityRefHandler = self._entity

    def run(self, text: str) -> Element:
        self._parser.Parse(text.encode("utf-8", "surrogatepass"), True)
        assert self._root is not None  # else expat finds no element
        self._root.doctype = self._doctype
        return self._root

    def _where(self) -> Where:
        parser = self._parser
        return Where(self._file, parser.CurrentLineNumber, parser.CurrentColumnNumber + 1)

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self._count += 1
        if self._count > APPLICATION_ELEMENTS:
            raise BadFile(self._where(), f"there are more than {APPLICATION_ELEMENTS} tags")
        if len(self._open) >= APPLICATION_DEPTH:
            raise BadFile(self._where(), f"tags are more than {APPLICATION_DEPTH} deep")
        values = {key: value.replace(_AND, "&") for key, value in attributes.items()}
        element = Element(tag, self._where(), values)
        if self._open:
            self._open[-1].children.append(element)
        else:
            self._root = element
        self._open.append(element)
        self._texts.append([])

    def _end(self, tag: str) -> None:
        text = "".join(self._texts.pop()).strip()
        self._open.pop().text = text.replace(_AND, "&")

    def _data(self, text: str) -> None:
        if self._texts:
            self._texts[-1].append(text)

    def _type(self, tag: str, system: str | None, public: str | None, inside: bool) -> None:
        self._doctype = Doctype(tag, public or "", system or "", self._where())

    def _entity(self, *declared: object) -> int:
        raise BadFile(self._where(), "entities are not read: write out what they stand for")
