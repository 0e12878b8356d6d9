"""The TypeScript module of an interface, as text: what `yarpy idl thrift --gen ts` writes.

    export class Region {                       export class Camera extends yarpy.Client {
      x: number = 0;                              find(what: string): Promise<Region[]> { ... }

Rules: a module imports `yarpy.ts`, which is written beside it, and those of included files; what
comes from the file is written as a literal or as a name that the parser let through. Values fit
their types: the Python of the same file has been written before. Only what Apache's protocols know
can be called so, and so a struct with `yarp.name` is an error.
"""

from __future__ import annotations

import json
from importlib.resources import files
from typing import Any, Final

from yarpy.kits.thrift import kind as kinds
from yarpy.kits.thrift.file.document import (
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
    numbered,
)
from yarpy.kits.thrift.file.interface import BASE, Interface, external
from yarpy.kits.thrift.kind import BINARY, BOOL, TEXT, VOCAB, Scalar

#: the module that all others import, and what is imported as in all of them
RUNTIME: Final = "yarpy"

_BIG: Final = (kinds.I64, kinds.UI64)
_WORDS: Final = {
    BOOL: "boolean", TEXT: "string", BINARY: "Uint8Array", kinds.I64: "bigint", kinds.UI64: "bigint"
}  # fmt: skip
_NAMES: Final = {
    kinds.I8: "i8", kinds.UI8: "ui8", kinds.I16: "i16", kinds.UI16: "ui16", kinds.I32: "i32",
    kinds.UI32: "ui32", kinds.SIZE: "ui32", VOCAB: "i32", kinds.I64: "i64", kinds.UI64: "ui64",
    kinds.FLOAT: "double", kinds.DOUBLE: "double", BOOL: "bool", TEXT: "string", BINARY: "binary",
}  # fmt: skip
# Words that no variable and no class can be called.
_RESERVED: Final = frozenset((
    *("arguments", "await", "break", "case", "catch", "class", "const"),
    *("continue", "debugger", "default", "delete", "do", "else", "enum"),
    *("eval", "export", "extends", "false", "finally", "for", "function"),
    *("if", "implements", "import", "in", "instanceof", "interface", "let"),
    *("new", "null", "package", "private", "protected", "public", "return"),
    *("static", "super", "switch", "this", "throw", "true", "try"),
    *("typeof", "undefined", "var", "void", "while", "with", "yield"),
    *("any", "bigint", "boolean", "never", "number", "object", "string"),
    *("symbol", "unknown"),
))  # fmt: skip
# What the modules themselves mention.
_TAKEN: Final = _RESERVED | {
    *("Error", "Map", "Object", "Partial", "Promise", "Set", "Uint8Array", RUNTIME)
}
# Fields with which an exception is no Error of JavaScript.
_OF_ERRORS: Final = frozenset(("name", "stack", "cause"))


def typescript(interface: Interface) -> str:
    """Return the text of the module. DecodeError for what has no spelling there."""
    return _Module(interface).text()


def runtime() -> str:
    """Return the text of the module that all others import."""
    return files("yarpy.kits.thrift").joinpath("assets", "yarpy.ts").read_text("utf-8")


def _named(name: str, taken: frozenset[str] = _TAKEN) -> str:
    return f"{name}_" if name.rstrip("_") in taken else name


def _literal(value: object) -> str:
    return json.dumps(value)


