"""The command language of a name server, without any connection.

    register query unregister list runners set get check route gc help     the registry
    announce subscribe unsubscribe topic untopic type                      topics and rules

Rules: a command is a Bottle, the reply either *old style* (text lines ended by `*** end of
message`) or one Bottle; which of them depends on the verb, on a leading `bot` and on a `(format
json)` that HTTP adds, never on the connection. Unknown verbs get the
end line alone. No input raises; a refusal is said in the reply.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from yarpy.contact import Contact
from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text
from yarpy.data.value import Vocab
from yarpy.errors import AddressError, DecodeError
from yarpy.names.address import plain_host
from yarpy.names.registration_line import PREFIX, registration_line
from yarpy.nameserver.reply import (
    HELP,
    HELP_HEADING,
    Reply,
    broken,
    every,
    fail,
    found,
    ok,
    old,
    port_bottle,
    properties,
    unquoted,
)
from yarpy.nameserver.store import NameStore, Registration
from yarpy.nameserver.topology import (
    Action,
    Subscription,
    Topology,
    bare_name,
    split_network,
    undecorate,
)

# What may be asked by multicast, where anybody can forge the sender of a datagram.
READING = frozenset({"query", "list", "runners", "get", "check", "route", "help"})


class NameService:
    """Answers commands from a name store and a topology. Any thread may call; one command runs at a
    time.

    `lock` is held meanwhile. Hold it yourself to look at `store` or `topology`. `is_alive(contact)`
    tells whether the port of that name still has its address; it may take a while, so it is asked
    without the lock. So is `elsewhere(name)`, which says where a name is that nobody has here.
    `introduced(contact)` is called, with the lock, when a port has said which process it is of:
    what a port of C++ says last when it registers.
    """

    def __init__(
        self,
        store: NameStore,
        topology: Topology,
        is_alive: Callable[[Contact], bool] = lambda contact: False,
    ) -> None:
        self.store = store
        self.topology = topology
        self._is_alive = is_alive
        self.elsewhere: Callable[[str], Contact | None] | None = None
        self.introduced: Callable[[Contact], None] = lambda contact: None
        self.lock = threading.RLock()  # a registration changes store, pools and rules together
        self._subscriber: dict[str, Callable[[list[Any]], Reply]] = {
            "subscribe": self._subscribe,
            "unsubscribe": self._unsubscribe,
            "announce": self._announce,
            "topic": self._topic,
            "untopic": self._untopic,
            "type": self._type,
        }
        self._registry: dict[str, Callable[[list[Any], bool, str], Reply]] = {
            "query": self._query,
            "register": self._register,
            "unregister": self._unregister,
            "list": self._list,
            "runners": self._runners,
            "set": self._set,
            "get": self._get,
            "check": self._check,
            "route": self._route,
            "gc": self._gc,
            "help": self._help,
        }

    @property
    def verbs(self) -> frozenset[str]:
        """The first words of commands."""
        return frozenset({*self._subscriber, *self._registry, "NAME_SERVER", "bot"})

    def answer(
        self, command: Sequence[Any], peer_host: str = "", *, ask_elsewhere: bool = True
    ) -> Reply:
        """The reply to a command that came from `peer_host` ("" when that is not known)."""
        words, nested = without_request(command)
        verb = plain_text(words[0]) if words else ""
        subscriber = self._subscriber.get(verb)
        if subscriber is not None:
            with self.lock:
                try:
                    return subscriber(words)
                except AddressError as error:
                    return fail(str(error))
        if verb == "NAME_SERVER":
            del words[0]
        if words and plain_text(words[0]) == "bot":
            del words[0]
            nested = True
        verb = plain_text(words[0]) if words else ""
        registry = self._registry.get(verb)
        if registry is None:
            return old(())
        if verb == "query" and ask_elsewhere and (strange := self._strange(words)) is not None:
            return found(strange, nested)
        held = self._held(words, peer_host) if verb == "register" else None
        with self.lock:
            if held is not None and self.store.query(held.name) == held:
                return _registered(held, nested)
            try:
                return registry(words, nested, peer_host)
            except AddressError as error:
                return old([f"error {error}"])

    def answer_text(self, line: str | bytes, peer_host: str = "") -> Reply:
        """The reply to a line of text."""
        try:
            command = Bottle.from_text(line)
        except DecodeError:
            command = Bottle()
        return self.answer(command, peer_host)

    def answer_multicast(self, line: str) -> str | None:
        """The first line of the reply, for discovery; None for what may not be asked that way."""
        try:
            command = Bottle.from_text(line.removeprefix(PREFIX))
        except DecodeError:
            return None
        words = command[1:] if command and plain_text(command[0]) == "bot" else command
        if not words or plain_text(words[0]) not in READING:
            return None
        return self.answer(command, ask_elsewhere=False).text_lines()[0]

    # --- registry

    def _query(self, words: list[Any], nested: bool, peer: str) -> Reply:
        network, name = split_network(undecorate(_word(words, 1))[1])
        return found(self.store.query(name, network), nested)

    def _strange(self, words: list[Any]) -> Contact | None:
        """Return the address of a name that nobody has here."""
        network, name = split_network(undecorate(_word(words, 1))[1])
        if self.elsewhere is None or network is not None:
            return None
        with self.lock:
            if name in self.store:
                return None
        return self.elsewhere(name)

    def _held(self, words: list[Any], peer: str) -> Contact | None:
        """Return the address of a living port that has the name which is registered once more on
        the same host.

        That port keeps it: the newcomer is told the number that is in use, cannot listen there, and
        says that there is an address conflict, as around the name server of C++.
        """
        with self.lock:
            contact = self.store.query(_word(words, 1))
        if contact is None or contact.carrier != "tcp" or _port_number(words) > 0:
            return None
        carrier, host = _word(words, 2), _word(words, 3)
        if host in ("", "..."):
            host = plain_host(peer)
        if carrier not in ("", "...", "tcp") or host != contact.host:
            return None
        return contact if self._is_alive(contact) else None

    def _register(self, words: list[Any], nested: bool, peer: str) -> Reply:
        name = _word(words, 1)
        removed = self.store.unregister(name)
        events, actions = self._gone(removed)
        try:
            contact = self.store.register(
                name,
                _word(words, 2),
                _word(words, 3),
                _port_number(words),
                _word(words, 5),
                plain_host(peer),
            )
        except AddressError as error:
            return old([f"error {error}"], events, actions)
        if contact.carrier != "mcast":
            events.append(Bottle([Vocab("add"), contact.name]))
        return _registered(contact, nested, events, actions)

    def _unregister(self, words: list[Any], nested: bool, peer: str) -> Reply:
        name = _word(words, 1)
        removed = self.store.unregister(name)
        events, actions = self._gone(removed)
        if not removed:
            actions += self.topology.vanish(name)  # it may have been announced all the same
        if nested:
            return old(broken(port_bottle(None)), events, actions)
        # As C++ does: one line for each owned name, whether it existed or not.
        owned = sum(len(port.fields.get("owns", ())) for port in removed)
        return old(["old"] * owned, events, actions)

    def _list(self, words: list[Any], nested: bool, peer: str) -> Reply:
        return every(self.store.contacts(_word(words, 1)), nested)

    def _runners(self, words: list[Any], nested: bool, peer: str) -> Reply:
        return every(self.store.having("yarprun", "true"), nested)

    def _set(self, words: list[Any], nested: bool, peer: str) -> Reply:
        name, key = _word(words, 1), _key(words)
        values = self.store.assign(name, key, [plain_text(value) for value in words[3:]])
        if key == "process" and values and (contact := self.store.query(name)) is not None:
            self.introduced(contact)
        return properties(name, key, values, nested)

    def _get(self, words: list[Any], nested: bool, peer: str) -> Reply:
        name, key = _word(words, 1), _key(words)
        return properties(name, key, self.store.values(name, key), nested)

    def _check(self, words: list[Any], nested: bool, peer: str) -> Reply:
        name, key = _word(words, 1), _key(words)
        values = self.store.values(name, key)
        if values is None:
            return old(())
        value = plain_text(words[3]) if len(words) > 3 else ""
        present = "true" if value in values else "false"
        items = ["port", name, "property", key, "value", value, "present"]
        return old([f"{unquoted(items)} {present}"])

    def _route(self, words: list[Any], nested: bool, peer: str) -> Reply:
        source, destination = _word(words, 1), _word(words, 2)
        items = ["port", source, "route", destination, "=", f"tcp:/{destination}"]
        return old([unquoted(items)])

    def _gc(self, words: list[Any], nested: bool, peer: str) -> Reply:
        self.topology.collect(self.store.__contains__)
        return old(["garbage collection done."])

    def _help(self, words: list[Any], nested: bool, peer: str) -> Reply:
        if nested:
            return Reply(bottle=Bottle(HELP))
        return old([HELP_HEADING, *HELP])

    def _gone(self, removed: Iterable[Registration]) -> tuple[list[Bottle], list[Action]]:
        events, actions = [], []
        for port in removed:
            actions += self.topology.vanish(port.name)
            if port.contact.carrier != "mcast":
                events.append(Bottle([Vocab("del"), port.name]))
        return events, actions

    # --- topics and rules

    def _announce(self, words: list[Any]) -> Reply:
        name = _word(words, 1)
        if len(words) > 2 and not (isinstance(words[2], int) and words[2]):
            self.topology.complain(name)
            return ok()
        return ok(self.topology.announce(name))

    def _subscribe(self, words: list[Any]) -> Reply:
        source, destination, mode = _word(words, 1), _word(words, 2), _word(words, 3)
        if destination:
            known = self.store.__contains__
            return ok(self.topology.subscribe(source, destination, mode, known))
        reply = Bottle(["subscriptions"])
        reply += [self._rule(rule) for rule in self.topology.subscriptions(bare_name(source))]
        return Reply(bottle=reply)

    def _rule(self, rule: Subscription) -> Bottle:
        item = Bottle(["subscription", Bottle(["src", rule.source_text])])
        item.append(Bottle(["dest", rule.destination_text]))
        if rule.mode:
            item.append(Bottle(["mode", rule.mode]))
        sides = [int(name in self.topology.topics) for name in (rule.source, rule.destination)]
        if any(sides):
            item.append(Bottle(["topic", *sides]))
        return item

    def _unsubscribe(self, words: list[Any]) -> Reply:
        self.topology.unsubscribe(_word(words, 1), _word(words, 2))
        return ok()

    def _topic(self, words: list[Any]) -> Reply:
        if len(words) < 2:
            return Reply(bottle=Bottle(sorted(self.topology.topics)))
        return ok(self.topology.declare(_word(words, 1), _word(words, 2)))

    def _untopic(self, words: list[Any]) -> Reply:
        self.topology.undeclare(_word(words, 1))
        return ok()

    def _type(self, words: list[Any]) -> Reply:
        family, name = _word(words, 1), _word(words, 2)
        if family != "yarp" or len(words) < 3:
            return fail()
        if len(words) > 3:
            self.topology.describe(name, _word(words, 3))
            return ok()
        structure = self.topology.structures.get(name)
        if structure is None:
            return fail()
        return Reply(bottle=Bottle(["type", family, name, structure]))


# --- reading commands


def without_request(command: Sequence[Any]) -> tuple[list[Any], bool]:
    """The words of a command, and whether HTTP asked for JSON.

    HTTP appends what it knows of the request as `(key value)` lists: `(format json)`,
    `(REQUEST_URI ...)`, the user's variables. C++ takes them for arguments; we do not.
    """
    words = list(command)
    pairs = [item for item in words if isinstance(item, list) and len(item) == 2]
    if not {plain_text(pair[0]) for pair in pairs} & {"format", "REQUEST_URI"}:
        return words, False
    json = any(list(map(plain_text, pair)) == ["format", "json"] for pair in pairs)
    while words and isinstance(words[-1], list):
        del words[-1]
    return words, json


def _registered(
    contact: Contact, nested: bool, events: Sequence[Bottle] = (), actions: Sequence[Action] = ()
) -> Reply:
    """Return the reply about a port that was registered."""
    if nested:
        return old(broken(port_bottle(contact)), events, actions)
    return old([registration_line(contact)], events, actions)


def _word(words: Sequence[Any], place: int) -> str:
    """A name or similar word: numbers, lists and blobs count as "", as in C++."""
    word = words[place] if place < len(words) else ""
    return plain_text(word) if isinstance(word, (str, bool)) else ""


def _key(words: Sequence[Any]) -> str:
    """The key of a property: whatever it is, its text."""
    return plain_text(words[2]) if len(words) > 2 else ""


def _port_number(words: Sequence[Any]) -> int:
    """0 where no port number is asked for, -1 where any will do."""
    if len(words) <= 4:
        return 0
    number = words[4]
    if isinstance(number, bool) or not isinstance(number, (int, float)) or not 0 < number < 1e9:
        return -1
    return int(number)
