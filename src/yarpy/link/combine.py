"""The combinations of carriers and transports, and why some are refused.

Rules: pure, by the facts of both. A carrier that moves away from where it has greeted has a second
transport, `over`.
"""

from __future__ import annotations

from yarpy import registry
from yarpy.facts import TransportRow


def combine(carrier: str, over: str, base: TransportRow, secure: bool = False) -> str:
    """Return why `carrier`, which sends over the transport `over` ("": where it has greeted), does
    not greet over `base`; "" if it does. `secure`: there is TLS on `base`."""
    if over == base.name:
        return ""
    if secure and base.no_tls:
        return base.no_tls
    if not over:
        return ""
    if not base.meets:
        return f"{carrier} does not go through {base.title or base.name}: take tcp"
    row = registry.transports.facts(over)
    if secure and row.datagrams:
        return f"TLS protects no datagrams: take tls, not {carrier}"
    if secure and not row.stays:
        return f"TLS protects nothing that {carrier} sends: take tls"
    return ""
