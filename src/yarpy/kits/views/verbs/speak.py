"""`yarpy speak [PORT...] [--play FILE.wav]`: send a file, or what the microphone hears, to ports.

Opens a port, connects it to each PORT, and sends sound as fast as it is to be heard, in pieces with
stamps. Without PORT it begins when somebody connects.
Exit codes: 0 the file was sent; 1 it cannot be, or there is no audio; otherwise until a signal.
"""

from __future__ import annotations

import time
from collections.abc import Iterable
from itertools import chain

import click

import yarpy
from yarpy.cli.ports import open_port, send_to

NAME = "/speak"
LEAD = 0.2  # seconds that are sent ahead, so that nobody runs dry


@click.command()
@click.argument("ports", nargs=-1)
@click.option("--play", "path", metavar="FILE", help="Send this WAV file, not the microphone.")
@click.option("--name", default=NAME, metavar="PORT", help="The port to open.")
@click.option("--carrier", metavar="C", help="How PORTS are connected (tcp).")
@click.option(
    "--frequency", type=click.IntRange(1), default=16000, show_default=True, metavar="HZ",
    help="Samples per second of the microphone.",
)  # fmt: skip
@click.option(
    "--channels", type=click.IntRange(1, 64), default=1, show_default=True, metavar="N",
    help="Channels of the microphone.",
)  # fmt: skip
@click.option(
    "--yarp", "version", type=click.Choice(["3.5", "3.9", "3.10", "4.0"]), default="3.9",
    show_default=True, help="The YARP that is to understand it; yarpy understands all.",
)  # fmt: skip
def command(
    ports: tuple[str, ...],
    path: str | None,
    name: str,
    carrier: str | None,
    frequency: int,
    channels: int,
    version: str,
) -> int:
    """Send a WAV file, or what the microphone hears, to PORTS.

    Without PORTS it waits until somebody connects.
    """
    from yarpy.kits.devices.hardware.audio import record
    from yarpy.kits.views.wav import read_wav

    sounds = (
        read_wav(path)
        if path is not None
        else record(frequency, channels, instead="send a file: --play FILE.wav")
    )
    try:
        first = next(sounds, None)  # so that what is wrong with it is told before anybody listens
    except ValueError as error:
        raise click.ClickException(str(error)) from error
    if first is None:
        raise click.ClickException(f"{path} is empty")
    with open_port(yarpy.Port, name) as port:
        for target in ports:
            send_to(port, target, carrier or "")
        if not ports:
            port.wait_for_outputs()
        send(port, chain([first], sounds), version, paced=path is not None)
        port.flush()
    return 0


def send(port: yarpy.Port, sounds: Iterable[yarpy.Sound], version: str, paced: bool) -> None:
    """Write sounds with stamps; `paced`: at the time at which they are to be heard."""
    started = time.monotonic()
    passed = 0.0
    for count, sound in enumerate(sounds):
        if paced:
            time.sleep(max(0.0, started + passed - LEAD - time.monotonic()))
        value = sound if version == "3.9" else sound.to_bottle(version)
        port.write(value, yarpy.Stamp(count, time.time()))
        passed += sound.length / sound.frequency
