"""The interfaces of devices that need no code of their own: one class each, see `network.model`.

interfaces()            all of them, by name
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from yarpy.kits.devices.network.model import Interface

#: Which module of this package has which interface.
WHERE: Final = {
    "AudioPlayer": "audio",
    "AudioRecorder": "audio",
    "ChatBot": "talk",
    "DepthCamera": "depth",
    "Descriptions": "world",
    "Joypad": "joypad",
    "LanguageModel": "talk",
    "Localization2D": "localization",
    "Map2D": "map2d",
    "MobileBase": "mobile_base",
    "Navigation2D": "navigation",
    "Odometry2D": "mobile_base",
    "SerialPort": "serial",
    "SpeechSynthesizer": "speech",
    "SpeechTranscription": "speech",
    "World": "world",
}


def interfaces() -> dict[str, type[Interface]]:
    """Return the interfaces by their names."""
    return {name: getattr(import_module(f"{__name__}.{at}"), name) for name, at in WHERE.items()}
