"""CarrierConformance: what every carrier must do, as tests to inherit.

    class TestMine(CarrierConformance):
        carrier = MyCarrier

Rules: methods called `test_*` with plain asserts, as pytest runs them, but without needing it.
First without a transport (`conformance_dialogue`), then between two real ports
(`conformance_live`). Tests that a carrier's facts (`replies`, `acks`, `spelling`) rule out skip.
"""

from __future__ import annotations

from yarpy.testing.conformance_dialogue import DialogueConformance
from yarpy.testing.conformance_live import LiveConformance


class CarrierConformance(DialogueConformance, LiveConformance):
    """Subclass it and set `carrier`; further settings are in `ConformanceCase`."""
