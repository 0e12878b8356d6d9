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

import re
from typing import Final

from yarpy.kits.thrift import kind as kinds
from yarpy.kits.thrift.file.document import (
    ConstText,
    EnumText,
    FieldText,
    MethodText,
    ServiceText,
    StructText,
    TypedefText,
    numbered,
)
from yarpy.kits.thrift.file.interface import Interface, enum_base, external
from yarpy.kits.thrift.generate.code import Code, quoted, taken
from yarpy.kits.thrift.word import ENUM, MODULES, SERVICE, TYPES, attribute

#: constants of this name say which version of an interface it is
VERSION: Final = "protocol_version"
#: what would end a docstring, or run into its end
_QUOTES: Final = re.compile(r'"{3,}+|"++\Z')


def python(interface: Interface) -> str:
    """The text of the module. DecodeError for values that do not fit their types."""
    return _Module(interface, stubs=False).text()


def stubs(interface: Interface) -> str:
    """The text of its `.pyi` file."""
    return _Module(interface, stubs=True).text()


def import_line(name: str) -> str:
    """The line for a file that is included."""
    module = attribute(name, MODULES)
    return f"import {module}" + (f" as {name}" if module != name else "")


def summary(interface: Interface) -> str:
    """Return a summary of a file: "1 enum, 3 structs, 20 methods in Arm"."""
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


