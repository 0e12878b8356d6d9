"""CarrierConformance: what every carrier must do, as tests to inherit.

    class TestMine(CarrierConformance):
        carrier = MyCarrier

Rules: methods called `test_*` with plain asserts, as pytest runs them, but without need of it.
First without a transport (`conformance_dialogue`), then between two real ports
(`conformance_live`). What a carrier cannot do by its facts (`replies`, `acks`, `spelling`) is not
asked of it.
"""

from __future__ import annotations

from yarpy.testing.conformance_dialogue import DialogueConformance
from yarpy.testing.conformance_live import LiveConformance


class CarrierConformance(DialogueConformance, LiveConformance):
    """Subclass it and set `carrier`; what else can be said of a carrier is in `ConformanceCase`."""
