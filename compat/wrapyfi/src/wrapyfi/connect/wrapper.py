"""MiddlewareCommunicator: the decorator `register`, and which side each object takes.

Rules: what is kept of Wrapyfi are names, arguments, what is returned, and the registry that its own
tests read. State is found by the object's identity, weakly, and ends with the object; nothing is
stored in it. The arguments of the first call that communicates count for topics and options.
"""

from __future__ import annotations

import atexit
import functools
import inspect
import logging
import os
import threading
import weakref
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import wrapyfi.connect  # noqa: F401  the middlewares are registered
import yarpy
from wrapyfi.config.manager import ConfigManager
from wrapyfi.connect.clients import Clients
from wrapyfi.connect.listeners import Listeners
from wrapyfi.connect.publishers import Publishers
from wrapyfi.connect.servers import Servers
from wrapyfi.utils.core_utils import deepcopy, get_default_args, match_args  # noqa: F401
from yarpy import fork

DEFAULT_COMMUNICATOR = os.environ.get(
    "WRAPYFI_DEFAULT_MWARE", os.environ.get("WRAPYFI_DEFAULT_COMMUNICATOR", "zeromq")
)
MODES = ("publish", "listen", "reply", "request", "transceive", "reemit", "receive", "disable")
_RECORD = "__wrapyfi_record__"
_SIDES = ("publisher_kwargs", "listener_kwargs")

_records: list[Record] = []
_lock = threading.RLock()  # of records and their instances


class Declared:
    """One element of one decorator: type, middleware, class name, topic, and options."""

    def __init__(self, data_type: Any, middleware: Any, *args: Any, **kwargs: Any) -> None:
        if not isinstance(data_type, str):
            raise NotImplementedError(f"{data_type!r} is no type: NativeObject, Image, AudioChunk")
        self.data_type = data_type
        self.middleware = middleware
        self.args = args
        self.kwargs = kwargs


class Instance:
    """An object that takes part: its mode, and what it has opened."""

    def __init__(self, obj: Any, record: Record) -> None:
        self.addr = hex(id(obj))
        self.mode: str | None = None
        self.opened: dict[str, list[Any]] = {}
        try:
            self._reference: Any = weakref.ref(obj, lambda _: record.lose(self))
        except TypeError:
            self._reference = lambda: obj
        self.id = id(obj)

    def close(self) -> None:
        """Close what it has opened."""
        with _lock:
            opened, self.opened = self.opened, {}
        for parts in opened.values():
            for part in _flat(parts):
                try:
                    part.close()
                except Exception as error:
                    logging.warning("[wrapyfi] closing %s: %s", type(part).__name__, error)


