"""The name server that commands talk to: the first of those in use."""

from __future__ import annotations

from typing import TYPE_CHECKING

from yarpy.errors import LocalProtocolError
from yarpy.names.client import YarpNameClient
from yarpy.names.default import DEFAULT

if TYPE_CHECKING:
    from yarpy.names.ros import RosNames
    from yarpy.names.zenoh import ZenohNames


def server() -> YarpNameClient:
    """The client of the first name server. Raises NoNameServer when none is configured."""
    found = DEFAULT.current()
    found = getattr(found, "clients", [found])[0]
    if not isinstance(found, YarpNameClient):
        raise LocalProtocolError("this takes a name server; start one with `yarpy server`")
    return found


def masters() -> list[RosNames]:
    """The ROS masters among the name services in use. Raises NoNameServer when none is
    configured."""
    from yarpy.names.ros import RosNames

    found = DEFAULT.current()
    return [item for item in getattr(found, "clients", [found]) if isinstance(item, RosNames)]


def zenoh_names() -> ZenohNames | None:
    """The names on Zenoh, if those are what is used first. Raises NoNameServer."""
    from yarpy.names.default import on_zenoh

    return on_zenoh(DEFAULT.current())
