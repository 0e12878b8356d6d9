"""Recordings as tables: of pandas, of pyarrow, or plain columns.

Rules: a row is a message. Lists of numbers that are all of one length have a column for each; what
else there is stays a column of Python objects, `value`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from yarpy.data.bottle import Bottle
from yarpy.errors import UnknownPlugin, YarpError
from yarpy.kits.record.recording import Recording

if TYPE_CHECKING:
    import pandas
    import pyarrow


def columns(recording: Recording, port: str) -> dict[str, Any]:
    """Return what a port sent, as columns: `received` and `sent` (numpy datetime64, nanoseconds),
    `count` (of the envelope, -1 without one), and `v0`, `v1` ... or `value`. Raises UnknownName."""
    import numpy as np

    received: list[int] = []
    sent: list[int] = []
    counts: list[int] = []
    for recorded in recording.messages([port]):
        stamp = recorded.stamp
        received.append(recorded.received_ns)
        sent.append(recorded.sent_ns)
        counts.append(-1 if stamp is None else stamp.count)
    found: dict[str, Any] = {
        "received": np.array(received, "datetime64[ns]"),
        "sent": np.array(sent, "datetime64[ns]"),
        "count": np.array(counts, "i8"),
    }
    try:
        _, numbers = recording.numbers(port)
    except (YarpError, TypeError, ValueError):
        values = np.empty(len(received), object)
        for number, recorded in enumerate(recording.messages([port])):
            try:
                values[number] = recorded.value
            except YarpError as error:
                values[number] = error
        return {**found, "value": values}
    return {**found, **{f"v{number}": column for number, column in enumerate(numbers.T)}}


def frame(recording: Recording, port: str) -> pandas.DataFrame:
    """Return what a port sent, as a DataFrame whose index is the time of sending. Raises
    UnknownName, UnknownPlugin without pandas."""
    try:
        import pandas
    except ImportError:
        raise UnknownPlugin('a DataFrame needs pandas: pip install "yarpy[table]"') from None
    return pandas.DataFrame(columns(recording, port)).set_index("sent")


def table(recording: Recording, port: str) -> pyarrow.Table:
    """Return what a port sent, as a Table of Arrow; what is no numbers is text. Raises UnknownName,
    UnknownPlugin without pyarrow."""
    try:
        import pyarrow
    except ImportError:
        raise UnknownPlugin('a Table needs pyarrow: pip install "yarpy[table]"') from None
    found = columns(recording, port)
    if "value" in found:
        found["value"] = [
            one.to_text() if isinstance(one, Bottle) else str(one) for one in found["value"]
        ]
    return pyarrow.table(found)
