"""Read the text of `.thrift` files, with the grammar of Apache Thrift 0.14.

    parse(text, file)    the Document; DecodeError says file, line, column, and what was expected

Rules: what is read in a file does not depend on others: names are looked up by `interface`.
Comments `/** ... */` belong to what follows. Time is in proportion to the length of the file. lark
is imported here and nowhere else (extra `thrift`).
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from inspect import cleandoc
from typing import Any, Final

from yarpy.errors import DecodeError, UnknownPlugin
from yarpy.kits.thrift.file.document import (
    Annotations,
    ConstText,
    Document,
    EnumText,
    FieldText,
    MethodText,
    Name,
    Pairs,
    ServiceText,
    StructText,
    TypedefText,
    TypeText,
    ValueText,
)
from yarpy.limit import THRIFT_DEPTH, THRIFT_TEXT

_LONGEST: Final = 200  # characters of a name

GRAMMAR: Final = r"""
document: (include | namespace)* (const | typedef | enum | struct | service)*
include: "include" STRING | "cpp_include" STRING -> ignored
namespace: "namespace" (NAME | "*") NAME annotations? _SEP?

const: "const" type NAME "=" value _SEP?
typedef: "typedef" type NAME annotations? _SEP?
enum: "enum" NAME "{" member* "}" annotations? _SEP?
member: NAME ("=" INT)? annotations? _SEP?
struct: ("struct" | union | exception) NAME "{" field* "}" annotations? _SEP?
union: "union"
exception: "exception"
service: "service" NAME extends? "{" method* "}" annotations? _SEP?
extends: "extends" NAME
method: oneway? (type | void) NAME "(" field* ")" throws? annotations? _SEP?
oneway: "oneway"
void: "void"
throws: "throws" "(" field* ")"

field: number? (required | optional)? type reference? NAME default? annotations? _SEP?
required: "required"
optional: "optional"
reference: "&"
number: INT ":"
default: "=" value

type: NAME annotations? | container annotations?
container: "list" "<" type ">" -> list_
    | "set" "<" type ">" -> set_
    | "map" "<" type _SEP type ">" -> map_

annotations: "(" annotation* ")"
annotation: NAME ("=" STRING)? _SEP?

value: INT -> integer | HEX -> hexadecimal | DOUBLE -> number_ | STRING -> string
    | NAME -> name | "[" (value _SEP?)* "]" -> sequence
    | "{" (pair _SEP?)* "}" -> pairs
pair: value ":" value