class _Module:
    def __init__(self, interface: Interface) -> None:
        self.interface = interface

    def text(self) -> str:
        inner = self.interface
        head = [f"// The interface {inner.name}, written by `yarpy idl thrift --gen ts`.", ""]
        head.append(f'import * as {RUNTIME} from "./{RUNTIME}.js";')
        for prefix, other in inner.includes.items():
            head.append(f'import * as {_named(prefix)} from "./{other.module_name}.js";')
        declared = inner.document.declarations
        # Constants come last: they may be structs.
        ordered = sorted(declared, key=lambda each: isinstance(each, ConstText))
        blocks = ["\n".join(self._declaration(each)) for each in ordered]
        return "\n\n".join(["\n".join(head), *blocks]) + "\n"

    def _declaration(self, each: Any) -> list[str]:
        name = _named(each.name)
        if isinstance(each, TypedefText):
            said = [f"export type {name} = {self.type_of(each.type)};"]
        elif isinstance(each, ConstText):
            value = self.value(each.type, each.value)
            said = [f"export const {name}: {self.type_of(each.type)} = {value};"]
        elif isinstance(each, EnumText):
            said = [f"export const {name} = {{"]
            for one in each.values:
                said += [*_comment(one.doc, 1), f"  {one.name}: {one.number},"]
            said += ["} as const;", f"export type {name} = (typeof {name})[keyof typeof {name}];"]
            if not each.values:
                said[-1] = f"export type {name} = number;"
        elif isinstance(each, StructText):
            said = self._struct(each, name)
        else:
            said = self._service(each, name)
        return [*_comment(each.doc), *said]

    # -- structs and services ---------------------------------------------------------------------

    def _struct(self, each: StructText, name: str) -> list[str]:
        if external(each) is not None:
            raise self.interface.wrong(
                each.line,
                f"{each.name} is a type of YARP that TypeScript does not have: use a struct "
                "without yarp.name",
            )
        error = each.sort == "exception" and not any(self._hides(field) for field in each.fields)
        said = [f"export class {name}{' extends Error' if error else ''} {{"]
        for field in each.fields:
            if field.name in ("constructor", "__proto__"):
                raise self.interface.wrong(field.line, f'no field is called "{field.name}" there')
            kind = self.type_of(field.type)
            said += _comment(field.doc, 1)
            override = "override " if error and field.name == "message" else ""
            if each.may_lack(field):
                said.append(f"  {override}{field.name}?: {kind};")
            else:
                value = self._default(field)
                said.append(f"  {override}{field.name}: {kind} = {value};")
        said.append(f"  static readonly fields: readonly {RUNTIME}.Field[] = [")
        for field, number in zip(each.fields, numbered(each.fields), strict=True):
            needed = ", true" if field.need == "required" else ""
            kind = self.kind(field.type)
            said.append(f"    [{_literal(field.name)}, {number}, {kind}{needed}],")
        said += ["  ];", f"  constructor(values: Partial<{name}> = {{}}) {{"]
        if error:
            said.append("    super();")
        return [*said, "    Object.assign(this, values);", "  }", "}"]

    def _hides(self, field: FieldText) -> bool:
        """Return whether a field stands in the way of one that errors of JavaScript have."""
        word = self.type_of(field.type) != "string" or field.need == "optional"
        return field.name in _OF_ERRORS or (field.name == "message" and word)

    def _service(self, each: ServiceText, name: str) -> list[str]:
        base = self.mention(each.extends, each.line) if each.extends else f"{RUNTIME}.Client"
        said = [f"export class {name} extends {base} {{"]
        for method in each.methods:
            said += self._method(method)
        return [*said, "}"]

    def _method(self, method: MethodText) -> list[str]:
        if method.name == "constructor":
            raise self.interface.wrong(method.line, 'no method is called "constructor" there')
        result = "void" if method.result is None else self.type_of(method.result)
        given, passed = [], []
        for argument in method.arguments:
            name = _named(argument.name, _RESERVED)
            default = f" = {self._default(argument)}" if argument.default is not None else ""
            given.append(f"{name}: {self.type_of(argument.type)}{default}")
            passed.append(name if name == argument.name else f"{argument.name}: {name}")
        answer = "null" if method.oneway else self._answer(method)
        fields = self._fields(method.arguments)
        values = f"{{{', '.join(passed)}}}"
        return [
            *_comment(method.doc, 1),
            f"  {method.name}({', '.join(given)}): Promise<{result}> {{",
            f"    return this.$call({_literal(method.name)}, {fields}, {values}, {answer});",
            "  }",
        ]

    def _answer(self, method: MethodText) -> str:
        found = [] if method.result is None else [f'["", 0, {self.kind(method.result)}]']
        for field, number in zip(method.throws, numbered(method.throws), strict=True):
            found.append(f"[{_literal(field.name)}, {number}, {self.kind(field.type)}]")
        return f"[{', '.join(found)}]"

    def _fields(self, arguments: tuple[FieldText, ...]) -> str:
        rows = (
            f"[{_literal(field.name)}, {number}, {self.kind(field.type)}]"
            for field, number in zip(arguments, numbered(arguments), strict=True)
        )
        return f"[{', '.join(rows)}]"

    # -- types ------------------------------------------------------------------------------------

    def type_of(self, type_: TypeText) -> str:
        """Return a type as people write it."""
        if type_.name in ("list", "set", "map"):
            inner = [self.type_of(each) for each in type_.inner]
            if type_.name == "list":
                return f"{inner[0]}[]"
            return f"{type_.name.title()}<{', '.join(inner)}>"
        _, what = self.interface.resolve(type_)
        if isinstance(what, Scalar) and type_.name in BASE:
            return _WORDS.get(what, "number")
        return self.mention(type_.name, type_.line)

    def kind(self, type_: TypeText) -> str:
        """Return a type as `yarpy.ts` is told of it."""
        where, what = self.interface.resolve(type_)
        if isinstance(what, Scalar):
            return _literal(_NAMES[what])
        if isinstance(what, EnumText):
            return _literal("i32")
        if isinstance(what, StructText):
            return f"() => {self._reach(where, what.name, type_)}"
        there = self if where is self.interface else _IncludedModule(self.interface, where)
        inner = ", ".join(there.kind(each) for each in what.inner)
        return f"{{{what.name}: {f'[{inner}]' if what.name == 'map' else inner}}}"

    def _reach(self, where: Interface, name: str, type_: TypeText) -> str:
        """Return a struct as it is mentioned in this module."""
        if where is self.interface:
            return _named(name)
        for prefix, other in self.interface.includes.items():
            if other is where:
                return f"{_named(prefix)}.{_named(name)}"
        raise self.interface.wrong(
            type_.line, f"{name} is of a file that this one does not include: include it"
        )

    def mention(self, name: str, line: int) -> str:
        """Return a type or a constant as it is mentioned here."""
        where, found = self.interface.find(name, line)
        prefix = "" if where is self.interface else f"{_named(name.rpartition('.')[0])}."
        return prefix + _named(found.name)

    # -- values -----------------------------------------------------------------------------------

    def _default(self, field: FieldText) -> str:
        if field.default is not None:
            return self.value(field.type, field.default)
        where, what = self.interface.resolve(field.type)
        if isinstance(what, Scalar):
            empty = {BOOL: "false", TEXT: '""', BINARY: "new Uint8Array()"}
            return "0n" if what in _BIG else empty.get(what, "0")
        if isinstance(what, EnumText):
            first = what.values[0].name if what.values else ""
            return f"{self._reach(where, what.name, field.type)}.{first}" if first else "0"
        if isinstance(what, StructText):
            return f"new {self._reach(where, what.name, field.type)}()"
        return {"list": "[]", "set": "new Set()"}.get(what.name, "new Map()")

    def value(self, type_: TypeText, value: Any) -> str:
        """Return a value of a type."""
        where, what = self.interface.resolve(type_)
        if isinstance(value, Name):
            return self._constant(where, what, type_, value)
        if isinstance(what, Scalar):
            return self._scalar(what, value)
        if isinstance(what, EnumText):
            return f"{value} as {self._reach(where, what.name, type_)}"
        if isinstance(what, StructText):
            fields = {field.name: field for field in what.fields}
            said = (f"{key}: {self.value(fields[key].type, item)}" for key, item in value.items)
            return f"new {self._reach(where, what.name, type_)}({{{', '.join(said)}}})"
        if what.name == "map":
            pairs = (
                f"[{self.value(what.inner[0], key)}, {self.value(what.inner[1], item)}]"
                for key, item in value.items
            )
            return f"new Map([{', '.join(pairs)}])" if value.items else "new Map()"
        items = [] if isinstance(value, Pairs) else value
        listed = f"[{', '.join(self.value(what.inner[0], item) for item in items)}]"
        return listed if what.name == "list" else f"new Set({listed if items else ''})"

    def _scalar(self, kind: Scalar, value: Any) -> str:
        if kind is BOOL:
            return _literal(bool(value))
        if kind is BINARY:
            return f"new Uint8Array({_literal([*value.encode()])})"
        if kind is VOCAB and isinstance(value, str):
            return str(int.from_bytes(value.encode("latin-1")[:4], "little"))
        return f"{value}n" if kind in _BIG else _literal(value)

    def _constant(self, where: Interface, what: Any, type_: TypeText, value: Name) -> str:
        if value.text in ("true", "false") and isinstance(what, Scalar):
            return value.text if what is BOOL else str(int(value.text == "true"))
        head, _, last = value.text.rpartition(".")
        if isinstance(what, EnumText):
            return f"{self._reach(where, what.name, type_)}.{last}"
        enums = self._enums(head)
        if last in enums:
            return self._scalar(what, enums[last])
        return self.mention(value.text, value.line)

    def _enums(self, name: str) -> dict[str, int]:
        """Return the numbers of an enum; nothing if the name is that of none."""
        here, _, rest = name.rpartition(".")
        where = self.interface.includes.get(here) if here else self.interface
        found = where.names.get(rest) if where is not None else None
        return {one.name: one.number for one in getattr(found, "values", ())}


class _IncludedModule(_Module):
    """Types as an included file spells them, mentioned in a module that includes it."""

    def __init__(self, here: Interface, there: Interface) -> None:
        super().__init__(there)
        self._here = _Module(here)

    def _reach(self, where: Interface, name: str, type_: TypeText) -> str:
        return self._here._reach(where, name, type_)


def _comment(doc: str, depth: int = 0) -> list[str]:
    """Return documentation as a comment."""
    if not doc:
        return []
    indent = "  " * depth
    lines = doc.replace("*/", "* /").splitlines()
    if len(lines) == 1:
        return [f"{indent}/** {lines[0]} */"]
    return [f"{indent}/**", *(f"{indent} * {line}".rstrip() for line in lines), f"{indent} */"]
