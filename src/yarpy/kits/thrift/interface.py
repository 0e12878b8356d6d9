"""Interface: a `.thrift` file with those it includes, its names looked up and its rules checked.

Rules: what is wrong is a DecodeError that says file and line, and the nearest name. A file that
includes itself, over whatever others, is refused. What C++ YARP cannot call is refused here too:
`help_me`, names with `__` or a `_` at their end. `get` beside `get_all`, which it does not compile,
is not.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path
from typing import Any, Final, TypeAlias

from yarpy.errors import DecodeError
from yarpy.kits.thrift import kind as kinds
from yarpy.kits.thrift.document import (
    ConstText,
    Declaration,
    Document,
    EnumText,
    FieldText,
    MethodText,
    ServiceText,
    StructText,
    TypedefText,
    TypeText,
)
from yarpy.kits.thrift.kind import BINARY, BOOL, DOUBLE, TEXT, External, Scalar
from yarpy.kits.thrift.parse import parse
from yarpy.kits.thrift.word import MODULES, PYTHON, attribute
from yarpy.limit import (
    THRIFT_BASES,
    THRIFT_DECLARATIONS,
    THRIFT_DEPTH,
    THRIFT_INCLUDES,
    THRIFT_NESTED,
    THRIFT_TEXT,
    THRIFT_TYPES,
)
from yarpy.log import logger

log = logger("yarpy.idl")

BASE: Final = {
    "bool": BOOL, "byte": kinds.I8, "i8": kinds.I8, "i16": kinds.I16, "i32": kinds.I32,
    "i64": kinds.I64, "double": DOUBLE, "string": TEXT, "binary": BINARY,
}  # fmt: skip
CONTAINERS: Final = ("list", "set", "map")

#: types of C++ that yarpy has, too
NATIVE: Final = {
    "yarp::os::Bottle": "yarpy.Bottle",
    "yarp::os::Property": "yarpy.Property",
    "yarp::os::Stamp": "yarpy.Stamp",
    "yarp::sig::Vector": "yarpy.Vector",
    "yarp::sig::VectorOf<double>": "yarpy.Vector",
    "yarp::sig::VectorOf<int>": "yarpy.Vector",
    "yarp::sig::Matrix": "yarpy.Matrix",
}

_COMPARED: Final = 300  # names, in search of the nearest

Read = Callable[[Path], str]
Resolved: TypeAlias = TypeText | StructText | EnumText | Scalar


@dataclass(eq=False)
class Interface:
    """A file: what it declares by name, and the interfaces that it includes by prefix."""

    document: Document
    path: Path | None
    includes: dict[str, Interface]
    names: dict[str, Declaration] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """The name of the file without its suffix, by which others mention it."""
        return Path(self.document.file).stem

    @property
    def module_name(self) -> str:
        """The name of a Python module of it. DecodeError if there can be none."""
        if not self.name.isidentifier() or self.name in PYTHON:
            raise DecodeError(f"{self.document.file}: no module is called {self.name}: rename it")
        return attribute(self.name, MODULES)

    def all(self) -> list[Interface]:
        """Those that it includes, and it."""
        found: dict[int, Interface] = {}
        self._gather(found)
        return [*found.values()]

    def _gather(self, found: dict[int, Interface]) -> None:
        for other in self.includes.values():
            if id(other) not in found:
                other._gather(found)
        found[id(self)] = self

    def wrong(self, line: int, why: str) -> DecodeError:
        return DecodeError(f"{self.document.file}:{line}: {why}")

    def find(self, name: str, line: int, what: str = "type") -> tuple[Interface, Declaration]:
        """The declaration of a name, and the file that it is in. DecodeError."""
        where, rest = self, name
        while rest not in where.names:
            prefix, dot, rest = rest.partition(".")
            inside = where.includes.get(prefix) if dot else None
            if inside is None:
                break
            where = inside
        else:
            return where, where.names[rest]
        inner = (f"{p}.{n}" for p, other in self.includes.items() for n in other.names)
        known = [*self.names, *inner, *(BASE if what == "type" else ())]
        near = get_close_matches(name[:100], known[:_COMPARED], n=1)
        hint = f': did you mean "{near[0]}"?' if near else ""
        raise self.wrong(line, f'no {what} "{name}"{hint}')

    def resolve(self, type_: TypeText) -> tuple[Interface, Resolved]:
        """Return the type behind all typedefs, a Scalar, a struct, an enum or a container, and
        its file."""
        where: Interface = self
        for _ in range(100):
            if type_.name in CONTAINERS:
                return where, type_
            if type_.name in BASE:
                return where, where._scalar(type_)
            where, found = where.find(type_.name, type_.line)
            if isinstance(found, (StructText, EnumText)):
                return where, found
            if not isinstance(found, TypedefText):
                raise self.wrong(type_.line, f'"{type_.name}" is no type')
            type_ = found.type
        raise self.wrong(type_.line, f'"{type_.name}" is defined by itself')

    def _scalar(self, type_: TypeText) -> Scalar:
        base = BASE[type_.name]
        given = type_.annotations.get("yarp.type", "")
        if not given:
            return base
        found = _native_scalar(base, given)
        if found is None:
            raise self.wrong(type_.line, f'"{given}" is not a type that {base} can be')
        return found


_UNSIGNED: Final = {
    kinds.I8: kinds.UI8, kinds.I16: kinds.UI16, kinds.I32: kinds.UI32, kinds.I64: kinds.UI64,
}  # fmt: skip


def _native_scalar(base: Scalar, given: str) -> Scalar | None:
    short = given.rpartition("::")[2].strip()
    if base is DOUBLE:
        return {"float32_t": kinds.FLOAT, "float": kinds.FLOAT}.get(short, DOUBLE)
    if base is kinds.I32 and short == "vocab32_t":
        return kinds.VOCAB
    if base is kinds.I32 and short == "size_t":
        return kinds.SIZE
    if "unsigned" in given or short.startswith("uint"):
        return _UNSIGNED.get(base)
    return base


def external(struct: StructText) -> External | None:
    """The type that C++ has for a struct with `yarp.name`."""
    name = struct.annotations.get("yarp.name") or struct.annotations.get("cpp.name")
    if not name:
        return None
    size = struct.annotations.get("yarp.bottlesize", "1")
    count = int(size) if size.isascii() and size.isdigit() and len(size) < 5 else 1
    return External(name, max(count, 1), NATIVE.get(name.strip(), ""))


def enum_base(interface: Interface, enum: EnumText) -> Scalar:
    """Return the type of an enum on the wire."""
    given = enum.annotations.get("yarp.enumbase", "int").rpartition("::")[2].strip()
    bases = {
        **dict.fromkeys(("int8_t", "int8", "char"), kinds.I8),
        **dict.fromkeys(("uint8_t", "uint8", "unsigned char"), kinds.UI8),
        **dict.fromkeys(("int16_t", "int16", "short"), kinds.I16),
        **dict.fromkeys(("uint16_t", "uint16", "unsigned short"), kinds.UI16),
        **dict.fromkeys(("int32_t", "int32", "int"), kinds.I32),
        **dict.fromkeys(("uint32_t", "uint32"), kinds.UI32),
        **dict.fromkeys(("int64_t", "int64", "unsigned int"), kinds.I64),
        **dict.fromkeys(("uint64_t", "uint64"), kinds.UI64),
        **dict.fromkeys(("vocab32_t",), kinds.VOCAB),
    }
    if given not in bases:
        raise interface.wrong(enum.line, f'"{given}" is no type of integers for an enum')
    return bases[given]


# ---------------------------------------------------------------------------------- files


def read_interface(path: Path, folders: Iterable[Path] = (), read: Read | None = None) -> Interface:
    """The interface in a file. What it includes is looked for beside it, then in `folders`.
    DecodeError, OSError."""
    files = _Files([*folders], read or _read)
    return files.interface(path.resolve(), str(path), [])


def text_interface(text: str, name: str = "text") -> Interface:
    """The interface of a text, which includes nothing."""
    document = parse(text, name)
    for include, line in document.includes:
        raise DecodeError(f"{name}:{line}: a text cannot include {include!r}: load a file")
    return _checked(Interface(document, None, {}))


def _read(path: Path) -> str:
    with path.open("rb") as file:
        data = file.read(4 * THRIFT_TEXT + 1)  # as many bytes has a text at most
    if len(data) > 4 * THRIFT_TEXT:
        raise DecodeError(f"{path} has more than {THRIFT_TEXT} characters")
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise DecodeError(f"{path}:{line}: the file is not UTF-8 text") from None


class _Files:
    def __init__(self, folders: list[Path], read: Read) -> None:
        self.folders = folders
        self.read = read
        self.known: dict[Path, Interface] = {}
        self.declarations = 0

    def interface(self, path: Path, shown: str, chain: list[Path]) -> Interface:
        found = self.known.get(path)
        if found is not None:
            return found
        document = parse(self.read(path), shown)
        self.declarations += len(document.declarations)
        if self.declarations > THRIFT_DECLARATIONS or len(self.known) > THRIFT_INCLUDES:
            raise DecodeError(f"{shown}: more than {THRIFT_DECLARATIONS} declarations in all")
        includes: dict[str, Interface] = {}
        for include, line in document.includes:
            inner = self._path(include, path)
            if inner is None:
                looked = ", ".join(map(str, [path.parent, *self.folders]))
                raise DecodeError(f'{shown}:{line}: no file "{include}" in {looked}')
            if inner in (*chain, path):
                names = " -> ".join(each.name for each in (*chain, path, inner))
                raise DecodeError(f"{shown}:{line}: files include each other: {names}")
            if inner.stem in includes:
                raise DecodeError(f'{shown}:{line}: two files are called "{inner.stem}"')
            beside = str(Path(shown).parent / include)
            includes[inner.stem] = self.interface(inner, beside, [*chain, path])
        found = self.known[path] = _checked(Interface(document, path, includes))
        return found

    def _path(self, include: str, path: Path) -> Path | None:
        for folder in (path.parent, *self.folders):
            candidate = folder / include
            if candidate.is_file():
                return candidate.resolve()
        return None


# ---------------------------------------------------------------------------------- rules


def _checked(interface: Interface) -> Interface:
    own: dict[int, set[str]] = {}
    known: dict[str, str] = {}
    for each in interface.document.declarations:
        _check_name(interface, each.name, each.line, known)
        if each.name in interface.names:
            before = interface.names[each.name].line
            raise interface.wrong(each.line, f'"{each.name}" is there already, in line {before}')
        if each.name in interface.includes:
            raise interface.wrong(each.line, f'"{each.name}" is the name of an included file')
        interface.names[each.name] = each
    for each in interface.document.declarations:
        if isinstance(each, (TypedefText, ConstText)):
            _check_type(interface, each.type)
        elif isinstance(each, EnumText):
            enum_base(interface, each)
            _check_unique(interface, each.values, f"in {each.name}")
        elif isinstance(each, StructText):
            _check_fields(interface, each.fields, f"in {each.name}")
        else:
            _check_service(interface, each, own)
    for each in interface.document.declarations:
        if isinstance(each, StructText):
            _check_size(interface, each, {}, [])
    return interface


def _check_name(interface: Interface, name: str, line: int, known: dict[str, str]) -> None:
    """Note the name that Python has for a name, unless it has none, or another one has it."""
    if not name.strip("_"):
        raise interface.wrong(line, f'"{name}" has no letter: choose a name that Python may show')
    shown = attribute(name)
    other = known.setdefault(shown, name)
    if other != name:
        raise interface.wrong(
            line, f'"{name}" and "{other}" are both {shown} in Python: rename one of them'
        )


def _check_unique(interface: Interface, items: Iterable[Any], where: str) -> None:
    seen: set[str] = set()
    known: dict[str, str] = {}
    for item in items:
        _check_name(interface, item.name, item.line, known)
        if item.name in seen:
            raise interface.wrong(item.line, f'"{item.name}" is there twice {where}')
        seen.add(item.name)


def _check_fields(interface: Interface, fields: tuple[FieldText, ...], where: str) -> None:
    _check_unique(interface, fields, where)
    numbers: dict[int, str] = {}
    for each in fields:
        if each.number is not None:
            if each.number in numbers:
                raise interface.wrong(
                    each.line,
                    f'"{each.name}" and "{numbers[each.number]}" {where} have the same number, '
                    f"{each.number}",
                )
            numbers[each.number] = each.name
        _check_type(interface, each.type)
        _check_place(interface, each)


def _check_place(interface: Interface, field: FieldText) -> None:
    """Say which annotation does nothing where it stands: it belongs to the type."""
    given = field.annotations.get("yarp.type")
    if given:
        log.warning(
            '%s:%d: yarp.type behind the name "%s" does nothing, as in C++: write it behind the '
            'type, %s (yarp.type = "%s") %s',
            *(interface.document.file, field.line, field.name),
            *(field.type.name, given, field.name),
        )


def _check_type(interface: Interface, type_: TypeText, depth: int = 0) -> int:
    """Return how many types there are in a type, with those behind its typedefs."""
    where, found = interface.resolve(type_)
    if depth > THRIFT_DEPTH:
        raise interface.wrong(type_.line, f"types are nested more than {THRIFT_DEPTH} deep")
    if not isinstance(found, TypeText):
        return 1
    size = 1
    for inner in found.inner:
        size += _check_type(where, inner, depth + 1)
        if size > THRIFT_TYPES:
            raise interface.wrong(type_.line, f"a type of more than {THRIFT_TYPES} others")
    return size


def _check_service(interface: Interface, service: ServiceText, own: dict[int, set[str]]) -> None:
    bases = _bases(interface, service, own)
    _check_unique(interface, service.methods, f"in {service.name}")
    names = [*bases, _own(service, own)]
    for method in service.methods:
        _check_method(interface, service, method, names, bases)


def _own(service: ServiceText, known: dict[int, set[str]]) -> set[str]:
    """The names of a service's own methods, which are asked for by each that extends it."""
    if id(service) not in known:
        known[id(service)] = {method.name for method in service.methods}
    return known[id(service)]


