"""Record what ports say, look at it, and play it again: `yarpy record`, `info`, `play`.

    from yarpy import record

    with record.Recorder("/icub/head/state:o", path="walk"):
        time.sleep(60)
    with record.open("walk.mcap") as recording:
        for recorded in recording:
            print(recorded.port, recorded.stamp, recorded.value)

Files are MCAP, which Foxglove and others read: the topic is the name of the port, and the exact
bytes of YARP are kept. The extra `record` brings the library for them: pip install "yarpy[record]".
"""

from __future__ import annotations

from yarpy.kits.record.capture.disk_space import Split
from yarpy.kits.record.capture.recorder import Recorder
from yarpy.kits.record.dumper.dataset import Dataset
from yarpy.kits.record.dumper.single import SingleFolder, classical_folder
from yarpy.kits.record.playback.player import Player
from yarpy.kits.record.recorded import PortFacts, Recorded
from yarpy.kits.record.recording import Recording
from yarpy.kits.record.recording import open_recording as open
from yarpy.kits.record.table import frame, table

__all__ = [
    "Dataset",
    "Player",
    "PortFacts",
    "Recorded",
    "Recorder",
    "Recording",
    "SingleFolder",
    "Split",
    "classical_folder",
    "frame",
    "open",
    "table",
]
