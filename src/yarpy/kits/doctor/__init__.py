"""Doctor: says why a connection is mute, in plain words, with the command that mends it."""

from yarpy.kits.doctor.case import Case
from yarpy.kits.doctor.examination import examine
from yarpy.kits.doctor.finding import Finding

__all__ = ["Case", "Finding", "examine"]
