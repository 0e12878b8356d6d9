"""For authors of plug-ins: drive a carrier with bytes, test it whole, names for one test alone.

    from yarpy.testing import CarrierConformance

    class TestMine(CarrierConformance):
        carrier = MyCarrier

Rules: works without pytest; the fixtures, which need it, are in `yarpy.testing.fixture`.
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
