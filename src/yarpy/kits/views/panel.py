"""Panel: a page that shows and moves any robot.

GET /         the page
GET /robot    the ports of control boards, cameras and sensors, as JSON
GET /get      ?host=HOST&port=PORT&question=get+encs: a question to one of those ports, as JSON
POST /form    {"admin": 1, "req": ["ask", HOST, PORT, TEXT]}: a command to one of those ports

Rules: the page reads the ports of the robot itself, as any page may: events from `state:o` and
`measures:o`, MJPEG from cameras. Questions and commands to `rpc:i` go through here, because ports
let only pages of their own act. The robot knows nothing of it and may be a C++ one, of which it
shows joints and, if it has that carrier, pictures.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import yarpy
from yarpy.contact import Contact
from yarpy.data.json import to_json
from yarpy.kits.views.asset import jsonpage, site
from yarpy.names.address import is_loopback
from yarpy.names.client import YarpNameClient
from yarpy.names.default import secret
from yarpy.port.connect import identity
from yarpy.port.connect.probe import Caller

if TYPE_CHECKING:
    from yarpy.names.base import NameClient
    from yarpy.port.base import BasePort

TIMEOUT = 4.0  # seconds to wait for an answer, a bit less than the page does

_FILES = (
    *("panel.css", "panel_camera.js", "panel_curve.js", "panel_joint.js"),
    *("panel_port.js", "panel_sensor.js", "horizon.js"),
)


class Panel:
    """Serves the page of the robot whose ports begin with `robot` on `port`.

    names: the name service that knows the robot.
    """

    def __init__(self, port: BasePort, robot: str, names: NameClient) -> None:
        self._robot = "/" + robot.strip("/")
        self._names = names
        self._known: dict[tuple[str, int], Contact] = {}  # ports of the robot, as pages call them
        pages = site("panel", *_FILES)
        pages["/robot"] = self._ports
        pages["/get"] = self._got
        port.on_page(pages)
        port.on_admin(self._asked)

    def _ports(self, fields: Mapping[str, str]) -> yarpy.Page:
        try:
            return jsonpage({**self.robot(), "missing": self.missing()})
        except yarpy.NoNameServer as error:
            return yarpy.Page(str(error), "text/plain; charset=utf-8", 503)

    def _asked(self, message: yarpy.Message) -> object:
        """Pass a command from the page to a port of the robot; returns its answer."""
        match message.value:
            case ["ask", str(host), int(port), str(text)]:
                return self._told(host, port, text)
        return None

    def _got(self, fields: Mapping[str, str]) -> yarpy.Page:
        """The answer to a question that changes nothing."""
        host, port, text = (fields.get(key, "") for key in ("host", "port", "question"))
        if not text.startswith("get ") or not (port.isascii() and port.isdigit()):
            return yarpy.Page("/get?host=HOST&port=PORT&question=get+...\n", "text/plain", 400)
        return yarpy.Page(to_json(self._told(host, int(port), text)), "application/json")

    def _told(self, host: str, port: int, text: str) -> object:
        """The answer of a port of the robot."""
        try:
            if (host, port) not in self._known:
                self.robot()  # started since it was last looked for
            contact = self._known.get((host, port))
            if contact is None:
                return [yarpy.Vocab("fail"), f"no port of {self._robot} is there"]
            identity.confirm(contact, self._names.get, secret(), TIMEOUT)
            with Caller(contact, timeout=TIMEOUT) as caller:
                answer = caller.ask(yarpy.Bottle.from_text(text), TIMEOUT)
                return [] if answer is None else answer.value
        except yarpy.YarpError as error:
            return [yarpy.Vocab("fail"), str(error)]

    def robot(self) -> dict[str, Any]:
        """The ports of the robot by purpose. Raises NoNameServer.

        An address is a host and a number; a host of "" is the one that the page came from.
        """
        found = {contact.name: contact for contact in self._names.list(self._robot)}
        self._known = {_address(contact): contact for contact in found.values()}

        def named(end: str) -> list[str]:
            return sorted(name.removesuffix(end) for name in found if name.endswith(end))

        return {
            "robot": self._robot,
            "server": self._server(),
            "boards": [
                {
                    "name": name,
                    "rpc": _address(found[f"{name}/rpc:i"]),
                    "state": _address(found[f"{name}/state:o"]),
                }
                for name in named("/rpc:i")
                if f"{name}/state:o" in found
            ],
            "cameras": [
                {"name": name, "images": _address(found[name])}
                for name in named("/rpc")
                if name in found
            ],
            "sensors": [
                {"name": name, "measures": _address(found[f"{name}/measures:o"])}
                for name in named("/measures:o")
            ],
        }

    def others(self) -> list[str]:
        """Return all robots whose control boards are registered. Raises NoNameServer."""
        names = {contact.name for contact in self._names.list()}
        boards = {name.removesuffix("/rpc:i") for name in names if name.endswith("/rpc:i")}
        found = {board for board in boards if f"{board}/state:o" in names}
        return sorted({f"/{board.split('/')[1]}" for board in found if board.count("/") > 1})

    def missing(self) -> str:
        """Return what is missing, what exists instead and what to do; "" if the robot is there."""
        try:
            told = self.robot()
            if told["boards"] or told["cameras"]:
                return ""
            others = self.others()
        except yarpy.NoNameServer as error:
            return str(error)
        line = f"waiting for the robot {self._robot}: no control board or camera has such a name"
        if not others:
            return f"{line}, nor is there another robot; `yarpy demo` simulates one"
        return f"{line}; there is {', '.join(others)} (yarpy panel {others[0]})"

    def _server(self) -> tuple[str, int] | None:
        """Return the address of the server that lists all ports, if that is a port."""
        names = self._names
        if not isinstance(names, YarpNameClient):
            return None
        return _address(Contact("tcp", "", names.host, names.port))


def _address(contact: Contact) -> tuple[str, int]:
    return "" if is_loopback(contact.host) else contact.host, contact.port