class _Module(Code):
    """The declarations of a file."""

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
                self.members = {attribute(field.name, taken(each)) for field in each.fields}
                blocks.append(self.struct(each))
            else:
                self.members = {attribute(method.name, SERVICE) for method in each.methods}
                blocks.append(self.service(each))
                services.append(attribute(each.name, TYPES))
            self.members = set()
            self.known.add(each.name)
        if len(services) == 1 and "connect" not in self.interface.names:
            blocks.append(
                f"connect = {services[0]}.connect\nconnect_async = {services[0]}.connect_async"
            )
        blocks += [f"_{name} = {name}" for name in sorted(self.hidden)]
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
            "from yarpy.kits import thrift"
            + (f" as {self.thrift}" if self.thrift != "thrift" else "")
        )
        groups = [head, "\n".join(imports), "\n".join(third)]
        groups.append("\n".join(import_line(name) for name in self.interface.includes))
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
        return f"{_comment(each.doc)}{attribute(each.name, TYPES)} = {self.annotation(each.type)}"

    def const(self, each: ConstText) -> str:
        self.uses.add("Final")
        value = self.value(each.type, each.value, each.line)
        name = attribute(each.name, TYPES)
        if self.stubs:
            return f"{name}: Final[{self.annotation(each.type)}]"
        return f"{_comment(each.doc)}{name}: Final = {value}"

    def enum(self, each: EnumText) -> str:
        base = enum_base(self.interface, each)
        given = "" if base is kinds.I32 else f", base={self.scalar(base)}"
        lines = [f"class {attribute(each.name, TYPES)}({self.thrift}.Enum{given}):"]
        lines += _docstring(each.doc, 1)
        if each.doc and each.values:
            lines.append("")
        for value in each.values:
            self.fit(base, value.number, value.line, f"{each.name}.{value.name}")
            lines += _comment(value.doc, 1).splitlines()
            lines.append(f"    {attribute(value.name, ENUM)} = {value.number}")
        if not each.values and not each.doc:
            lines.append("    pass")
        return "\n".join(lines)

    def struct(self, each: StructText) -> str:
        name = attribute(each.name, TYPES)
        outside = external(each)
        if outside is not None:
            return f"{_comment(each.doc)}{name} = {self.external(outside)}"
        base = {"union": "Union", "exception": "Error"}.get(each.sort, "Struct")
        names = {field.name: attribute(field.name, taken(each)) for field in each.fields}
        doc = _noted(each.doc, names)
        lines = [f"class {name}({self.thrift}.{base}):", *_docstring(doc, 1)]
        facts = [] if self.stubs else _facts(each, names)
        if doc and (each.fields or facts):
            lines.append("")
        lines += facts
        if facts and each.fields:
            lines.append("")
        for field in each.fields:
            kind = self.annotation(field.type, nested=_nested(field))
            lacks = each.may_lack(field)
            if lacks:
                kind = self.optional(kind)
            lines += _comment(field.doc, 1).splitlines()
            default = self.default(field, lacks)
            lines.append(f"    {names[field.name]}: {kind} = {default}")
        if self.stubs and each.fields:
            lines.append("    def __init__(")
            lines.append("        self,")
            for field in each.fields:
                kind = self.accepted(field.type)
                if each.may_lack(field):
                    kind = self.optional(kind)
                lines.append(f"        {names[field.name]}: {kind} = ...,")
            lines.append("    ) -> None: ...")
        if not each.fields and not doc:
            lines.append("    pass")
        return "\n".join(lines)

    def service(self, each: ServiceText) -> str:
        base = f"{self.thrift}.Service"
        if each.extends:
            base = self.mention(each.extends, each.line)
        lines = [f"class {attribute(each.name, TYPES)}({base}):", *_docstring(each.doc, 1)]
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
        name = attribute(each.name, TYPES)
        word, number = self.uncovered("str"), self.uncovered("float")
        version = self.uncovered("tuple[int, int, int, int]") + " | None"
        lines = []
        for kind, how in (("Client", "connect"), ("AsyncClient", "connect_async")):
            lines += [
                "    @classmethod",
                f"    def {how}(",
                f"        cls, target: {word}, *, timeout: {number} | None = ..., "
                f"carrier: {word} = ..., **options: Any",
                f"    ) -> _{name}{kind}: ...",
            ]
        before = base.rpartition(".")
        sync = f"{name}"
        apart = "object"
        if each.extends:
            sync = f"{before[0]}{before[1]}_{before[2]}Client, {name}"
            apart = f"{before[0]}{before[1]}_{before[2]}AsyncClient"
        lines += ["", f"class _{name}Client({sync}):"]
        lines.append(f"    def remote_version(self) -> {version}: ...")
        for method in each.methods:
            lines += self.method(method, "def")[1:]
        lines += ["", f"class _{name}AsyncClient({apart}):"]
        lines += [
            f"    timeout: {number} | None",
            f"    async def remote_version(self) -> {version}: ...",
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
        # Only the last arguments can have defaults.
        without = [at for at, each in enumerate(method.arguments) if each.default is None]
        last = max(without, default=-1)
        for at, argument in enumerate(method.arguments):
            name = attribute(argument.name)
            kind = self.annotation(argument.type, nested=_nested(argument))
            if how:
                kind = self.accepted(argument.type)
            text = f"{name}: {kind}"
            if at > last:
                text += " = ..." if self.stubs else f" = {self.default(argument)}"
            arguments.append(text)
        result = "None" if method.result is None else self.annotation(method.result)
        name = attribute(method.name, SERVICE)
        how = how or "def"
        head = f"    {how} {name}({', '.join(arguments)}) -> {result}:"
        if len(head) > 100:
            inner = "".join(f"        {argument},\n" for argument in arguments)
            head = f"    {how} {name}(\n{inner}    ) -> {result}:"
        given = "" if self.stubs else self._given(method, name)
        lines = [f"    @{self.thrift}.{mark}{given}", head]
        lines += _docstring(_noted(method.doc, {method.name: name}), 2)
        lines.append("        ..." if self.stubs else "        raise NotImplementedError")
        return lines

    def _given(self, method: MethodText, name: str) -> str:
        """Return the arguments of the decorator of a method; "" for none."""
        given = []
        if method.name.startswith("_"):
            given.append(f"name={quoted(method.name)}")
        numbers = numbered(method.arguments)
        if numbers != (*range(1, len(numbers) + 1),):
            given.append(f"numbers={numbers}")
        thrown = []
        for number, each in zip(numbered(method.throws), method.throws, strict=True):
            _, what = self.interface.resolve(each.type)
            if isinstance(what, StructText) and external(what) is None:
                thrown.append(f"{number}: {self.annotation(each.type)}")
        if thrown:
            given.append(f"throws={{{', '.join(thrown)}}}")
        return f"({', '.join(given)})" if given else ""


def _facts(each: StructText, names: dict[str, str]) -> list[str]:
    """Return the lines of a class that say of its fields more than their types."""
    lines = []
    numbers = numbered(each.fields)
    if numbers != (*range(1, len(numbers) + 1),):
        lines.append(f"    _numbers = {numbers}")
    required = tuple(names[field.name] for field in each.fields if field.need == "required")
    if required:
        lines.append(f"    _required = {_row(required)}")
    moved = {python: thrift for thrift, python in names.items() if thrift.startswith("_")}
    if moved:
        inner = ", ".join(f"{quoted(key)}: {quoted(name)}" for key, name in moved.items())
        lines.append(f"    _names = {{{inner}}}")
    return lines


def _row(words: tuple[str, ...]) -> str:
    return f"({', '.join(map(quoted, words))}{',' if len(words) == 1 else ''})"


def _noted(doc: str, names: dict[str, str]) -> str:
    """A comment with what names are in Thrift that Python has others for."""
    moved = [f"{python} is {name}" for name, python in names.items() if name.startswith("_")]
    if not moved:
        return doc
    note = f"In Thrift {', '.join(moved)}."
    return f"{doc}\n\n{note}" if doc else note


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
    text = "\n".join(lines).replace("\\", "\\\\")
    text = _QUOTES.sub(lambda found: found[0].replace('"', '\\"'), text)
    first, *rest = text.split("\n")
    if not rest:
        return [f'{blank}"""{first}"""']
    return [f'{blank}"""{first}', *(f"{blank}{line}".rstrip() for line in rest), f'{blank}"""']


def _printable(line: str) -> str:
    return "".join(each if each.isprintable() or each == "\t" else "?" for each in line)
