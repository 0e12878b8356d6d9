"""Doctor: says why a connection is mute, in plain words, with the command that mends it."""

from yarpy.network.doctor.case import Case
from yarpy.network.doctor.examination import examine
from yarpy.network.doctor.finding import Finding

__all__ = ["Case", "Finding", "examine"]
