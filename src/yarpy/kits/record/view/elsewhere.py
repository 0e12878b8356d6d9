"""Other programs that show what is recorded or live: Foxglove by an address, Rerun by its library.

    rr = rerun_library()
    rr.init("yarpy", spawn=True)
    with record.open("walk.mcap") as recording:
        for recorded in recording:
            show(rr, recorded)

Rules: what Rerun has no picture, points, curve or line of a log for is shown as a text. There are
two time lines, `sent` by the sender's clock and `received` by that of this program. What cannot be
read is shown as a text that says so.
"""

from __future__ import annotations

from typing import Any, Final
from urllib.parse import quote, urlsplit

from yarpy.data.sig.image import Image
from yarpy.data.sig.matrix import Matrix
from yarpy.data.sig.pointcloud import KINDS, PointCloud
from yarpy.errors import UnknownPlugin, YarpError
from yarpy.kits.record.kind import kind_of
from yarpy.kits.record.recorded import Recorded
from yarpy.kits.record.view.spelling import numbers_of, text_of
from yarpy.port.keep.log_line import read_message

FOXGLOVE: Final = "https://app.foxglove.dev"
_LEVELS: Final = {"WARNING": "WARN", "FATAL": "CRITICAL"}  # by other names
_MODELS: Final = {"rgb": "RGB", "bgr": "BGR", "rgba": "RGBA", "bgra": "BGRA", "mono": "L"}


def foxglove_address(page: str) -> str:
    """Return where Foxglove shows what the server of a page has.

    >>> foxglove_address("http://127.0.0.1:8765/")
    'https://app.foxglove.dev/?ds=foxglove-websocket&ds.url=ws%3A%2F%2F127.0.0.1%3A8765%2F'
    """
    socket = urlsplit(page)._replace(scheme="ws").geturl()
    return f"{FOXGLOVE}/?ds=foxglove-websocket&ds.url={quote(socket, safe='')}"


def rerun_library() -> Any:
    """Return the library of Rerun. Raises UnknownPlugin."""
    try:
        import rerun
    except ImportError:
        raise UnknownPlugin('Rerun is a program of its own: pip install "rerun-sdk"') from None
    return rerun


def show(rr: Any, recorded: Recorded) -> None:
    """Hand a message to the library."""
    import numpy as np

    rr.set_time("sent", timestamp=np.datetime64(min(recorded.sent_ns, (1 << 63) - 1), "ns"))
    rr.set_time("received", timestamp=np.datetime64(recorded.received_ns, "ns"))
    try:
        made = _made(rr, recorded)
    except (YarpError, ValueError) as error:
        made = rr.TextDocument(f"{len(recorded.payload)} bytes that cannot be read: {error}")
    rr.log(recorded.port.lstrip("/") or "message", made)


def _made(rr: Any, recorded: Recorded) -> Any:
    kind = kind_of(recorded.payload)
    if kind == "yarp/image":
        return _picture(rr, Image.from_wire(recorded.payload))
    if kind == "yarp/pointcloud":
        points = PointCloud.from_wire(recorded.payload)
        if "z" in KINDS[points.kind].floats:
            return rr.Points3D(points.xyz.reshape(-1, 3))
    if kind == "yarp/matrix":
        return rr.Scalars(Matrix.from_wire(recorded.payload).array.ravel())
    line = read_message(recorded.message)
    if line is not None and line.level:
        return rr.TextLog(line.text, level=_LEVELS.get(line.level, line.level))
    values = numbers_of(recorded)
    return rr.Scalars(values) if values else rr.TextDocument(text_of(recorded))


def _picture(rr: Any, image: Image) -> Any:
    name = str(image.code)
    if name in ("dec", "mo16"):
        return rr.DepthImage(image.array)
    if name not in _MODELS:
        image, name = image.converted("rgb"), "rgb"
    return rr.Image(image.array, color_model=_MODELS[name])
