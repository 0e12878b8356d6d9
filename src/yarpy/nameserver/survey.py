"""Survey: whether the registered ports answer, whose they are, and what they are connected to.

Rules: ports are asked only while somebody wants to know, side by side and with a time limit. What a
port said is known until it says something else. Only a refused connection proves that nobody is
there; silence proves nothing, nor does a host that cannot be reached.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Final

from yarpy.contact import Contact
from yarpy.data.bottle import Bottle, Property
from yarpy.data.text import plain_text
from yarpy.errors import Timeout, YarpError
from yarpy.network.sampling import ends
from yarpy.port.connect import probe
from yarpy.route import parse_carrier

PERIOD: Final = 2.0  # seconds between rounds, at least
PER_PORT: Final = 0.02  # seconds more for each port: many ports are asked less often
AT_ONCE: Final = 8  # ports that are asked at one time
TIMEOUT: Final = 1.0  # seconds for an answer
WANTED: Final = 6.0  # seconds that a question for the survey keeps it going


class Survey:
    """`contacts()` are the ports; those that are none (multicast groups) are not asked."""

    def __init__(self, contacts: Callable[[], Sequence[Contact]]) -> None:
        self._contacts = contacts
        self._found: dict[str, dict[str, Any]] = {}
        self._until = 0.0
        self._thread: threading.Thread | None = None
        self._lock = threading.Lock()  # pages ask in threads of their own
        self._closed = threading.Event()

    def told(self, contact: Contact) -> dict[str, Any]:
        """Return what is known of a port: plain data for a page.

        alive: None if it is not known; `silent` says why, if it was asked.
        """
        found = self._found.get(contact.name)
        if found is None or found["at"] != contact.address:
            return {"alive": None}
        return {key: value for key, value in found.items() if key != "at"}

    def want(self) -> None:
        """Look at the ports for some seconds more."""
        with self._lock:
            self._until = time.monotonic() + WANTED
            if self._thread is None and not self._closed.is_set():
                self._thread = threading.Thread(target=self._run, name="yarpy survey", daemon=True)
                self._thread.start()

    def close(self) -> None:
        """Ask nobody any more."""
        self._closed.set()

    def _run(self) -> None:
        while not self._closed.is_set():
            contacts = [one for one in self._contacts() if is_port(one)]
            with ThreadPoolExecutor(AT_ONCE) as pool:
                found = list(pool.map(self._ask, contacts))
            self._found = {one.name: told for one, told in zip(contacts, found, strict=True)}
            self._closed.wait(PERIOD + PER_PORT * len(contacts))
            with self._lock:
                if time.monotonic() > self._until:
                    self._thread = None
                    return

    def _ask(self, contact: Contact) -> dict[str, Any]:
        if self._closed.is_set():
            return {"at": contact.address, "alive": None}
        told: dict[str, Any] = {"at": contact.address, "alive": True}
        try:
            about = probe.ask(contact, ["prop", "get", contact.name], timeout=TIMEOUT)
        except Timeout:
            return {**told, "alive": None, "silent": "does not answer: stopped, or very busy"}
        except (YarpError, OSError) as error:
            if probe.is_refused(error):
                return {**told, "alive": False}
            return {**told, "alive": None, "silent": str(error)[:200]}
        process = _pairs(about, "process")
        told["program"] = plain_text(process.get("arguments") or process.get("name") or "")[:200]
        told["process"] = process.get("pid")
        told["links"] = [
            {
                "out": source == contact.name,
                "peer": target if source == contact.name else source,
                "carrier": parse_carrier(end.carrier).base,
                "rate": end.rate,
            }
            for source, target, end in ends(contact)
        ]
        return told


def is_port(contact: Contact) -> bool:
    """Return whether a registration is a port that can be asked."""
    return contact.carrier == "tcp" and contact.name.startswith("/") and bool(contact.port)


def _pairs(about: Bottle, key: str) -> Property:
    """The pairs behind a word in the answer to [prop] [get]; empty if it is not there."""
    value = about.find(key)
    if isinstance(value, dict):
        return Property(value)
    return Property.from_bottle(value) if isinstance(value, Bottle) else Property()