NAME: /[A-Za-z_][A-Za-z0-9_.]*+/
HEX.3: /[+-]?0x[0-9A-Fa-f]++/
DOUBLE.2: /[+-]?(\d*+\.\d++([eE][+-]?\d++)?|\d++[eE][+-]?\d++)/
INT.1: /[+-]?\d++/
STRING: /"[^"\\\n]*+(?>(\\.[^"\\\n]*+)*)"|'[^'\\\n]*+(?>(\\.[^'\\\n]*+)*)'/
_SEP: /[,;]/
COMMENT: /\/\/[^\n]*+|#[^\n]*+|\/\*[^*]*+(?>(\*(?!\/)[^*]*+)*)\*\//
SPACE: /\s++/
%ignore COMMENT
%ignore SPACE
"""

_WORDS: Final = {
    "NAME": "a name", "INT": "a number", "STRING": "a text in quotes", "HEX": "a number",
    "DOUBLE": "a number", "_SEP": "", "$END": "the end of the file", "LPAR": '"("', "RPAR": '")"',
    "LBRACE": '"{"', "RBRACE": '"}"', "LSQB": '"["', "RSQB": '"]"', "LESSTHAN": '"<"',
    "MORETHAN": '">"', "EQUAL": '"="', "COLON": '":"', "COMMA": '","', "STAR": '"*"',
}  # fmt: skip
_ESCAPES: Final = {"n": "\n", "r": "\r", "t": "\t"}
_BETWEEN: Final = re.compile(r"(?>(?:\s++|//[^\n]*+|#[^\n]*+)*)")
_MARGIN: Final = re.compile(r"^[ \t]*+\*?[ \t]?", re.MULTILINE)


def parse(text: str, file: str = "text") -> Document:
    """Parse the text of a file. Raises DecodeError."""
    if len(text) > THRIFT_TEXT:
        raise DecodeError(f"{file} has {len(text)} characters, more than {THRIFT_TEXT}")
    lark = _library()
    reading = _Reading(text, file)
    try:
        parser = _parser(lark)
        tree = parser.parse(text)
        return reading.document(tree)
    except lark.exceptions.UnexpectedToken as error:
        found = "the end of the file" if error.token.type == "$END" else f'"{error.token!s:.40}"'
        raise reading.wrong(
            error.token.line or 1, f"expected {_expected(error.accepts)}, found {found}",
            error.token.column,
        ) from None  # fmt: skip
    except lark.exceptions.UnexpectedCharacters as error:
        found = text[error.pos_in_stream : error.pos_in_stream + 1]
        what = {'"': "a text without its second quote", "'": "a text without its second quote"}
        described = what.get(found) or (
            "a comment without its end" if text.startswith("/*", error.pos_in_stream) else
            f'"{found}"'
        )  # fmt: skip
        raise reading.wrong(
            error.line, f"expected {_expected(error.allowed or ())}, found {described}",
            error.column,
        ) from None  # fmt: skip


def _library() -> Any:
    try:
        import lark
    except ImportError:
        raise UnknownPlugin(
            "reading .thrift files takes the package lark: pip install 'yarpy[thrift]' (modules "
            "written by `yarpy idl thrift` work without it)"
        ) from None
    return lark


@cache
def _parser(lark: Any) -> Any:
    return lark.Lark(
        GRAMMAR, parser="lalr", start="document", propagate_positions=True, maybe_placeholders=False
    )


def _expected(names: Any) -> str:
    words = sorted({_WORDS.get(name, f'"{name.lower()}"') for name in names} - {""}) or ['","']
    if len(words) > 8:
        words = [*words[:7], "..."]
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} or {words[-1]}"


class _Reading:
    """The tree of a file to its Document. No recursion goes deeper than THRIFT_DEPTH."""

    def __init__(self, text: str, file: str) -> None:
        self.text = text
        self.file = file
        docs = [
            (found.end(), found[0])
            for found in re.finditer(
                # What lacks its end is skipped as far as it goes, and not tried again within.
                r"\"[^\"\\\n]*+(?>(?:\\.[^\"\\\n]*+)*)\"?|'[^'\\\n]*+(?>(?:\\.[^'\\\n]*+)*)'?"
                r"|//[^\n]*+|#[^\n]*+|/\*[^*]*+(?>(?:\*(?!/)[^*]*+)*)(?:\*/)?",
                text,
            )
            if found[0].startswith("/**") and found[0].endswith("*/") and len(found[0]) > 4
        ]
        # Where it begins what a comment belongs to.
        self._belong = {_BETWEEN.match(text, end).end(): doc for end, doc in docs}  # type: ignore[union-attr]

    def wrong(self, line: int, why: str, column: int | None = None) -> DecodeError:
        where = f":{column}" if column else ""
        return DecodeError(f"{self.file}:{line}{where}: {why}")

    def doc(self, tree: Any) -> str:
        """The comment before something."""
        text = self._belong.get(tree.meta.start_pos, "")
        return cleandoc(_MARGIN.sub("", text[3:-2].strip("*"))).strip()

    def document(self, tree: Any) -> Document:
        includes: list[tuple[str, int]] = []
        namespaces: dict[str, str] = {}
        declarations: list[Any] = []
        kinds: dict[str, Callable[[Any], Any]] = {
            "const": self.const, "typedef": self.typedef, "enum": self.enum,
            "struct": self.struct, "service": self.service,
        }  # fmt: skip
        for child in tree.children:
            if child.data == "include":
                includes.append((self.string(child.children[0]), child.meta.line))
            elif child.data == "namespace":
                words = [str(word) for word in child.children if not hasattr(word, "data")]
                namespaces[words[0] if len(words) > 1 else "*"] = words[-1]
            elif child.data in kinds:
                declarations.append(kinds[child.data](child))
        return Document(self.file, tuple(includes), namespaces, tuple(declarations))

    def string(self, token: Any) -> str:
        return re.sub(r"\\(.)", lambda found: _ESCAPES.get(found[1], found[1]), str(token)[1:-1])

    def simple(self, token: Any) -> str:
        """A name without dots."""
        if len(token) > _LONGEST:
            raise self.wrong(token.line, f'"{token!s:.20}..." is longer than {_LONGEST} characters')
        if "." in token:
            raise self.wrong(token.line, f'"{token}" is no name: it has a dot in it', token.column)
        return str(token)

    def annotations(self, tree: Any) -> Annotations:
        """Return the annotations among the children of a node."""
        found: Annotations = {}
        for child in _all(tree, "annotations"):
            for each in child.children:
                name, *value = each.children
                found[str(name)] = self.string(value[0]) if value else "1"
        return found

    def type(self, tree: Any, depth: int = 0) -> TypeText:
        if depth > THRIFT_DEPTH:
            raise self.wrong(tree.meta.line, f"types are nested more than {THRIFT_DEPTH} deep")
        first = tree.children[0]
        annotations = self.annotations(tree)
        if hasattr(first, "data"):
            inner = tuple(self.type(child, depth + 1) for child in first.children)
            name = first.data.rstrip("_")
            return TypeText(str(name), inner, annotations, tree.meta.line)
        return TypeText(str(first), (), annotations, tree.meta.line)

    def value(self, tree: Any, depth: int = 0) -> Any:
        if depth > THRIFT_DEPTH:
            raise self.wrong(tree.meta.line, f"values are nested more than {THRIFT_DEPTH} deep")
        if tree.data == "sequence":
            return [self.value(child, depth + 1) for child in tree.children]
        if tree.data == "pairs":
            return Pairs(tuple(self.pair(pair, depth + 1) for pair in tree.children))
        token = tree.children[0]
        if tree.data == "integer" or tree.data == "hexadecimal":
            return self.integer(token)
        if tree.data == "number_":
            return float(token)
        if tree.data == "string":
            return self.string(token)
        return Name(str(token), token.line)

    def pair(self, tree: Any, depth: int) -> tuple[Any, Any]:
        key, value = tree.children
        return self.value(key, depth), self.value(value, depth)

    def integer(self, token: Any) -> int:
        if len(token) > 24:
            raise self.wrong(token.line, f"{token!s:.20}... is too large", token.column)
        number = int(token, 16 if "x" in token else 10)
        if not -(1 << 63) <= number < 1 << 64:
            raise self.wrong(token.line, f"{token} does not fit in 64 bits", token.column)
        return number

    def const(self, tree: Any) -> ConstText:
        type_, name, value = tree.children
        return ConstText(
            self.simple(name), self.type(type_), self.value(value), self.doc(tree), name.line
        )

    def typedef(self, tree: Any) -> TypedefText:
        type_, name = tree.children[:2]
        return TypedefText(self.simple(name), self.type(type_), self.doc(tree), name.line)

    def enum(self, tree: Any) -> EnumText:
        name = tree.children[0]
        values: list[ValueText] = []
        number = -1
        for child in _all(tree, "member"):
            tokens = [each for each in child.children if not hasattr(each, "data")]
            number = self.integer(tokens[1]) if len(tokens) > 1 else number + 1
            values.append(
                ValueText(self.simple(tokens[0]), number, self.doc(child), tokens[0].line)
            )
        return EnumText(
            self.simple(name), tuple(values), self.annotations(tree), self.doc(tree), name.line
        )

    def struct(self, tree: Any) -> StructText:
        name = next(child for child in tree.children if not hasattr(child, "data"))
        fields = tuple(self.field(child) for child in _all(tree, "field"))
        return StructText(
            self.simple(name), fields, self.annotations(tree), self.doc(tree), name.line,
            next((word for word in ("union", "exception") if _has(tree, word)), "struct"),
        )  # fmt: skip

    def field(self, tree: Any) -> FieldText:
        name = next(child for child in tree.children if not hasattr(child, "data"))
        number = next(_all(tree, "number"), None)
        default = next(_all(tree, "default"), None)
        return FieldText(
            self.simple(name),
            self.type(next(_all(tree, "type"))),
            None if number is None else self.integer(number.children[0]),
            None if default is None else self.value(default.children[0]),
            self.annotations(tree),
            self.doc(tree),
            name.line,
            next((word for word in ("required", "optional") if _has(tree, word)), ""),
            _has(tree, "reference"),
        )

    def service(self, tree: Any) -> ServiceText:
        name = tree.children[0]
        extends = next(_all(tree, "extends"), None)
        return ServiceText(
            self.simple(name),
            "" if extends is None else str(extends.children[0]),
            tuple(self.method(child) for child in _all(tree, "method")),
            self.annotations(tree),
            self.doc(tree),
            name.line,
        )

    def method(self, tree: Any) -> MethodText:
        name = next(child for child in tree.children if not hasattr(child, "data"))
        result = next(_all(tree, "type"), None)
        return MethodText(
            self.simple(name),
            None if result is None else self.type(result),
            tuple(self.field(child) for child in _all(tree, "field")),
            next(_all(tree, "oneway"), None) is not None,
            self.annotations(tree),
            self.doc(tree),
            name.line,
            tuple(self.field(each) for child in _all(tree, "throws") for each in child.children),
        )


def _has(tree: Any, name: str) -> bool:
    """Return whether something has a child of a kind."""
    return next(_all(tree, name), None) is not None


def _all(tree: Any, name: str) -> Any:
    """The children of a kind."""
    return (child for child in tree.children if getattr(child, "data", "") == name)
