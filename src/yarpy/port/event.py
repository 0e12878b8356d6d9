"""Reports of a port: a connection came or went.

Rules: the texts are those C++ YARP logs. Transient clients (`admin`, tools without a name that
begins with a slash) are not reported.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ConnectionEvent:
    """`incoming`: into the port or out of it; `created`: it came or it went; `reason` says why."""

    incoming: bool
    created: bool
    source: str
    target: str
    carrier: str
    reason: str = ""

    def __str__(self) -> str:
        verb = {
            (True, True): "Receiving input",
            (True, False): "Removing input",
            (False, True): "Sending output",
            (False, False): "Removing output",
        }[self.incoming, self.created]
        text = f"{verb} from {self.source} to {self.target}"
        if self.created:
            text += f" using {self.carrier}"
        return f"{text} ({self.reason})" if self.reason else text
