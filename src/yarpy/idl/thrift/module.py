"""The Python module of an interface, as text: what `load` runs and `yarpy idl thrift` writes.

    class Point(thrift.Struct):                 class Arm(thrift.Service):
        x: thrift.i32 = 3                           @thrift.method
        tags: list[str] = thrift.new(list)          def move(self, to: Point) -> bool: ...

Rules: names are those that the parser let through, with a `_` behind where Python needs them;
everything else that comes from the file is written as a literal, so nothing in it becomes code. A
module needs no lark and no `.thrift` file. Stubs say more to editors: what lists of numbers may be
given as, and which arguments are optional.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Final

from yarpy.errors import DecodeError
from yarpy.idl.thrift import kind as kinds
from yarpy.idl.thrift.document import (
    ConstText,
    EnumText,
    FieldText,
    MethodText,
    Name,
    Pairs,
    ServiceText,
    StructText,
    TypedefText,
    TypeText,
)
from yarpy.idl.thrift.interface import BASE, Interface, enum_base, external
from yarpy.idl.thrift.kind import ARRAYS, BINARY, BOOL, DOUBLE, TEXT, External, Scalar
from yarpy.idl.thrift.word import ENUM, SERVICE, STRUCT, attribute

_PLAIN: Final = {BOOL: "bool", DOUBLE: "float", TEXT: "str", BINARY: "bytes"}
#: constants of this name say which version of an interface it is
VERSION: Final = "protocol_version"


def python(interface: Interface) -> str:
    """The text of the module. DecodeError for values that do not fit their types."""
    return _Module(interface, stubs=False).text()


def stubs(interface: Interface) -> str:
    """The text of its `.pyi` file."""
    return _Module(interface, stubs=True).text()


def summary(interface: Interface) -> str:
    """What is in a file: "1 enum, 3 structs, 20 methods in Arm"."""
    found = []
    declarations = interface.document.declarations
    for kind, name in (
        (ConstText, "constant"),
        (TypedefText, "typedef"),
        (EnumText, "enum"),
        (StructText, "struct"),
    ):
        count = sum(isinstance(each, kind) for each in declarations)
        if count:
            found.append(f"{count} {name}{'s' if count > 1 else ''}")
    for each in declarations:
        if isinstance(each, ServiceText):
            count = len(each.methods)
            found.append(f"{count} method{'s' if count != 1 else ''} in {each.name}")
    return ", ".join(found) or "nothing"


class _Module:
    def __init__(self, interface: Interface, stubs: bool) -> None:
        self.interface = interface
        self.stubs = stubs
        self.known: set[str] = set()  # what is defined so far
        taken = {*interface.names, *interface.includes}
        self.thrift = "thrift"
        while self.thrift in taken:
            self.thrift += "_"
        self.yarpy = "yarpy"
        while self.yarpy in taken:
            self.yarpy += "_"
        self.uses: set[str] = set()

    def text(self) -> str:
        document = self.interface.document
        blocks: list[str] = []
        services: list[str] = []
        for each in document.declarations:
            if isinstance(each, TypedefText):
                blocks.append(self.typedef(each))
            elif isinstance(each, ConstText):
                blocks.append(self.const(each))
            elif isinstance(each, EnumText):
                blocks.append(self.enum(each))
            elif isinstance(each, StructText):
                blocks.append(self.struct(each))
            else:
                blocks.append(self.service(each))
                services.append(attribute(each.name))
            self.known.add(each.name)
        if len(services) == 1 and "connect" not in self.interface.names:
            blocks.append(
                f"connect = {services[0]}.connect\nconnect_async = {services[0]}.connect_async"
            )
        head = f'"""The interface {self.interface.name}, written by `yarpy idl thrift`."""\n'
        imports = []
        typing = sorted(self.uses & {"Annotated", "Any", "Final"})
        if typing:
            imports.append(f"from typing import {', '.join(typing)}")
        third = []
        if "ArrayLike" in self.uses:
            third.append("from numpy.typing import ArrayLike")
        if "yarpy" in self.uses:
            third.append("import yarpy" + (f" as {self.yarpy}" if self.yarpy != "yarpy" else ""))
        third.append(
            "from yarpy.idl import thrift"
            + (f" as {self.thrift}" if self.thrift != "thrift" else "")
        )
        groups = [head, "\n".join(imports), "\n".join(third)]
        groups.append("\n".join(f"import {name}" for name in self.interface.includes))
        joined = "\n\n".join(group.strip("\n") for group in groups if group)
        body, before = "", ""
        for block in blocks:
            either = (before, block)
            if any(each.startswith("class ") for each in either):
                body += "\n\n\n"
            else:
                body += "\n" if before and not any("\n" in each for each in either) else "\n\n"
            before = block.rstrip("\n")
            body += before
        return joined + body + "\n"

    # -- declarations -----------------------------------------------------------------------------

    def typedef(self, each: TypedefText) -> str:
        return f"{_comment(each.doc)}{attribute(each.name)} = {self.annotation(each.type)}"

    def const(self, each: ConstText) -> str:
        self.uses.add("Final")
        value = self.value(each.type, each.value, each.line)
        name = attribute(each.name)
        if self.stubs:
            return f"{name}: Final[{self.annotation(each.type)}]"
        return f"{_comment(each.doc)}{name}: Final = {value}"

    def enum(self, each: EnumText) -> str:
        base = enum_base(self.interface, each)
        given = "" if base is kinds.I32 else f", base={self.scalar(base)}"
        lines = [f"class {attribute(each.name)}({self.thrift}.Enum{given}):"]
        lines += _docstring(each.doc, 1)
        if each.doc and each.values:
            lines.append("")
        for value in each.values:
            self._fit(base, value.number, value.line, f"{each.name}.{value.name}")
            lines += _comment(value.doc, 1).splitlines()
            lines.append(f"    {attribute(value.name, ENUM)} = {value.number}")
        if not each.values and not each.doc:
            lines.append("    pass")
        return "\n".join(lines)

    def struct(self, each: StructText) -> str:
        name = attribute(each.name)
        outside = external(each)
        if outside is not None:
            return f"{_comment(each.doc)}{name} = {self.external(outside)}"
        lines = [f"class {name}({self.thrift}.Struct):", *_docstring(each.doc, 1)]
        if each.doc and each.fields:
            lines.append("")
        for field in each.fields:
            kind = self.annotation(field.type, nested=_nested(field))
            lines += _comment(field.doc, 1).splitlines()
            default = self.default(field)
            lines.append(f"    {attribute(field.name, STRUCT)}: {kind} = {default}")
        if self.stubs and each.fields:
            lines.append("    def __init__(")
            lines.append("        self,")
            for field in each.fields:
                kind = self.accepted(field.type)
                lines.append(f"        {attribute(field.name, STRUCT)}: {kind} = ...,")
            lines.append("    ) -> None: ...")
        if not each.fields and not each.doc:
            lines.append("    pass")
        return "\n".join(lines)

    def service(self, each: ServiceText) -> str:
        base = f"{self.thrift}.Service"
        if each.extends:
            base = self.mention(each.extends, each.line)
        lines = [f"class {attribute(each.name)}({base}):", *_docstring(each.doc, 1)]
        if each.doc and each.methods:
            lines.append("")
        version = self.interface.names.get(VERSION)
        if isinstance(version, ConstText) and isinstance(version.value, int):
            lines += [f"    _version = {version.value}", ""]
        for method in each.methods:
            lines += self.method(method)
            lines.append("")
        if self.stubs:
            return "\n".join([*lines, *self.clients(each, base)])
        if len(lines) == 1:
            lines.append("    pass")
        return "\n".join(lines)

    def clients(self, each: ServiceText, base: str) -> list[str]:
        """The stubs of what `connect` and `connect_async` give: they take lists for arrays."""
        self.uses.add("Any")
        name = attribute(each.name)
        lines = []
        for kind, how in (("Client", "connect"), ("AsyncClient", "connect_async")):
            lines += [
                "    @classmethod",
                f"    def {how}(",
                "        cls, target: str, *, timeout: float | None = ..., carrier: str = ..., "
                "**options: Any",
                f"    ) -> _{name}{kind}: ...",
            ]
        before = base.rpartition(".")
        sync = f"{name}"
        apart = "object"
        if each.extends:
            sync = f"{before[0]}{before[1]}_{before[2]}Client, {name}"
            apart = f"{before[0]}{before[1]}_{before[2]}AsyncClient"
        lines += ["", f"class _{name}Client({sync}):"]
        lines.append("    def remote_version(self) -> tuple[int, int, int, int] | None: ...")
        for method in each.methods:
            lines += self.method(method, "def")[1:]
        lines += ["", f"class _{name}AsyncClient({apart}):"]
        lines += [
            "    timeout: float | None",
            "    async def remote_version(self) -> tuple[int, int, int, int] | None: ...",
            "    async def close(self) -> None: ...",
            f"    async def __aenter__(self) -> _{name}AsyncClient: ...",
            "    async def __aexit__(self, *error: object) -> None: ...",
        ]
        for method in each.methods:
            lines += self.method(method, "async def")[1:]
        return lines

    def method(self, method: MethodText, how: str = "") -> list[str]:
        """A method; `how`: of a client, so that it takes whatever becomes an array."""
        mark = "oneway" if method.oneway else "method"
        arguments = ["self"]
        optional = False
        for argument in method.arguments:
            name = attribute(argument.name)
            kind = self.annotation(argument.type, nested=_nested(argument))
            if how:
                kind = self.accepted(argument.type)
            text = f"{name}: {kind}"
            if argument.default is not None:
                text += " = ..." if self.stubs else f" = {self.default(argument)}"
                optional = True
            elif optional:
                raise self.interface.wrong(
                    argument.line, f'"{argument.name}" needs a default, as those before it have one'
                )
            arguments.append(text)
        result = "None" if method.result is None else self.annotation(method.result)
        name = attribute(method.name, SERVICE)
        how = how or "def"
        head = f"    {how} {name}({', '.join(arguments)}) -> {result}:"
        if len(head) > 100:
            inner = "".join(f"        {argument},\n" for argument in arguments)
            head = f"    {how} {name}(\n{inner}    ) -> {result}:"
        lines = [f"    @{self.thrift}.{mark}", head]
        lines += _docstring(method.doc, 2)
        lines.append("        ..." if self.stubs else "        raise NotImplementedError")
        return lines

    # -- types ------------------------------------------------------------------------------------

    def annotation(self, type_: TypeText, nested: bool = False) -> str:
        """How a type is written in Python."""
        found = self._annotation(type_)
        _, what = self.interface.resolve(type_)
        if nested and isinstance(what, StructText) and external(what) is None:
            return f"{self.thrift}.Nested[{found}]"
        return found

    def _annotation(self, type_: TypeText) -> str:
        if type_.name == "list":
            _, element = self.interface.resolve(type_.inner[0])
            if isinstance(element, Scalar) and element in ARRAYS and element is not kinds.SIZE:
                return f"{self.thrift}.{ARRAYS[element]}"
        if type_.name in ("list", "set", "map"):
            inner = ", ".join(map(self._annotation, type_.inner))
            return f"{'dict' if type_.name == 'map' else type_.name}[{inner}]"
        _, found = self.interface.resolve(type_)
        if isinstance(found, Scalar) and type_.name in BASE:
            return self.scalar(found)
        return self.mention(type_.name, type_.line)

    def accepted(self, type_: TypeText) -> str:
        """What may be given for it."""
        _, what = self.interface.resolve(type_)
        if isinstance(what, TypeText) and what.name == "list":
            _, element = self.interface.resolve(what.inner[0])
            if isinstance(element, Scalar) and element in ARRAYS:
                self.uses.add("ArrayLike")
                return "ArrayLike"
        return self._annotation(type_)

    def scalar(self, kind: Scalar) -> str:
        return _PLAIN.get(kind) or f"{self.thrift}.{kind.name}"

    def external(self, kind: External) -> str:
        self.uses.add("Annotated")
        python = "object"
        if kind.python:
            self.uses.add("yarpy")
            python = f"{self.yarpy}.{kind.python.rpartition('.')[2]}"
        arguments = [_quoted(kind.name)]
        if kind.size != 1 or kind.python:
            arguments.append(str(kind.size))
        if kind.python:
            arguments.append(_quoted(kind.python))
        return f"Annotated[{python}, {self.thrift}.External({', '.join(arguments)})]"

    def mention(self, name: str, line: int) -> str:
        """A name where it is used: in quotes, if it comes later."""
        where, found = self.interface.find(name, line)
        if where is not self.interface:
            return f"{name.partition('.')[0]}.{attribute(found.name)}"
        text = attribute(found.name)
        return text if name in self.known or self.stubs else f'"{text}"'

    # -- values -----------------------------------------------------------------------------------

    def default(self, field: FieldText) -> str:
        """The default of a field or an argument."""
        _, what = self.interface.resolve(field.type)
        if self.stubs:
            return "..."
        if field.default is None:
            if isinstance(what, Scalar):
                if what is kinds.VOCAB:
                    return '""'
                return {BOOL: "False", TEXT: '""', BINARY: 'b""'}.get(
                    what, "0.0" if what.letter in "fd" else "0"
                )
            name = self._annotation(field.type).strip('"')
            if isinstance(what, EnumText):
                if not what.values:
                    return "0"
                if name.strip('"') in self.known or "." in name:
                    return f"{name}.{attribute(what.values[0].name, ENUM)}"
                return f"{self.thrift}.new(lambda: {name}.{attribute(what.values[0].name, ENUM)})"
            if isinstance(what, StructText):
                outside = external(what)
                if outside is not None:
                    return f"{self.thrift}.new({self._empty(outside)})"
                return f"{self.thrift}.new(lambda: {name}())"
            return f"{self.thrift}.new({ {'list': 'list', 'set': 'set'}.get(what.name, 'dict') })"
        value = self.value(field.type, field.default, field.line)
        if isinstance(what, Scalar):
            return value
        if isinstance(what, EnumText) and "." in value and what.name in self.known:
            return value
        return f"{self.thrift}.new(lambda: {value})"

    def _empty(self, kind: External) -> str:
        self.uses.add("yarpy")
        return f"{self.yarpy}.{kind.python.rpartition('.')[2] if kind.python else 'Bottle'}"

    def value(self, type_: TypeText, value: Any, line: int) -> str:
        """A value of a type, as Python code."""
        _, what = self.interface.resolve(type_)
        if isinstance(value, Name):
            return self.named(type_, what, value)
        if isinstance(what, Scalar):
            return self.literal(what, value, line)
        if isinstance(what, EnumText):
            if not isinstance(value, int):
                raise self._misfit(what.name, value, line)
            member = next((each.name for each in what.values if each.number == value), None)
            name = self.mention(type_.name, line).strip('"')
            return str(value) if member is None else f"{name}.{attribute(member, ENUM)}"
        if isinstance(what, StructText):
            return self.record(type_, what, value, line)
        if what.name == "map":
            if not isinstance(value, Pairs):
                raise self._misfit("a map", value, line)
            items = (
                f"{self.value(what.inner[0], key, line)}: {self.value(what.inner[1], item, line)}"
                for key, item in value.items
            )
            return f"{{{', '.join(items)}}}"
        if not isinstance(value, list):
            if isinstance(value, Pairs) and not value.items:
                value = []
            else:
                raise self._misfit(f"a {what.name}", value, line)
        inner = ", ".join(self.value(what.inner[0], item, line) for item in value)
        return f"[{inner}]" if what.name == "list" else f"{{{inner}}}" if inner else "set()"

    def record(self, type_: TypeText, struct: StructText, value: Any, line: int) -> str:
        if not isinstance(value, Pairs):
            raise self._misfit(struct.name, value, line)
        where, _ = self.interface.resolve(type_)
        fields = {field.name: field for field in struct.fields}
        arguments = []
        for key, item in value.items:
            if not isinstance(key, str) or key not in fields:
                raise self.interface.wrong(line, f"{struct.name} has no field {key!r}")
            text = self.value(self.seen(fields[key].type, where), item, line)
            arguments.append(f"{attribute(key, STRUCT)}={text}")
        return f"{self.mention(type_.name, line).strip(chr(34))}({', '.join(arguments)})"

    def seen(self, type_: TypeText, where: Interface) -> TypeText:
        """A type of another file as it is called here."""
        if where is self.interface:
            return type_
        inner = tuple(self.seen(each, where) for each in type_.inner)
        name = type_.name
        if name not in BASE and not inner and "." not in name:
            name = next(
                (f"{p}.{name}" for p, other in self.interface.includes.items() if other is where),
                name,
            )
        return replace(type_, name=name, inner=inner)

    def named(self, type_: TypeText, what: Any, value: Name) -> str:
        line = value.line
        if value.text in ("true", "false") and isinstance(what, Scalar):
            return self.literal(what, value.text == "true", line)
        head, _, last = value.text.rpartition(".")
        if isinstance(what, EnumText):
            member = last if head else value.text
            if member not in [each.name for each in what.values]:
                names = ", ".join(each.name for each in what.values)
                raise self.interface.wrong(line, f"{what.name} is one of {names}, not {value.text}")
            name = self.mention(type_.name, line).strip('"')
            return f"{name}.{attribute(member, ENUM)}"
        try:
            where, found = self.interface.find(value.text, line, "constant")
        except DecodeError:
            if head:
                where, found = self.interface.find(head, line, "constant")
                if isinstance(found, EnumText) and isinstance(what, Scalar):
                    number = next((e.number for e in found.values if e.name == last), None)
                    if number is not None:
                        return self.literal(what, number, line)
            raise
        if not isinstance(found, ConstText):
            raise self.interface.wrong(line, f'"{value.text}" is no constant')
        prefix = "" if where is self.interface else value.text.partition(".")[0] + "."
        if not prefix and value.text not in self.known:
            raise self.interface.wrong(line, f'the constant "{value.text}" comes later')
        return prefix + attribute(found.name)

    def literal(self, kind: Scalar, value: Any, line: int) -> str:
        if kind is BOOL:
            if isinstance(value, int) and value in (0, 1):
                return repr(bool(value))
        elif kind is TEXT or kind is kinds.VOCAB:
            if isinstance(value, str):
                return _quoted(value)
            if kind is kinds.VOCAB and isinstance(value, int):
                self.uses.add("yarpy")
                return f"{self.yarpy}.Vocab.from_code({value})"
        elif kind is BINARY:
            if isinstance(value, str):
                return "b" + _double(repr(value.encode())[1:])
        elif kind.letter in "fd":
            if isinstance(value, (int, float)) and not isinstance(value, bool):
                return repr(float(value))
        elif isinstance(value, int) and not isinstance(value, bool):
            self._fit(kind, value, line, str(value))
            return repr(value)
        raise self._misfit(str(kind), value, line)

    def _fit(self, kind: Scalar, number: int, line: int, what: str) -> None:
        if kind is kinds.VOCAB:
            kind = kinds.I32
        bits = 8 * {"b": 1, "h": 2, "i": 4, "q": 8}[kind.letter.lower()]
        low, high = -(1 << (bits - 1)), 1 << (bits - 1)
        if kind.letter.isupper():
            low, high = 0, 1 << bits
        if not low <= number < high:
            raise self.interface.wrong(line, f"{what} ({number}) does not fit in {kind}")

    def _misfit(self, wanted: str, value: Any, line: int) -> DecodeError:
        shown = {Pairs: "a map", list: "a list"}.get(type(value)) or f"{value!r:.40}"
        return self.interface.wrong(line, f"expected a value for {wanted}, found {shown}")


def _nested(field: FieldText) -> bool:
    annotations = {**field.type.annotations, **field.annotations}
    return annotations.get("yarp.nested") == "true"


def _comment(doc: str, depth: int = 0) -> str:
    """A comment as Python has it, before a line."""
    blank = "    " * depth
    return "".join(f"{blank}#: {_printable(line)}".rstrip() + "\n" for line in doc.splitlines())


def _docstring(doc: str, depth: int) -> list[str]:
    if not doc:
        return []
    blank = "    " * depth
    lines = [_printable(line) for line in doc.splitlines()]
    text = "\n".join(lines).replace("\\", "\\\\").replace('"""', '\\"\\"\\"')
    if text.endswith('"'):
        text = text[:-1] + '\\"'
    first, *rest = text.split("\n")
    if not rest:
        return [f'{blank}"""{first}"""']
    return [f'{blank}"""{first}', *(f"{blank}{line}".rstrip() for line in rest), f'{blank}"""']


def _printable(line: str) -> str:
    return "".join(each if each.isprintable() or each == "\t" else "?" for each in line)


def _quoted(text: str) -> str:
    """A string literal, in double quotes where that is as simple."""
    return _double(repr(text))


def _double(literal: str) -> str:
    return f'"{literal[1:-1]}"' if literal[0] == "'" and '"' not in literal else literal
