"""segmentationimage_to_rgb: label images (`mono` or `mo16`) in 64 distinct colours.

The colours of C++ YARP, by the label modulo 64. Either end.
"""

from __future__ import annotations

from yarpy.data.sig.image import Image
from yarpy.monitors.base import Place
from yarpy.monitors.imaging.picture import picture
from yarpy.wire.message import Message

_COLOURS = bytes.fromhex(
    "000000 00FF00 0000FF FF0000 01FFFE FFA6FE FFDB66 006401 010067 95003A 007DB5 FF00F6 FFEEE8 "
    "774D00 90FB92 0076FF D5FF00 FF937E 6A826C FF029D FE8900 7A4782 7E2DD2 85A900 FF0056 A42400 "
    "00AE7E 683D3B BDC6FF 263400 BDD393 00B917 9E008E 001544 C28C9F FF74A3 01D0FF 004754 E56FFE "
    "788231 0E4CA1 91D0CB BE9970 968AE8 BB8800 43002C DEFF74 00FFC6 FFE502 620E00 008F9C 98FF52 "
    "7544B1 B500FF 00FF78 FF6E41 005F39 6B6882 5FAD4E A75740 A5FFD2 FFB167 009BFF E85EBE"
)


class LabelColours:
    """Colours for labels."""

    def __init__(self, place: Place) -> None:
        pass

    def update(self, message: Message) -> Image:
        import numpy as np

        labels = picture(message, "mono", "mo16").array
        return Image(np.frombuffer(_COLOURS, "u1").reshape(64, 3)[labels % 64], "rgb")
