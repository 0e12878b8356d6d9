"""Modes and places from files and from the environment, for programs that all look alike.

    [Eyes]                          Eyes:
    look = "listen"                   look: listen

    [Eyes.look]
    mode = "listen"
    topic = "/other/left"
    middleware = "zeromq"
    timeout = 0.5

Rules: a class is meant by its name, with or without its module. A setting counts for objects whose
method has no mode when it is called. Wrapyfi's files are read as well, with its words for modes; a
list there has one word for each object. What is wrong in a file is an error that names the place.
"""

from __future__ import annotations

import os
import threading
import tomllib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Final

from yarpy.errors import LocalProtocolError, MissingFile
from yarpy.kits.wrap.method import CHANGES, UNDECIDED, Method
from yarpy.kits.wrap.mode import MODES, Mode
from yarpy.platform.refusal import reason
from yarpy.qos import Qos

VARIABLE: Final = "YARPY_WRAP"
#: what Wrapyfi calls the modes
WORDS: Final = {
    **{name: name for name in MODES},
    "reply": "serve",
    "request": "call",
    "reemit": "relay",
    "transceive": "exchange",
    "disable": "off",
    "none": "plain",
    "null": "plain",
}
_METHOD: Final = frozenset(("timeout", "missing", "wait", "together"))

_settings: dict[str, dict[str, Any]] = {}
_methods: list[Method] = []
_lock = threading.Lock()  # of the two above
_read_environment = False


def configure(source: str | os.PathLike[str] | Mapping[str, Any]) -> None:
    """Read settings: a TOML or YAML file, or a mapping of the same shape.

    Raises MissingFile, LocalProtocolError for what makes no sense.
    """
    name = "the settings" if isinstance(source, Mapping) else os.fspath(source)
    table = source if isinstance(source, Mapping) else _read(Path(source))
    found = {}
    for class_name, methods in table.items():
        if not isinstance(methods, Mapping):
            raise LocalProtocolError(f"{name}: {class_name} has no methods below it")
        for method, said in methods.items():
            where = f"{class_name}.{method}"
            found[where] = _checked(said, f"{name}: {where}")
    with _lock:
        _settings.update(found)
        methods = tuple(_methods)
    for known in methods:
        _apply(known)


def _read(path: Path) -> Mapping[str, Any]:
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise MissingFile(f"{path} cannot be read: {reason(error)}") from error
    if path.suffix in (".yml", ".yaml"):
        try:
            import yaml
        except ImportError as error:
            raise LocalProtocolError(
                f"{path} is YAML: `pip install 'yarpy[wrap]'` reads it, or write it as TOML"
            ) from error
        try:
            found = yaml.safe_load(text) or {}
        except yaml.YAMLError as error:
            raise LocalProtocolError(f"{path}: {error}") from error
    else:
        try:
            found = tomllib.loads(text)
        except tomllib.TOMLDecodeError as error:
            raise LocalProtocolError(f"{path}: {error}") from error
    if not isinstance(found, Mapping):
        raise LocalProtocolError(f"{path}: on top there are classes, and below them methods")
    return found


def _checked(said: Any, where: str) -> dict[str, Any]:
    """A setting as a table. Raises LocalProtocolError."""
    table = dict(said) if isinstance(said, Mapping) else {"mode": said}
    unknown = sorted(table.keys() - CHANGES - _METHOD - {"mode"})
    if unknown:
        known = ", ".join(["mode", *sorted(CHANGES | _METHOD)])
        raise LocalProtocolError(f'{where} has "{unknown[0]}"; known are {known}')
    modes = table.get("mode")
    for word in modes if isinstance(modes, list) else [modes]:
        if word is not None and word not in WORDS:
            raise LocalProtocolError(f'{where}: no mode "{word}": take {", ".join(MODES)}')
    if isinstance(table.get("qos"), Mapping):
        try:
            table["qos"] = Qos(**table["qos"])
        except (TypeError, ValueError) as error:
            raise LocalProtocolError(f"{where}: qos: {error}") from error
    return table


def meet(method: Method) -> None:
    """A method was decorated: settings that were read before count for it."""
    global _read_environment
    if not _read_environment:
        _read_environment = True
        text = os.environ.get(VARIABLE, "")
        if text:
            configure(_environment(text))
    with _lock:
        if method not in _methods:
            _methods.append(method)
    _apply(method)


def _environment(text: str) -> dict[str, dict[str, str]]:
    """`Eyes.look=listen;Eyes.blink=off` as a mapping."""
    found: dict[str, dict[str, str]] = {}
    for part in filter(None, (one.strip() for one in text.split(";"))):
        place, equals, mode = part.partition("=")
        class_name, dot, method = place.strip().rpartition(".")
        if not (equals and dot):
            raise LocalProtocolError(f'{VARIABLE}: "{part}" is not Class.method=mode')
        found.setdefault(class_name, {})[method] = mode.strip()
    return found


def _setting(method: Method) -> dict[str, Any] | None:
    with _lock:
        whole = f"{method.module}.{method.qualname}"
        return _settings.get(whole, _settings.get(method.qualname))


def _apply(method: Method) -> None:
    said = _setting(method)
    if said is None:
        return
    for name in _METHOD & said.keys():
        setattr(method, name, said[name])
    if said.get("mode") is not None:
        method.active.setdefault(UNDECIDED, iter(_modes(said["mode"])))


def _modes(said: Any) -> Any:
    """The modes of one object after the other."""
    if not isinstance(said, list):
        while True:
            yield said
    yield from said


def decide(
    method: Method, instance: Any, activate: Callable[[str, Method, Any, dict[str, Any]], Mode]
) -> Mode:
    """The mode that the settings have for this object."""
    said = _setting(method) or {}
    with _lock:
        word = next(method.active[UNDECIDED], None)
    mode = "plain" if word is None else WORDS[word]
    changes = {name: said[name] for name in CHANGES & said.keys()}
    return activate(mode, method, instance, changes)
