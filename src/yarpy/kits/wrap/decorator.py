"""The decorator `on`, the functions that choose a mode, and the handles that these return.

Rules: a method without a mode costs one look into a dict. A mode belongs to one object, and ends
with it, with `close`, with another mode, or with the program; a forked process begins without any.
"""

from __future__ import annotations

import atexit
import functools
import threading
import weakref
from collections.abc import AsyncIterator, Awaitable, Callable, Iterable, Iterator
from typing import Any, Generic, Self, TypeVar, overload

from yarpy import fork
from yarpy.errors import LocalProtocolError
from yarpy.kits.wrap import setting
from yarpy.kits.wrap.method import EVERYBODY, MISSING, UNDECIDED, Method, Missing, Output
from yarpy.kits.wrap.middleware import Encoding, Keep
from yarpy.kits.wrap.mode import MODES, Listen, Mode
from yarpy.kits.wrap.value.typed import Decorator
from yarpy.qos import Qos

R = TypeVar("R")

#: where a decorated function keeps its Method; `functools.wraps` of others hands it on
_ATTRIBUTE = "__yarpy_method__"
_lock = threading.RLock()  # of who has which mode
_living: weakref.WeakSet[Mode] = weakref.WeakSet()


def on(
    topic: str,
    middleware: str | Iterable[str] = "yarp",
    *,
    source: str = "",
    carrier: str = "",
    qos: Qos | None = None,
    keep: Keep = "latest",
    reliable: bool = False,
    encoding: Encoding = "native",
    timeout: float | None = None,
    missing: Missing = "raise",
    wait: float = 0.0,
    together: bool = False,
) -> Decorator:
    """Say where what a method returns goes; several decorators are for the elements of a tuple,
    the topmost for the first.

    topic: `{self.name}` in it is an attribute of the object, looked up when a mode is chosen.
    middleware: a name, "mqtt://broker:1883" with a place, or several for the same value.
    source: where `relay`, `exchange` and `receive` listen, if not to the topic.
    carrier: of connections between ports: "udp", "mcast", "tcp+recv.priority" ...
    qos: threads and packets of this value's connections.
    keep: "latest", "all" or how many values wait until they are taken.
    reliable: lose nothing on the way, where the middleware has such a choice.
    encoding: "native" where the middleware has a type for it, "frame" always, or "wrapyfi".
    timeout: seconds that `listen`, `call` and the like wait; a call may give another.
    missing: what is returned if nothing came in time: an error, None, or the last value.
    wait: seconds that the first value waits for somebody who listens.
    together: listeners get values of the same call.

    Raises TypeError for a hint that cannot be sent, ValueError for what the middleware cannot do,
    UnknownPlugin, AddressError.
    """
    names = (middleware,) if isinstance(middleware, str) else tuple(middleware)
    output = Output(topic, names, source, carrier, qos, keep, reliable, encoding)
    if missing not in MISSING:
        raise ValueError(f"missing={missing!r} is none of {', '.join(MISSING)}")
    for name, seconds in (("timeout", 0.0 if timeout is None else timeout), ("wait", wait)):
        if not isinstance(seconds, (int, float)):
            raise TypeError(f"{name}={seconds!r} is no number of seconds")
        if not seconds >= 0:
            raise ValueError(f"{name}={seconds!r}: a time to wait is not less than 0 seconds")

    def decorate(func: Any) -> Any:
        decorated, method = _decorated(func)
        if timeout is not None:
            method.timeout = timeout
        if missing != "raise":
            method.missing = missing
        method.wait = max(method.wait, wait)
        method.together = method.together or together
        method.add(output)
        setting.meet(method)
        return decorated

    return decorate


def _decorated(func: Any) -> tuple[Any, Method]:
    """A function that looks for a mode first, and its Method."""
    found = getattr(func, _ATTRIBUTE, None)
    if found is not None:
        return func, found
    if isinstance(func, (staticmethod, classmethod)):
        inner, method = _decorated(func.__func__)
        return type(func)(inner), method
    if not callable(func) or not hasattr(func, "__code__"):
        raise TypeError(f"wrap.on decorates functions and methods, not {func!r}")
    method = Method(func)
    wrapper = _WRAPPERS[method.kind](func, method)
    setattr(wrapper, _ATTRIBUTE, method)
    return wrapper, method


