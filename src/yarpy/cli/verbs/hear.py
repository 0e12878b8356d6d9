"""`yarpy hear [PORT] [--record FILE.wav]`: hear what a port says, or keep it in a file.

Opens a port that takes sound, asks PORT to send to it, and plays what comes with the loudspeaker of
this machine, or records it. What comes faster than it can be played is left out.

Differs from C++ yarphear: no keys; recording goes into the file at once.
Exit codes: 0 also when ^C ends it; 1 the port cannot be opened, or there is no audio.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack

import click

import yarpy
from yarpy.cli.output import print_line
from yarpy.cli.ports import open_port
from yarpy.cli.signals import Interrupted
from yarpy.cli.source import Source
from yarpy.cli.stderr import complain, warn

NAME = "/hear"
LATE = 0.5  # seconds that the loudspeaker may be behind


@click.command()
@click.argument("port", required=False)
@click.option("--record", "path", metavar="FILE", help="Write a WAV file instead of playing.")
@click.option("--name", default=NAME, metavar="PORT", help="The port to open.")
@click.option("--carrier", metavar="C", help="How PORT is connected (tcp).")
@click.option(
    "--duration", type=click.FloatRange(0, min_open=True), metavar="S",
    help="End after so many seconds of sound.",
)  # fmt: skip
def command(
    port: str | None, path: str | None, name: str, carrier: str | None, duration: float | None
) -> int:
    """Play what PORT says, or record it.

    Without PORT it waits for whoever connects.
    """
    from yarpy.views.audio import Speaker
    from yarpy.views.wav import WavWriter

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
        try:
            heard = follow(sounds(listener, late=LATE if file is None else None), take, duration)
        except Interrupted:
            heard = file.seconds if file is not None else 0.0
        if file is not None:
            print_line(
                f"{file.path}: {heard:.2f} s, channels: {file.channels}, "
                f"samples a second: {file.frequency}"
            )
    return 0


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


def sounds(port: yarpy.BufferedPort, late: float | None) -> Iterator[yarpy.Sound]:
    """What comes, without that which is no sound or, with `late`, would be played too late."""
    skipped = 0
    refused: set[str] = set()
    for message in port:
        try:
            sound = message.as_(yarpy.Sound)
            if sound.frequency <= 0 or not sound.channels:
                raise yarpy.DecodeError(f"{sound} cannot be heard")
        except yarpy.DecodeError as error:
            if message.source not in refused:
                refused.add(message.source)
                complain(f"what {message.source} sends is no sound: {error}")
            continue
        if late is not None and port.waiting * sound.length > late * sound.frequency:
            skipped += 1
            continue
        if skipped:
            warn(f"{skipped} messages were left out: they came faster than they can be played")
            skipped = 0
        yield sound
