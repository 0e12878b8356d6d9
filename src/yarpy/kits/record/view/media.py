"""Points in space and sounds, as the page of a recording shows them: some of the points, and the
samples of the first channel, in base64.

Rules: pure; what a client is sent is bounded, and says how much there was.
"""

from __future__ import annotations

import base64
from typing import Any, Final

from yarpy.data.sig.pointcloud import PointCloud
from yarpy.data.sig.sound import Sound
from yarpy.errors import YarpError
from yarpy.kits.record.recorded import Recorded

POINTS: Final = 5000  # of a cloud that are shown
SAMPLES: Final = 1 << 17  # of a message that are heard
_COLOURS: Final = ("r", "g", "b")


def media_of(recorded: Recorded, kind: str) -> dict[str, Any]:
    """Return what is added to a message of that kind: `cloud`, `sound` or nothing."""
    try:
        if kind == "yarp/pointcloud":
            return {"cloud": cloud(recorded.as_(PointCloud))}
        if kind == "yarp/sound":
            return {"sound": sound(recorded.as_(Sound))}
    except YarpError:
        pass
    return {}


def cloud(points: PointCloud) -> dict[str, Any]:
    """Return points at even distances in their row: `xyz` as float32, `rgb` as bytes if they have
    colours, and of how many they are (`of`). Those that are nowhere (NaN) are left out."""
    import numpy as np

    rows = points.array.ravel()
    rows = rows[:: max(1, -(-len(rows) // POINTS))]
    names = rows.dtype.names or ()
    flat = np.zeros(len(rows), "<f4")
    columns = [rows[name] if name in names else flat for name in ("x", "y", "z")]
    places = np.stack(columns, axis=1).astype("<f4")
    there = np.isfinite(places).all(axis=1)
    found: dict[str, Any] = {"of": len(points), "xyz": _base64(places[there])}
    if all(name in names for name in _COLOURS):
        found["rgb"] = _base64(np.stack([rows[name] for name in _COLOURS], axis=1)[there])
    return found


def sound(samples: Sound) -> dict[str, Any]:
    """Return the first samples of the first channel, as int16, and how many make a second."""
    heard = samples.array[0, :SAMPLES] if samples.channels else samples.array.ravel()[:0]
    return {
        "rate": samples.frequency,
        "channels": samples.channels,
        "seconds": samples.length / samples.frequency if samples.frequency > 0 else 0.0,
        "samples": _base64(heard.astype("<i2")),
    }


def _base64(array: Any) -> str:
    return base64.b64encode(array.tobytes()).decode()
