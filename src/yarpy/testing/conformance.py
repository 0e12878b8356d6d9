"""CarrierConformance: what every carrier must do, as tests to inherit.

    class TestMine(CarrierConformance):
        carrier = MyCarrier

Rules: methods called `test_*` with plain asserts, as pytest runs them, but without need of it.
First without a transport (`conformance_dialogue`), then between two real ports
(`conformance_live`). What a carrier's facts (`replies`, `acks`, `spelling`) rule out is not tested.
"""

from __future__ import annotations

from yarpy.testing.conformance_dialogue import DialogueConformance
from yarpy.testing.conformance_live import LiveConformance


class CarrierConformance(DialogueConformance, LiveConformance):
    """Subclass it and set `carrier`; further settings are in `ConformanceCase`."""
