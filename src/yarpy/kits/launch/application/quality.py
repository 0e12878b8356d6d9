"""The priority of a connection as yarpmanager writes it: `level:high; policy:1; priority:30`.

Rules: pure; no case counts, and blanks are free. A word that means nothing is refused.
"""

from __future__ import annotations

from yarpy.errors import LocalProtocolError
from yarpy.qos import LEVELS, Qos, policy_name


def read(text: str) -> Qos:
    """Return the quality of service that a text asks for. Raises LocalProtocolError."""
    packets: str | int | None = None
    policy: str | None = None
    priority: int | None = None
    try:
        for part in text.replace(" ", "").split(";"):
            key, _, value = part.lower().partition(":")
            if key == "level":
                short = value[:4].upper()
                if short not in LEVELS:
                    raise ValueError(f"{value} is none of {', '.join(LEVELS).lower()}")
                packets = short
            elif key == "dscp":
                packets = int(value) if value.isdigit() else value.upper()
            elif key == "tos":
                packets = int(value) >> 2
            elif key == "policy":
                policy = policy_name(int(value))
            elif key == "priority":
                priority = int(value)
            elif part:
                raise ValueError(f'"{key}" is none of level, dscp, tos, policy, priority')
        return Qos(policy, priority, packets)
    except (ValueError, KeyError, LocalProtocolError) as error:
        raise LocalProtocolError(f'qos="{text}": {error}') from None
