"""A video of an episode, by the program ffmpeg: H.264, every second picture a whole one, as data
sets of LeRobot are read from any place.

Rules: pictures are handed over as they come, none is kept.
"""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import Any, Final

from yarpy.errors import LocalProtocolError, UnknownPlugin

CODEC: Final = "h264"
FORMAT: Final = "yuv420p"  # of pixels, which every reader knows
GROUP: Final = 2  # pictures from one that is whole to the next
QUALITY: Final = 23  # crf: less is better


class Video:
    """A new file at `path`. Raises UnknownPlugin without ffmpeg, LocalProtocolError for pictures
    that cannot be a video."""

    def __init__(self, path: Path, width: int, height: int, fps: int) -> None:
        program = shutil.which("ffmpeg")
        if program is None:
            raise UnknownPlugin("pictures of a data set are videos: install the program ffmpeg")
        if width % 2 or height % 2:
            raise LocalProtocolError(
                f"pictures of {width}x{height} pixels: a video has an even number of rows and "
                "columns; leave this port out"
            )
        path.parent.mkdir(parents=True, exist_ok=True)
        self.path = path
        self.shape = (height, width, 3)
        given = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r", str(fps)]
        coded = ["-c:v", "libx264", "-pix_fmt", FORMAT, "-g", str(GROUP), "-crf", str(QUALITY)]
        words = [program, "-loglevel", "error", *given, "-i", "-", *coded, "-n", str(path)]
        self._said = tempfile.TemporaryFile()  # noqa: SIM115  (closed by `close`)
        self._program = subprocess.Popen(
            words, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=self._said
        )

    def add(self, picture: Any) -> None:
        """Append a picture, an array of shape (height, width, 3). Raises LocalProtocolError."""
        assert self._program.stdin is not None
        if picture.shape != self.shape:
            raise LocalProtocolError(
                f"a picture of {picture.shape[1]}x{picture.shape[0]} pixels in a video of "
                f"{self.shape[1]}x{self.shape[0]}: they are all alike in a data set"
            )
        try:
            self._program.stdin.write(picture.tobytes())
        except OSError:
            raise LocalProtocolError(self._why()) from None

    def _why(self) -> str:
        self._program.wait()
        self._said.seek(0)
        said = self._said.read(2000).decode("utf-8", "replace").strip()
        return f"{self.path} cannot be written by ffmpeg: {said or self._program.returncode}"

    def finish(self) -> None:
        """Write the end. Raises LocalProtocolError if it is none."""
        assert self._program.stdin is not None
        try:
            self._program.stdin.close()
        except OSError:
            pass  # what ffmpeg says of it is told below
        if self._program.wait() != 0:
            raise LocalProtocolError(self._why())

    def close(self) -> None:
        """End the program, finished or not."""
        self._program.kill()
        self._program.communicate()
        self._said.close()
