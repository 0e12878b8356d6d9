"""RIHS01: the hash by which ROS 2 tells types apart, of the description of a type as JSON.

Rules: names of fields, their order and their types count; defaults, constants and comments do not.
The text is what Python's json makes with its defaults. A service has the hash of a message with
request, response and event in it. (REP 2016; the generator of rosidl, with its slips.)
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from hashlib import sha256
from typing import Any, Final

from yarpy.errors import DecodeError
from yarpy.peers.ros.message.definition import Definition, ServiceDefinition
from yarpy.peers.ros.message.parse import FieldText
from yarpy.peers.ros2.message.action import SERVICES
from yarpy.peers.ros2.message.parse import BUILTIN

PREFIX: Final = "RIHS01_"
_HASH = re.compile(r"RIHS01_[0-9a-f]{64}")

NESTED: Final = 1
_ARRAY, _BOUNDED, _ANY = 48, 96, 144  # added to the number of the elements
_LIMITED: Final = 4  # ... to that of a string
#: what a message without fields has all the same
FILLER: Final = "structure_needs_at_least_one_member"

Description = dict[str, Any]


def is_hash(text: str) -> bool:
    """Return whether a text has the form of a type hash."""
    return bool(_HASH.fullmatch(text))


def message_hash(definition: Definition) -> str:
    """The hash of a message type."""
    return hash_of(*described_message(definition))


def service_hash(definition: ServiceDefinition) -> str:
    """The hash of a service type."""
    return hash_of(*described_service(definition))


def described_message(definition: Definition) -> tuple[Description, list[Description]]:
    """The description of a message type, and those of all types in it."""
    others = [described(full_name(item.name), item.parsed.fields) for item in definition.all_used()]
    return described(full_name(definition.name), definition.parsed.fields), others


def described_service(definition: ServiceDefinition) -> tuple[Description, list[Description]]:
    """The description of a service type, and those of all types in it."""
    name = full_name(definition.name, "srv")
    halves = definition.request, definition.response
    used = {item.name: item for half in halves for item in half.all_used()}
    event = f"{name}_Event"
    parts = [_field(f"{half}_message", NESTED, f"{name}_{half.title()}") for half in _HALVES]
    info = "service_msgs/msg/ServiceEventInfo"
    others = [
        {
            "type_name": event,
            "fields": [
                _field("info", NESTED, info),
                *(_field(half, NESTED + _BOUNDED, f"{name}_{half.title()}", 1) for half in _HALVES),
            ],
        },
        {
            "type_name": info,
            "fields": [
                _field("event_type", 3),
                _field("stamp", NESTED, _TIME["type_name"]),
                _field("client_gid", 3 + _ARRAY, "", 16),
                _field("sequence_number", 8),
            ],
        },
        *(
            described(f"{name}_{half.title()}", each.parsed.fields)
            for half, each in zip(_HALVES, halves, strict=True)
        ),
        *(described(full_name(item.name), item.parsed.fields) for item in used.values()),
    ]
    if "builtin_interfaces/Time" not in used:
        others.append(_TIME)
    whole = {"type_name": name, "fields": [*parts, _field("event_message", NESTED, event)]}
    return whole, others


def hash_of(description: Description, others: Iterable[Description]) -> str:
    """The hash of a description and those of all types in it."""
    text = json.dumps(
        {
            "type_description": description,
            "referenced_type_descriptions": sorted(others, key=lambda item: item["type_name"]),
        }
    )
    return PREFIX + sha256(text.encode()).hexdigest()


def full_name(name: str, kind: str = "msg") -> str:
    """package/kind/Type of package/Type; the type of an action says its kind itself."""
    package, _, plain = name.rpartition("/")
    if "/" in package:
        return name
    return f"{package}/{kind}/{plain}"


def described(name: str, fields: Iterable[FieldText]) -> Description:
    """The description of a type with a name in full."""
    rows = [_described(item) for item in fields]
    return {"type_name": name, "fields": rows or [_field(FILLER, 3)]}


_HALVES: Final = ("request", "response")


def _field(
    name: str, number: int, nested: str = "", capacity: int = 0, chars: int = 0
) -> Description:
    type_ = {
        "type_id": number,
        "capacity": capacity,
        "string_capacity": chars,
        "nested_type_name": nested,
    }
    return {"name": name, "type": type_}


_TIME: Final[Description] = {
    "type_name": "builtin_interfaces/msg/Time",
    "fields": [_field("sec", 6), _field("nanosec", 7)],
}


def _described(item: FieldText) -> Description:
    plain = item.spelled.partition("[")[0]
    word, _, chars = plain.partition("<=")
    number = BUILTIN[word][0] if word in BUILTIN else NESTED
    if chars:
        number += _LIMITED
    capacity = 0
    if item.is_list:
        capacity = item.length or item.most or 0
        bound = _ANY if item.most is None else _BOUNDED
        number += _ARRAY if item.length is not None else bound
    nested = "" if word in BUILTIN else full_name(item.base)
    return _field(item.name, number, nested, capacity, int(chars or 0))


def dds_name(name: str, kind: str = "msg") -> str:
    """A type as keys spell it: package::msg::dds_::Type_ of package/Type."""
    package, kind, plain = full_name(name, kind).split("/")
    return f"{package}::{kind}::dds_::{plain}_"


_DDS = re.compile(r"([A-Za-z]\w*+)::(msg|srv|action)::dds_::([A-Za-z]\w*+)", re.ASCII)


def ros_name(dds: str) -> tuple[str, str]:
    """Return package/Type and the kind of such a type, "msg" or "srv"; of one of an action
    package/action/Type. Raises DecodeError."""
    found = _DDS.fullmatch(dds)
    if found is None or not found[3].endswith("_"):
        raise DecodeError(f"{dds[:80]!r} is no type of ROS 2")
    plain = found[3][:-1]
    if found[2] != "action":
        return f"{found[1]}/{plain}", found[2]
    kind = "srv" if plain.rpartition("_")[2] in SERVICES else "msg"
    return f"{found[1]}/action/{plain}", kind
