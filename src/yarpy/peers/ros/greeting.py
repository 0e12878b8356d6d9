"""The headers in which both sides of a connection of ROS introduce themselves, and their meaning.

Rules: pure. The type comes from our port, else from the peer: `type` and `message_definition` of
its header, or the definitions that are known here. `*` stands for any type. What does not fit is
told to the peer (`error=`) and raised here, and only that connection ends.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NoReturn

from yarpy.errors import RemoteProtocolError, YarpError
from yarpy.limit import ROS_PEER_FIELDS
from yarpy.log import readable
from yarpy.peers.ros.header import Header, encode_header
from yarpy.route import Route
from yarpy.wire.stream import ByteStream

if TYPE_CHECKING:
    from yarpy.peers.ros.message.library import Service
    from yarpy.peers.ros.message.message import Message as Ros

ANY: Final = "*"
_SHOWN: Final = 300  # characters of an error of the peer


def own_header(route: Route, place: str, kind: Any) -> Header:
    """Return the header of a side that dials; `place` is "topic" or "service", `kind` a class or
    Service."""
    declared, spec = route.declared, route.spec
    where = spec.value(place) or declared.topic or f"no{place}"
    fields = {
        "callerid": own_name(route, route.source),
        "md5sum": ANY if kind is None else kind_md5sum(kind),
        "persistent": "1",
        "tcp_nodelay": "1",
        place: where,
    }
    type_ = declared.type
    package = spec.value("package")
    if package:
        type_ = f"{package}/{where.rpartition('/')[2]}"
    if type_ not in ("", ANY):
        fields["type"] = type_
    if kind is not None:
        fields["message_definition"] = full_text(kind)
        fields.setdefault("type", type_name(kind))
    return fields


def own_name(route: Route, port: str) -> str:
    """The name of the node that our port belongs to."""
    return route.declared.node or port.partition("@")[2] or port


def answer_header(route: Route, fields: Header, kind: Any) -> Header:
    """Return the header with which a side that was dialled answers: the fields that it received,
    replaced where it knows better.

    `type` is left out where neither side has one: C++ YARP looks up whatever it is told, and exits
    where nobody knows `*`. rospy and roscpp need the field; they name it themselves, but for a
    client of roscpp, which names the checksum only.
    """
    answer = {key: value for key, value in fields.items() if key not in ("probe", "error")}
    answer["callerid"] = own_name(route, route.target)
    if route.declared.latched:
        answer["latching"] = "1"
    if kind is None:
        if route.declared.type:
            answer["type"] = route.declared.type
        elif "service" in fields and fields.get("md5sum", ANY) != ANY:
            answer.setdefault("type", ANY)
    else:
        answer |= {
            "type": type_name(kind),
            "md5sum": kind_md5sum(kind),
            "message_definition": full_text(kind),
        }
    return answer


def refuse(stream: ByteStream, text: str) -> NoReturn:
    """Tell the peer why not, and end. Raises RemoteProtocolError."""
    stream.write(encode_header({"error": text}))
    raise RemoteProtocolError(text)


def check_answer(fields: Header, kind: Any, what: str) -> None:
    """Go on only with an answer that fits. Raises RemoteProtocolError."""
    if "error" in fields:
        text = readable(fields["error"][:_SHOWN])
        raise RemoteProtocolError(f"{what} refuses the connection: {text}")
    problem = mismatch(fields, kind)
    if problem:
        raise RemoteProtocolError(f"{what} {problem}")


def mismatch(fields: Header, kind: Any) -> str:
    """Return a text that says how the type that a peer names differs from ours; "" if it does
    not."""
    theirs = fields.get("md5sum", ANY)
    if kind is None or theirs in (ANY, kind_md5sum(kind)):
        return ""
    their_type, ours = fields.get("type", "a type") or "a type", type_name(kind)
    versions = "another version of it" if their_type == ours else f"not {ours}"
    return (
        f"has {readable(their_type[:80])} with the md5sum {readable(theirs[:40])}, {versions}, "
        f"whose md5sum is {kind_md5sum(kind)} here: both sides need the same definition"
    )


def message_kind(fields: Header) -> type[Ros] | None:
    """The class of the messages that a peer describes; None if it names no type.

    Raises UnknownType, DecodeError, RemoteProtocolError.
    """
    name = fields.get("type", ANY)
    if name in ("", ANY):
        return None
    from yarpy.peers.ros.message.library import default_library

    library, text = default_library(), fields.get("message_definition", "")
    kind = library.message_of(name, text, ROS_PEER_FIELDS) if text else library.message(name)
    _check_known(fields, kind)
    return kind


def service_kind(fields: Header) -> Service | None:
    """The service that a peer describes; None if it names no type. Raises as `message_kind`."""
    name = fields.get("type", ANY)
    if name in ("", ANY):
        return None
    from yarpy.peers.ros.message.library import default_library

    library, text = default_library(), fields.get("message_definition", "")
    described = "\n---" in f"\n{text}"
    kind = library.service_of(name, text, ROS_PEER_FIELDS) if described else library.service(name)
    if not text:
        _check_known(fields, kind)
    return kind


def _check_known(fields: Header, kind: Any) -> None:
    problem = mismatch(fields, kind)
    if problem:
        raise RemoteProtocolError(f"the peer {problem}")


def is_service(kind: Any) -> bool:
    """Return whether `kind` is a Service, not a class of messages or None."""
    return hasattr(kind, "Request")


def kind_md5sum(kind: Any) -> str:
    """The checksum of a class of messages or of a Service."""
    found: str = kind.md5sum if is_service(kind) else kind._md5sum
    return found


def type_name(kind: Any) -> str:
    """package/Type of a class of messages or of a Service."""
    found: str = kind.name if is_service(kind) else kind._type
    return found


def full_text(kind: Any) -> str:
    """The text of a class of messages or of a Service, with those of the types in it."""
    found: str = kind.full_text if is_service(kind) else kind._full_text
    return found


def need(fields: Header, *keys: str) -> str:
    """Return the first of these fields that is missing; "" if none is."""
    return next((key for key in keys if key not in fields), "")


def told(stream: ByteStream, error: YarpError) -> NoReturn:
    """Tell the peer of an error of ours. Raises it as RemoteProtocolError."""
    stream.write(encode_header({"error": str(error)}))
    raise RemoteProtocolError(str(error)) from error
