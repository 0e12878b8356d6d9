"""`yarpy hear [PORT] [--record FILE.wav]`: hear what a port says, or keep it in a file.

Opens a port that takes sound, asks PORT to send to it, and plays what comes with the loudspeaker of
this machine, or records it. What comes faster than it can be played is left out.

Differs from C++ yarphear: no keys; recording goes into the file at once.
Exit codes: 0 also when ^C ends it; 1 the port cannot be opened, there is no audio, or `--duration`
was given and no sound came for ten seconds more than that.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from math import inf
from time import monotonic
from typing import Final

import click

import yarpy
from yarpy.cli.output import print_line
from yarpy.cli.ports import open_port
from yarpy.cli.signals import Interrupted
from yarpy.cli.source import Source
from yarpy.cli.stderr import complain, warn

NAME = "/hear"
LATE = 0.5  # seconds that the loudspeaker may be behind
LATENESS: Final = 10.0  # seconds that a sound may be later than the duration asked for


@click.command()
@click.argument("port", required=False)
@click.option("--record", "path", metavar="FILE", help="Write a WAV file instead of playing.")
@click.option("--name", default=NAME, metavar="PORT", help="The port to open.")
@click.option("--carrier", metavar="C", help="How PORT is connected (tcp).")
@click.option(
    "--duration", type=click.FloatRange(0, min_open=True), metavar="S",
    help="End after so many seconds of sound; with an error if none comes for 10 seconds more.",
)  # fmt: skip
def command(
    port: str | None, path: str | None, name: str, carrier: str | None, duration: float | None
) -> int:
    """Play what PORT says, or record it.

    Without PORT it waits for whoever connects.
    """
    from yarpy.kits.devices.hardware.audio import Speaker
    from yarpy.kits.views.wav import WavWriter

    silence = None if duration is None else duration + LATENESS
    code = 0
    with ExitStack() as stack:
        file = stack.enter_context(WavWriter(path)) if path is not None else None
        if file is not None:
            take: Callable[[yarpy.Sound], None] = file.write
        else:
            speaker = Speaker(instead="keep it in a file: --record FILE.wav")
            stack.callback(speaker.close)
            take = speaker.play
        listener = stack.enter_context(open_port(yarpy.BufferedPort, name, "-", strict=True))
        if port is not None:
            Source(listener, port, carrier, lambda line: warn(line) if line else None)
        late = LATE if file is None else None
        try:
            follow(sounds(listener, late, silence), take, duration)
        except Interrupted:
            pass
        except yarpy.Timeout:
            complain(f"no sound came for {silence:g} s")
            code = 1
        if file is not None:
            print_line(
                f"{file.path}: {file.seconds:.2f} s, channels: {file.channels}, "
                f"samples a second: {file.frequency}"
            )
    return code


def follow(
    found: Iterator[yarpy.Sound], take: Callable[[yarpy.Sound], None], duration: float | None
) -> float:
    """Hand on sounds until they last for `duration`; how many seconds they were."""
    heard = 0.0
    for sound in found:
        try:
            take(sound)
        except ValueError as error:
            complain(str(error))
            continue
        heard += sound.length / sound.frequency
        if duration is not None and heard >= duration:
            break
    return heard


def sounds(
    port: yarpy.BufferedPort, late: float | None, silence: float | None = None
) -> Iterator[yarpy.Sound]:
    """Yield the sounds that arrive, without other messages and, with `late`, without those that
    would be played later than that. Raises Timeout after so many seconds of `silence`."""
    skipped = 0
    refused: set[str] = set()
    until = inf if silence is None else monotonic() + silence
    while True:
        try:
            message = port.read(timeout=None if until == inf else max(until - monotonic(), 0.0))
        except yarpy.PortClosed:
            return
        try:
            sound = message.as_(yarpy.Sound)
            if sound.frequency <= 0 or not sound.channels:
                raise yarpy.DecodeError(f"{sound} cannot be heard")
        except yarpy.DecodeError as error:
            if message.source not in refused:
                refused.add(message.source)
                complain(f"what {message.source} sends is no sound: {error}")
            if monotonic() > until:
                raise yarpy.Timeout("nothing that came was a sound") from None
            continue
        if silence is not None:
            until = monotonic() + silence
        if late is not None and port.waiting * sound.length > late * sound.frequency:
            skipped += 1
            continue
        if skipped:
            warn(f"{skipped} messages were left out: they came faster than they can be played")
            skipped = 0
        yield sound