class Record:
    """A decorated function: its decorators, and the objects that take part, in their order."""

    def __init__(self, func: Callable[..., Any]) -> None:
        self.func = func
        self.name = func.__qualname__.rpartition("<locals>.")[2]
        self.outputs: list[Any] = []
        self.instances: list[Instance] = []
        self.wrapper: Any = None
        self.signature = inspect.signature(func)
        _records.append(self)

    def find(self, obj: Any) -> Instance | None:
        for one in self.instances:
            if one.id == id(obj):
                return one
        return None

    def activate(self, obj: Any, mode: Any) -> None:
        """Choose a mode; what was open in another one is closed."""
        with _lock:
            found = self.find(obj)
            if found is None:
                found = Instance(obj, self)
                self.instances.append(found)
            if isinstance(mode, (list, tuple)):
                mode = mode[self.instances.index(found)]
            if mode == "none":
                mode = None
            if mode is not None and mode not in MODES:
                raise ValueError(f'no mode "{mode}": take {", ".join(MODES)} or None')
            if mode != found.mode:
                found.close()
            found.mode = mode
            self.show()

    def forget(self, instance: Instance) -> None:
        """An object takes part no more; those behind it move up."""
        with _lock:
            if instance in self.instances:
                self.instances.remove(instance)
                self.show()
        instance.close()

    def lose(self, instance: Instance) -> None:
        """An object is gone. Closing waits for threads, perhaps for the one that collects it."""
        threading.Thread(target=self.forget, args=(instance,), daemon=True).start()

    def show(self) -> None:
        """Bring the registry up to date, which programs read."""
        registry = MiddlewareCommunicator._MiddlewareCommunicator__registry  # type: ignore[attr-defined]
        base: dict[str, Any] = registry.setdefault(self.name, {})
        base["communicator"] = self.outputs
        base["__WRAPYFI_INSTANCES"] = [one.addr for one in self.instances]
        base.setdefault("args", [])
        base.setdefault("kwargs", {})
        first = self.instances[0] if self.instances else None
        base["mode"] = first.mode if first is not None else None
        base["instance_addr"] = first.addr if first is not None else None
        number = 2
        while f"{self.name}.{number}" in registry:
            del registry[f"{self.name}.{number}"]
            number += 1
        for number, one in enumerate(self.instances[1:], start=2):
            registry[f"{self.name}.{number}"] = {
                **base,
                "mode": one.mode,
                "instance_addr": one.addr,
            }

    # -- calls ------------------------------------------------------------------------------------

    def call(self, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
        """Do what the decorated function does."""
        if self.wrapper.__defaults__ is not self.func.__defaults__:  # type: ignore[attr-defined]
            self._take_defaults()
        instance = self.find(args[0]) if args and self.instances else None
        if instance is None or instance.mode is None:
            return self.func(*args, **kwargs)
        return getattr(self, f"_{instance.mode}")(instance, args, kwargs)

    def _take_defaults(self) -> None:
        """Programs change topics by assigning `method.__defaults__`."""
        self.func.__defaults__ = self.wrapper.__defaults__  # type: ignore[attr-defined]
        self.signature = inspect.signature(self.func)

    def _disable(self, instance: Instance, args: Any, kwargs: Any) -> Any:
        return [None] * len(self.outputs)

    def _publish(self, instance: Instance, args: Any, kwargs: Any) -> Any:
        value = self.func(*args, **kwargs)
        self._send(self._opened(instance, Publishers, args, kwargs), value)
        return value

    def _send(self, publishers: list[Any], value: Any) -> None:
        for index, one in enumerate(value):
            publisher = publishers[index]
            if isinstance(publisher, list):
                for part, element in zip(publisher, one, strict=False):
                    part.publish(element)
            else:
                publisher.publish(one)

    def _listen(self, instance: Instance, args: Any, kwargs: Any) -> Any:
        return _heard(self._opened(instance, Listeners, args, kwargs))

    def _reply(self, instance: Instance, args: Any, kwargs: Any) -> Any:
        servers = self._opened(instance, Servers, args, kwargs)
        value: list[Any] = []  # of the first request; the others are for the other elements
        for index, server in enumerate(servers):
            for place, part in enumerate(server if isinstance(server, list) else [server]):
                asked, named = part.await_request()
                try:
                    if not value:
                        value.append(self.func(args[0], *asked, **named))
                    found = value[0][index]
                    found = found[place] if isinstance(server, list) else found
                except Exception as error:
                    logging.exception("[wrapyfi] %s failed for a client", self.name)
                    part.reply(error)
                    return [None] * len(self.outputs)
                part.reply(found)
        return value[0]

    def _request(self, instance: Instance, args: Any, kwargs: Any) -> Any:
        clients = self._opened(instance, Clients, args, kwargs)
        return [
            [part.request(*args[1:], **kwargs) for part in client]
            if isinstance(client, list)
            else client.request(*args[1:], **kwargs)
            for client in clients
        ]

    def _transceive(self, instance: Instance, args: Any, kwargs: Any) -> Any:
        publishers = self._opened(instance, Publishers, args, kwargs)
        listeners = self._opened(instance, Listeners, args, kwargs)
        value = self.func(*args, **kwargs)
        with ThreadPoolExecutor(1) as pool:
            sent = pool.submit(self._send, publishers, value)
            found = _heard(listeners)
            sent.result()
        return found

    def _reemit(self, instance: Instance, args: Any, kwargs: Any) -> Any:
        value = self._receive(instance, args, kwargs)
        self._send(self._opened(instance, Publishers, args, kwargs), value)
        return value

    def _receive(self, instance: Instance, args: Any, kwargs: Any) -> Any:
        found = _heard(self._opened(instance, Listeners, args, kwargs))
        return self.func(*args, *found, **kwargs)

    # -- what is opened ---------------------------------------------------------------------------

    def _opened(self, instance: Instance, side: Any, args: Any, kwargs: Any) -> list[Any]:
        """Publishers, listeners, servers or clients: those of the first call."""
        with _lock:
            found = instance.opened.get(side.folder)
            if found is None:
                if instance not in self.instances:
                    raise yarpy.PortClosed(f"{self.name} was closed meanwhile")
                values = self._values(args, kwargs)
                found = [_made(side, one, args[1:], values) for one in self.outputs]
                instance.opened[side.folder] = found
            return found

    def _values(self, args: Any, kwargs: Any) -> dict[str, Any]:
        """Return the parameters of this call. Listeners and clients may be given others."""
        known = {name: value for name, value in kwargs.items() if name in self.signature.parameters}
        try:
            bound = self.signature.bind_partial(*args, **known)
        except TypeError:
            bound = self.signature.bind_partial(args[0], **known)
        bound.apply_defaults()
        return {**bound.arguments, **kwargs}


def _heard(listeners: list[Any]) -> list[Any]:
    return [
        [part.listen() for part in one] if isinstance(one, list) else one.listen()
        for one in listeners
    ]


def _flat(parts: list[Any]) -> list[Any]:
    return [one for part in parts for one in (part if isinstance(part, list) else [part])]


def _made(side: Any, declared: Any, args: tuple[Any, ...], values: dict[str, Any]) -> Any:
    """An object of `side` for one decorator, or a list for one that holds several."""
    if isinstance(declared, list):
        return [_made(side, one, args, values) for one in declared]
    middleware = _substituted(declared.middleware, args, values)
    places = [_substituted(one, args, values) for one in declared.args]
    options = dict(declared.kwargs)
    own = {Publishers: "publisher_kwargs", Listeners: "listener_kwargs"}.get(side)
    for name in _SIDES:
        found = options.pop(name, None)
        if found and name == (own or _side_of(side)):
            options.update(found)
    options = {name: _filled(value, args, values) for name, value in options.items()}
    class_name = options.pop("class_name", places[0] if places else "")
    sending = side in (Publishers, Servers)
    topics = {name: options.pop(name, None) for name in ("out_topic", "in_topic")}
    topic = topics["out_topic" if sending else "in_topic"] or (places[1] if len(places) > 1 else "")
    if not topic:
        raise TypeError(f"no topic for {declared.data_type} over {middleware}")
    extra = places[2:]
    if extra:
        logging.info("[wrapyfi] %s: %r is taken for the carrier", topic, extra[0])
        options.setdefault("carrier", extra[0])
    kind = side.find(declared.data_type, str(middleware))
    return kind(class_name, topic, **options)


def _side_of(side: Any) -> str:
    return "publisher_kwargs" if side is Servers else "listener_kwargs"


def _substituted(value: Any, args: tuple[Any, ...], values: dict[str, Any]) -> Any:
    """A decorator's positional value: `$0` and `$name` are arguments of the call."""
    if not isinstance(value, str) or not value.startswith("$"):
        return value
    name = value[1:]
    if name.isdigit():
        return args[int(name)]
    return values[name]


def _filled(value: Any, args: tuple[Any, ...], values: dict[str, Any]) -> Any:
    """The same in options, also in dicts of them."""
    if isinstance(value, dict):
        return {name: _filled(one, args, values) for name, one in value.items()}
    if isinstance(value, str) and "$" in value:
        return _substituted(f"${value[1:]}", args, values)
    return value


class MiddlewareCommunicator:
    """The base class of programs whose methods communicate."""

    __registry: dict[str, dict[str, Any]] = {}  # programs read it

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        self.config = ConfigManager(None).config
        for method, mode in (self.config.get(type(self).__name__) or {}).items():
            self.activate_communication(method, mode)

    @classmethod
    def register(
        cls,
        data_type: Any,
        middleware: Any = DEFAULT_COMMUNICATOR,
        *args: Any,
        **kwargs: Any,
    ) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
        """A decorator for one returned value, the topmost for the first: type, middleware, class
        name, topic and options; or a list of `[type, middleware, class name, topic, {options}]`
        for a value that is a list."""
        declared: Any
        if isinstance(data_type, (list, tuple)):
            declared = [Declared(*one[:-1], **one[-1]) for one in data_type]
        else:
            declared = Declared(data_type, middleware, *args, **kwargs)

        def decorate(func: Callable[..., Any]) -> Callable[..., Any]:
            record = getattr(func, _RECORD, None)
            wrapper = func
            if record is None:
                record = Record(func)

                @functools.wraps(func)
                def wrapper(*wds: Any, **kwds: Any) -> Any:
                    return record.call(wds, kwds)

                record.wrapper = wrapper
                wrapper.__defaults__ = func.__defaults__  # type: ignore[attr-defined]
                setattr(wrapper, _RECORD, record)
            record.outputs.insert(0, declared)
            record.show()
            return wrapper

        return decorate

    @classmethod
    def get_communicators(cls) -> set[str]:
        """The names of the middlewares that can be used."""
        return {*Publishers.mwares, *Listeners.mwares, *Servers.mwares, *Clients.mwares} - {
            "fallback"
        }

    def activate_communication(
        self, func: str | Callable[..., Any], mode: Any, id_postfix: bool = False
    ) -> None:
        """Choose the mode of a method: its name, `self.method` or `Class.method`."""
        method = getattr(type(self), func) if isinstance(func, str) else func
        record = getattr(method, _RECORD, None)
        if record is not None:
            record.activate(self, mode)

    def close(self) -> None:
        """Close everything of this object."""
        for record in tuple(_records):
            found = record.find(self)
            if found is not None:
                record.forget(found)

    @classmethod
    def close_instance(cls, instance_addr: str | None = None) -> None:
        """Close everything of the object with this address, `hex(id(obj))`."""
        for record in tuple(_records):
            for found in tuple(record.instances):
                if found.addr == instance_addr:
                    record.forget(found)

    @classmethod
    def close_all_instances(cls) -> None:
        """Close everything of all objects."""
        for record in tuple(_records):
            for found in tuple(record.instances):
                record.forget(found)


@atexit.register
def _end() -> None:
    MiddlewareCommunicator.close_all_instances()


def _start_over() -> None:
    """A forked process has none of the sockets and threads of its parent: they are opened anew."""
    global _lock
    _lock = threading.RLock()
    for record in _records:
        for found in record.instances:
            found.opened.clear()


fork.after_in_child(_start_over)
