"""For authors of plug-ins: drive a carrier with bytes, test it as a whole, isolate names per test.

    from yarpy.testing import CarrierConformance

    class TestMine(CarrierConformance):
        carrier = MyCarrier

Rules: works without pytest, except for the fixtures in `yarpy.testing.fixture`.
"""

from yarpy.testing.conformance import CarrierConformance
from yarpy.testing.drive import Dialogue, End, Stalled, drive, said
from yarpy.testing.names import private_names, private_server

__all__ = [
    "CarrierConformance",
    "Dialogue",
    "End",
    "Stalled",
    "drive",
    "private_names",
    "private_server",
    "said",
]