def _bases(interface: Interface, service: ServiceText, own: dict[int, set[str]]) -> list[set[str]]:
    """The names of the methods of each service that this one extends."""
    found: list[set[str]] = []
    seen = {id(service)}
    where, each = interface, service
    while each.extends:
        where, base = where.find(each.extends, each.line, "service")
        if not isinstance(base, ServiceText):
            raise interface.wrong(service.line, f'"{each.extends}" is no service')
        if id(base) in seen:
            raise interface.wrong(service.line, f'"{service.name}" extends itself')
        if len(seen) > THRIFT_BASES:
            raise interface.wrong(
                service.line, f'"{service.name}" extends more than {THRIFT_BASES} others'
            )
        seen.add(id(base))
        found.append(_own(base, own))
        each = base
    return found


def _check_method(
    interface: Interface,
    service: ServiceText,
    method: MethodText,
    names: list[set[str]],
    inherited: list[set[str]],
) -> None:
    name = method.name
    why = ""
    if any(name in each for each in inherited):
        why = f"a service that {service.name} extends has it, too"
    elif name == "help" or name.startswith("help_"):
        why = "the word help is taken"
    elif "__" in name or name.endswith("_"):
        why = "C++ YARP cannot call names with __ in them or with _ at their end"
    elif "." in name:
        why = "it has a dot in it"
    if why:
        raise interface.wrong(method.line, f'no method can be called "{name}": {why}')
    words = name.split("_")
    for at in range(1, len(words)):
        shorter = "_".join(words[:at])
        if any(shorter in each for each in names):
            log.warning(
                '%s:%d: the compiler of C++ YARP refuses "%s" beside "%s", which it would call',
                *(interface.document.file, method.line, name, shorter),
            )
    _check_fields(interface, method.throws, f"that {name} throws")
    if method.oneway and method.result is not None:
        raise interface.wrong(method.line, f'"{name}" is oneway, so its result must be void')
    _check_fields(interface, method.arguments, f"in {name}")
    if method.result is not None:
        _check_type(interface, method.result)


def _check_size(
    interface: Interface, struct: StructText, known: dict[int, int], chain: list[int]
) -> int:
    """Return how many values a struct begins with, those of structs within too. Raises where it is
    endless."""
    from yarpy.limit import THRIFT_VALUES

    key = id(struct)
    if key in known:
        return known[key]
    if key in chain:
        raise interface.wrong(
            struct.line, f'"{struct.name}" contains itself: make it optional, or put it into a list'
        )
    if len(chain) > THRIFT_NESTED:
        raise interface.wrong(struct.line, f"structs are nested more than {THRIFT_NESTED} deep")
    size = 0
    for each in struct.fields:
        where, found = interface.resolve(each.type)
        if struct.may_lack(each):
            size += 1
        elif isinstance(found, StructText) and external(found) is None:
            size += max(_check_size(where, found, known, [*chain, key]), 1)
        else:
            size += 1
    if size > THRIFT_VALUES:
        raise interface.wrong(struct.line, f'"{struct.name}" has more than {THRIFT_VALUES} values')
    known[key] = size
    return size