def _find(active: dict[int, Mode], method: Method, args: tuple[Any, ...]) -> Mode | None:
    """The mode that counts for a call."""
    mode = active.get(id(args[0])) if args else None
    return _find_other(active, method, args) if mode is None else mode


def _find_other(active: dict[int, Mode], method: Method, args: tuple[Any, ...]) -> Mode | None:
    """The mode of an object for which none was chosen."""
    mode = active.get(EVERYBODY)
    if mode is None and UNDECIDED in active and args:
        mode = setting.decide(method, args[0], _activate)
    return mode


def _function(func: Callable[..., Any], method: Method) -> Callable[..., Any]:
    active = method.active

    @functools.wraps(func)
    def call(*args: Any, **kwargs: Any) -> Any:
        if not active:
            return func(*args, **kwargs)
        mode = active.get(id(args[0])) if args else None  # as `_find`: this is what a call costs
        if mode is None:
            mode = _find_other(active, method, args)
        return func(*args, **kwargs) if mode is None else mode.run(func, args, kwargs)

    return call


def _coroutine(func: Callable[..., Any], method: Method) -> Callable[..., Any]:
    active = method.active

    @functools.wraps(func)
    async def call(*args: Any, **kwargs: Any) -> Any:
        mode = _find(active, method, args) if active else None
        if mode is None:
            return await func(*args, **kwargs)
        return await mode.run_async(func, args, kwargs)

    return call


def _generator(func: Callable[..., Any], method: Method) -> Callable[..., Any]:
    active = method.active

    @functools.wraps(func)
    def call(*args: Any, **kwargs: Any) -> Any:
        mode = _find(active, method, args) if active else None
        return func(*args, **kwargs) if mode is None else mode.stream(func, args, kwargs)

    return call


def _async_generator(func: Callable[..., Any], method: Method) -> Callable[..., Any]:
    active = method.active

    @functools.wraps(func)
    def call(*args: Any, **kwargs: Any) -> Any:
        mode = _find(active, method, args) if active else None
        return func(*args, **kwargs) if mode is None else mode.stream_async(func, args, kwargs)

    return call


_WRAPPERS = {
    "function": _function,
    "coroutine": _coroutine,
    "generator": _generator,
    "async generator": _async_generator,
}


# ------------------------------------------------------------------------------------ modes


def target(decorated: Any) -> tuple[Method, Any]:
    """The Method of a decorated function or of a method of an object, and the object."""
    method = getattr(decorated, _ATTRIBUTE, None)
    if method is None:
        raise LocalProtocolError(
            f"{getattr(decorated, '__qualname__', decorated)!s} is not decorated: write "
            '@wrap.on("/topic") above it'
        )
    return method, getattr(decorated, "__self__", None)


def activate(name: str, decorated: Callable[..., R], changes: dict[str, Any]) -> Handle[R]:
    """Choose a mode; one that was chosen before ends."""
    method, instance = target(decorated)
    return Handle(decorated, _activate(name, method, instance, changes))


def _activate(name: str, method: Method, instance: Any, changes: dict[str, Any]) -> Mode:
    with _lock:
        key = EVERYBODY if instance is None else id(instance)
        end(method, key)
        mode = MODES[name](method, instance, method.placed(instance, changes))
        method.active[key] = mode
        _living.add(mode)
        if instance is not None:
            _tie(mode, method, instance, key)
        return mode


def _tie(mode: Mode, method: Method, instance: Any, key: int) -> None:
    """End the mode with its object. One without weak references lives as long as its mode."""

    def gone(reference: object) -> None:
        if method.active.get(key) is mode:
            del method.active[key]
        # Closing waits for threads, perhaps for the one in which objects are being collected.
        threading.Thread(target=mode.close, name=f"yarpy close {method.name}", daemon=True).start()

    try:
        mode.tie = weakref.ref(instance, gone)
    except TypeError:
        mode.tie = instance


