"""Configurations of Zenoh: those of our sessions, and what all have in common.

Rules: whatever ZENOH_CONFIG_OVERRIDE says (`key/path=json5;...`) comes last, as with ROS 2.
Certificates are those of `tls_setting`: `ca.pem` is the authority that routers are checked against,
`cert.pem` and `key.pem` are shown to a router that asks.
"""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from yarpy.errors import AddressError, MissingFile
from yarpy.peers.zenoh.library import load, plain
from yarpy.peers.zenoh.place import SECURE, Place
from yarpy.transports.tls_setting import folder, mutual

OVERRIDE: Final = "ZENOH_CONFIG_OVERRIDE"
# How often a router that went away is looked for: milliseconds at first, at most, and the factor.
RETRY: Final = {"period_init_ms": 500, "period_max_ms": 1000, "period_increase_factor": 1.5}
# Microseconds that what is put waits for room on the way to its router, before it is dropped:
# Zenoh's own thousand pass where this computer is busy for a moment. Routers keep theirs: one
# reader that stands still would hold up the others.
WAIT_BEFORE_DROP: Final = 50_000
_WAIT: Final = "transport/link/tx/queue/congestion_control/drop/wait_before_drop"
OPEN_TIMEOUT: Final = (
    4000  # milliseconds for a router to answer; one that speaks no TLS says nothing
)


def client(where: Place) -> Any:
    if where.file:
        config = from_file(where.file)
    else:
        config = load().Config()
        put(config, "timestamping/enabled", True)  # what keeps old messages needs it
        put(config, "scouting/multicast/enabled", not where.routers)
        if where.routers:
            put(config, "mode", "client")
            put(config, "connect/endpoints", [*where.routers])
            put(config, "connect/retry", RETRY)
            put(config, "transport/unicast/open_timeout", OPEN_TIMEOUT)
            put(config, _WAIT, WAIT_BEFORE_DROP)
            secure(config, (), where.routers)
    override(config)
    return config


def from_file(path: str) -> Any:
    if not Path(path).is_file():
        raise MissingFile(f'there is no configuration file of Zenoh "{path}"')
    try:
        return load().Config.from_file(path)
    except Exception as error:
        raise AddressError(f"{path} is no configuration of Zenoh: {plain(error)}") from error


def said(config: Any) -> dict[str, Any]:
    """Return the entries of a configuration that are not defaults, by key; lists whole."""
    found: dict[str, Any] = {}

    def walk(key: str, value: Any, usual: Any) -> None:
        if isinstance(value, dict) and isinstance(usual, dict):
            for name, each in value.items():
                walk(f"{key}/{name}" if key else name, each, usual.get(name))
        elif value != usual:
            found[key] = _without_nothing(value)

    walk("", json.loads(str(config)), json.loads(str(load().Config())))
    return found


def _without_nothing(value: Any) -> Any:
    """The same without keys that have no value: written back, some of them would not be read."""
    if isinstance(value, dict):
        return {key: _without_nothing(one) for key, one in value.items() if one is not None}
    return [*map(_without_nothing, value)] if isinstance(value, list) else value


def put(config: Any, key: str, value: object) -> None:
    config.insert_json5(key, json.dumps(value))


def secure(config: Any, listen: Sequence[str], connect: Sequence[str]) -> None:
    """Say where the certificates are, if an endpoint needs any. Raises MissingFile."""
    if not any(item.startswith(SECURE) for item in (*listen, *connect)):
        return
    base = folder()
    authority, certificate, key = base / "ca.pem", base / "cert.pem", base / "key.pem"
    own = certificate.is_file() and key.is_file()
    tls: dict[str, Any] = {}
    if authority.is_file():
        tls["root_ca_certificate"] = str(authority)
    if any(item.startswith(SECURE) for item in listen):
        if not own:
            raise MissingFile(
                f"a router that speaks TLS needs cert.pem and key.pem in {base}: `yarpy cert` "
                "makes them"
            )
        tls |= {"listen_certificate": str(certificate), "listen_private_key": str(key)}
        if mutual():
            if not authority.is_file():
                raise MissingFile(
                    f"YARPY_TLS=mutual needs an authority, {authority}: `yarpy cert` makes one"
                )
            tls["enable_mtls"] = True
    if own and connect:
        tls |= {"connect_certificate": str(certificate), "connect_private_key": str(key)}
        tls["enable_mtls"] = True
    put(config, "transport/link/tls", tls)


def override(config: Any) -> None:
    """Apply ZENOH_CONFIG_OVERRIDE. Raises AddressError."""
    for item in os.environ.get(OVERRIDE, "").split(";"):
        if not item.strip():
            continue
        key, _, value = item.partition("=")
        try:
            config.insert_json5(key.strip(), value.strip())
        except Exception as error:
            raise AddressError(f'{OVERRIDE}: "{item.strip()[:80]}": {plain(error)}') from error
