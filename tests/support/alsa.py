"""A sound card that is a pair of files, for programs that play and record through ALSA (Linux).

    environment = sound_card(tmp_path, heard=samples)
    ... a program started with it ...
    played(tmp_path)        what it played, as int16

Rules: the real libraries run, PortAudio and ALSA, without a card and without its clock: what is
played is in the file at once.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from support.command_line import CommandLine
from support.peer import demand

SYSTEM = Path("/usr/share/alsa/alsa.conf")


def sound_card(directory: Path, heard: np.ndarray | None = None) -> Mapping[str, str]:
    """The environment in which the default sound card plays into a file, and hears `heard`.

    The test declares the peer `portaudio`.
    """
    demand("portaudio")
    (np.zeros(0) if heard is None else heard).astype("<i2").tofile(directory / "heard.raw")
    path = directory / "asound.conf"
    path.write_text(
        f"""<{SYSTEM}>
pcm.!default {{
    type file
    slave.pcm "null"
    file "{directory}/played.raw"
    infile "{directory}/heard.raw"
    format "raw"
    truncate true
}}
"""
    )
    return {**os.environ, "ALSA_CONFIG_PATH": str(path)}


def silent_card(directory: Path) -> Mapping[str, str]:
    """The environment of a machine without any sound card."""
    path = directory / "asound.conf"
    path.write_text("pcm.!default { type empty }\n")  # PortAudio dies of a file without anything
    return {**os.environ, "ALSA_CONFIG_PATH": str(path)}


def equipped(cli: CommandLine, card: Mapping[str, str]) -> CommandLine:
    """The command on a machine with that sound card."""
    found = CommandLine(cli.home)
    found.environment |= {**cli.environment, "ALSA_CONFIG_PATH": card["ALSA_CONFIG_PATH"]}
    return found


def played(directory: Path) -> np.ndarray:
    """All samples that were played."""
    path = directory / "played.raw"
    return np.fromfile(path, "<i2") if path.exists() else np.zeros(0, "<i2")
