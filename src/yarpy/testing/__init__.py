"""For authors of plug-ins: drive a carrier with bytes, test it as a whole, isolate names per test.

    from yarpy.testing import CarrierConformance

    class TestMine(CarrierConformance):
        carrier = MyCarrier

Suites: CarrierConformance, NamesConformance (name clients), TransportConformance,
MonitorConformance, MiddlewareConformance (decorators).

Rules: works without pytest, except for the fixtures: those of `plugin` are there in every project
whose Python has yarpy, those of `fixture` for who imports them. Suites are not loaded before they
are asked for.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any, Final

from yarpy.testing.drive import Dialogue, End, Stalled, drive, said

_WHERE: Final = {
    "CarrierConformance": "conformance",
    "MiddlewareConformance": "conformance_middleware",
    "MonitorConformance": "conformance_monitor",
    "NamesConformance": "conformance_names",
    "TransportConformance": "conformance_transport",
    "private_names": "names",
    "private_server": "names",
}

__all__ = [
    "CarrierConformance",
    "Dialogue",
    "End",
    "MiddlewareConformance",
    "MonitorConformance",
    "NamesConformance",
    "Stalled",
    "TransportConformance",
    "drive",
    "private_names",
    "private_server",
    "said",
]

if TYPE_CHECKING:
    from yarpy.testing.conformance import CarrierConformance
    from yarpy.testing.conformance_middleware import MiddlewareConformance
    from yarpy.testing.conformance_monitor import MonitorConformance
    from yarpy.testing.conformance_names import NamesConformance
    from yarpy.testing.conformance_transport import TransportConformance
    from yarpy.testing.names import private_names, private_server


def __getattr__(name: str) -> Any:
    if name not in _WHERE:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"yarpy.testing.{_WHERE[name]}"), name)
