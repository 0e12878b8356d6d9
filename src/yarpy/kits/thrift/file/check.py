"""The rules of a `.thrift` file: what is refused in it, and what a person is warned of.

Rules: what is wrong is a DecodeError that says file and line. What C++ YARP cannot call is refused
here too: `help_me`, names with `__` or a `_` at their end. `get` beside `get_all`, which it does
not compile, is told in the log.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from yarpy.kits.thrift.file.document import (
    ConstText,
    EnumText,
    FieldText,
    MethodText,
    ServiceText,
    StructText,
    TypedefText,
    TypeText,
)
from yarpy.kits.thrift.file.interface import Interface, enum_base, external
from yarpy.kits.thrift.word import attribute
from yarpy.limit import (
    THRIFT_BASES,
    THRIFT_DEPTH,
    THRIFT_NESTED,
    THRIFT_TYPES,
    THRIFT_VALUES,
)
from yarpy.log import logger

log = logger("yarpy.idl")


def checked(interface: Interface) -> Interface:
    """Return an interface, with its names noted, once no rule is broken. DecodeError."""
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