def end(method: Method, key: int) -> None:
    """End the mode of an object, if it has one."""
    mode = method.active.pop(key, None)
    if isinstance(mode, Mode):
        mode.tie = None
        mode.close()


class Handle(Generic[R]):
    """A mode that was chosen. Calling it calls the method; `with` ends it at the end."""

    def __init__(self, decorated: Callable[..., R], mode: Mode) -> None:
        self._decorated = decorated
        self._mode = mode

    def __call__(self, *args: Any, **kwargs: Any) -> R:
        return self._decorated(*args, **kwargs)

    @property
    def mode(self) -> str:
        """Its name: "publish", "listen" ..."""
        return self._mode.name

    @property
    def closed(self) -> bool:
        """True after it has ended."""
        return self._mode.stop.is_set()

    @property
    def stats(self) -> list[dict[str, Any]]:
        """For each topic and middleware, its name, `direction`, and what the middleware counts:
        for ports what `port.stats` says."""
        return self._mode.stats

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until it has ended, as a program that only serves does; False if time is over."""
        return self._mode.stop.wait(timeout)

    def close(self) -> None:
        """End it: the method is an ordinary one again."""
        method, instance = target(self._decorated)
        with _lock:
            key = EVERYBODY if instance is None else id(instance)
            if method.active.get(key) is self._mode:
                end(method, key)
            else:
                self._mode.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()

    def __repr__(self) -> str:
        state = "closed" if self.closed else self.mode
        return f"<Handle of {target(self._decorated)[0].qualname} ({state})>"


def last(decorated: Any) -> Any:
    """Return the last value that a listening method got, with count, time and source: a
    Received, or for several decorators a tuple of them; None for one that has got no value yet."""
    method, instance = target(decorated)
    mode = method.active.get(EVERYBODY if instance is None else id(instance))
    found = mode.last if isinstance(mode, Mode) else []
    if len(method.outputs) == 1:
        return found[0] if found else None
    return tuple(found) or (None,) * len(method.outputs)


class Stream(Generic[R]):
    """The values of a listening method until its mode ends, for `for` and `async for`."""

    def __init__(self, mode: Listen, timeout: float | None) -> None:
        self._mode = mode
        self._timeout = timeout

    def __iter__(self) -> Iterator[R]:
        return self._mode.values(self._timeout)

    def __aiter__(self) -> AsyncIterator[R]:
        return self._mode.values_async(self._timeout)


@overload
def stream(
    decorated: Callable[..., Iterator[R] | AsyncIterator[R] | Awaitable[R]],
    timeout: float | None = None,
) -> Stream[R]: ...
@overload
def stream(decorated: Callable[..., R], timeout: float | None = None) -> Stream[R]: ...
def stream(decorated: Callable[..., Any], timeout: float | None = None) -> Stream[Any]:
    """Everything that a method gets, which is set to listen if it has no mode: `for value in
    wrap.stream(eyes.look)`, or `async for`.

    Raises Timeout, in the loop, if nothing comes for `timeout` seconds; LocalProtocolError for a
    method with another mode.
    """
    method, instance = target(decorated)
    with _lock:
        key = EVERYBODY if instance is None else id(instance)
        mode = method.active.get(key) or _activate("listen", method, instance, {})
    if not isinstance(mode, Listen):
        raise LocalProtocolError(f"{method.qualname} does not listen, it is set to {mode.name}")
    return Stream(mode, method.timeout if timeout is None else timeout)


@atexit.register
def _end_all() -> None:
    for mode in tuple(_living):
        mode.close()


def _start_over() -> None:
    """A forked process has none of the threads and ports of its parent."""
    global _lock
    _lock = threading.RLock()
    for mode in tuple(_living):
        for key, one in tuple(mode.method.active.items()):
            if one is mode:
                del mode.method.active[key]
    _living.clear()


fork.after_in_child(_start_over)
