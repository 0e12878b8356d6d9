"""`yarpy play FILE...`: send what was recorded again, from ports with the same names.

    yarpy play walk.mcap -r 0.5 --ports /icub/cam/left
    yarpy play walk.mcap --prefix /replay --start 10 --duration 5 -l

Names that live are never taken: --prefix or --rename plays beside them. On a terminal keys pause
(space), send the next message (s), jump (arrows: 5 s), change the rate (+ and -), play a range
again and again (l at its beginning, at its end, and to go on) and stop (q). Several files are
played on one time axis, bags of ROS among them. The port /play/rpc:i takes the words play, pause,
step, seek SECONDS, loop BEGIN END, rate N, status, stop, and some of those of C++ yarpdataplayer
(`yarpy rpc`).

Exit codes: 0 the end was reached, or somebody stopped it; 1 it cannot be played: damage has left no
message.
"""

from __future__ import annotations

import os
import queue
import sys
import threading
from typing import TYPE_CHECKING, Final

import click

from yarpy.cli import log
from yarpy.cli.output import print_line
from yarpy.cli.signals import Interrupted
from yarpy.cli.stderr import warn
from yarpy.errors import AddressError, LocalProtocolError
from yarpy.port.rpc import RpcServer
from yarpy.real_time import realtime

if TYPE_CHECKING:
    from yarpy.kits.record.commands import Commands
    from yarpy.kits.record.playback.player import Player

RPC: Final = "/play/rpc:i"
SWITCH: Final = 0.0005  # seconds that a thread of this program keeps others waiting, at most
JUMP: Final = 5.0  # seconds
PERIOD: Final = 0.2  # seconds between looks at the keys, and lines of progress


@click.command()
@click.argument("files", nargs=-1, required=True, metavar="FILE...")
@click.option("-r", "--rate", type=float, default=1.0, metavar="N", help="N times as fast.")
@click.option("-l", "--loop", is_flag=True, help="Begin again at the end.")
@click.option("--start", type=click.FloatRange(0), default=0.0, metavar="S",
              help="Leave out the first S seconds.")  # fmt: skip
@click.option("--duration", type=click.FloatRange(0, min_open=True), metavar="S",
              help="Play S seconds of it.")  # fmt: skip
@click.option("--ports", metavar="NAMES", help="Only these ports: /a,/b.")
@click.option("--rename", "renamed", multiple=True, metavar="OLD=NEW", help="Another name.")
@click.option("--prefix", default="", show_default=False, metavar="/P",
              help="Put this before the other names.")  # fmt: skip
@click.option("--as-node", "node", metavar="NODE",
              help="Publish topics with these names, as the node /NODE of ROS 1, "
              "ros2://NODE or ros2+dds://NODE of ROS 2.")  # fmt: skip
@click.option("--clock", is_flag=False, flag_value="/clock", default="", show_default=False,
              metavar="[PORT]", help="Send its time, from /clock or PORT.")  # fmt: skip
@click.option("--from", "mark", metavar="MARK", help="Begin at the mark with this note.")
@click.option("--wait", is_flag=True, help="Begin when every port is connected.")
@click.option("--name", default="", show_default=False, metavar="PORT",
              help="Where it is told what to do (/play/rpc:i).")  # fmt: skip
@click.option("-p", "--start-paused", "paused", is_flag=True, help="Begin with the space bar.")
def command(
    files: tuple[str, ...],
    rate: float,
    loop: bool,
    start: float,
    duration: float | None,
    ports: str | None,
    renamed: tuple[str, ...],
    prefix: str,
    node: str | None,
    clock: str,
    mark: str | None,
    wait: bool,
    name: str,
    paused: bool,
) -> int:
    """Send what FILEs have recorded again, each message in its time."""
    from yarpy.kits.record.commands import player_commands
    from yarpy.kits.record.playback.player import Player
    from yarpy.kits.record.playback.topic import checked_node
    from yarpy.kits.record.recording import open_recording

    live = sys.stdin.isatty() and sys.stderr.isatty()
    if not live:
        log.show()
    with realtime(switch_interval=SWITCH), open_recording(*files) as recording:
        player: Player | None = None
        ended = False
        try:
            player = Player(
                recording,
                None if ports is None else [name for name in ports.split(",") if name],
                rate=rate,
                loop=loop,
                start=start if mark is None else start + recording.mark(mark),
                duration=duration,
                rename=dict(map(parse_rename, renamed)),
                prefix=prefix,
                node="" if node is None else checked_node(node),
                clock=clock,
            )
            with player, open_rpc(name, player_commands(player)):
                if not wait or player.wait_for_readers():
                    ended = _steered(player, paused) if live else player.play(paused)
        except Interrupted:
            pass  # how a loop ends
        print_line("stopped before the start" if player is None else summary(player, ended))
        for damage in recording.damages:
            warn(damage)
        nothing = ended and player is not None and not player.played
        return 1 if nothing and recording.damages else 0


def open_rpc(name: str, commands: Commands) -> RpcServer:
    """Return the port that takes commands; by another name if several players run."""
    try:
        return RpcServer(name or RPC, commands)
    except AddressError:
        if name:
            raise
        return RpcServer(f"/play/{os.getpid()}/rpc:i", commands)


def parse_rename(text: str) -> tuple[str, str]:
    """Return both names of `/a=/b`. Raises LocalProtocolError."""
    old, equals, new = text.partition("=")
    if not (equals and old.startswith("/") and new.startswith("/")):
        raise LocalProtocolError(f'"{text}" does not rename a port: /old=/new')
    return old, new


def summary(player: Player, ended: bool) -> str:
    """Return the last line: how it ended, and what was played."""
    found = "the end" if ended else f"stopped at {player.position:.1f} s"
    dropped = f", {player.dropped} were not taken by their readers" if player.dropped else ""
    return (
        f"{found}: {player.played} messages{dropped}, late by {player.latest * 1e3:.1f} ms at most"
    )


def _steered(player: Player, paused: bool) -> bool:
    """Play with keys and a line of progress on a terminal."""
    from yarpy.platform.console import obey_escapes
    from yarpy.platform.keys import keys

    over, steering = threading.Event(), Keys(player)
    obey_escapes(sys.stderr)
    with keys() as pressed:

        def steer() -> None:
            while not over.is_set():
                sys.stderr.write(f"\r\x1b[K{progress(player)}")
                sys.stderr.flush()
                try:
                    key = pressed.get(timeout=PERIOD)
                    if key == "\x1b":  # of an arrow, which is three letters
                        key += pressed.get(timeout=PERIOD) + pressed.get(timeout=PERIOD)
                except queue.Empty:
                    continue
                steering.press(key)

        thread = threading.Thread(target=steer, name="yarpy play keys", daemon=True)
        thread.start()
        try:
            return player.play(paused)
        finally:
            over.set()
            thread.join()
            sys.stderr.write("\r\x1b[K")
            sys.stderr.flush()


def progress(player: Player) -> str:
    """Return the line of progress."""
    state = "paused " if player.paused else ""
    chosen = player.range
    between = f", {chosen[0]:.1f} to {chosen[1]:.1f} s again and again" if chosen else ""
    return (
        f"{state}{player.position:.1f} of {player.length:.1f} s  x{player.rate:g}  "
        f"{player.played} messages{between}   space s arrows l + - q"
    )


class Keys:
    """The keys. `l` is pressed at the beginning of a range, at its end, and to go on."""

    def __init__(self, player: Player) -> None:
        self._player = player
        self._begin: float | None = None  # of a range whose end is not known yet

    def press(self, key: str) -> None:
        """Do what a key stands for."""
        player = self._player
        if key == " ":
            if player.paused:
                player.resume()
            else:
                player.pause()
        elif key == "s":
            player.step()
        elif key == "l":
            self._loop()
        elif key in ("\x1b[C", "\x1b[D"):
            player.seek(player.position + (JUMP if key == "\x1b[C" else -JUMP))
        elif key in ("+", "="):
            player.rate = min(player.rate * 2, 1000.0)
        elif key == "-":
            player.rate = max(player.rate / 2, 0.001)
        elif key in ("q", "\x03", "\x04"):
            player.stop()

    def _loop(self) -> None:
        player = self._player
        if player.range is not None:
            player.end_range()
        elif self._begin is None:
            self._begin = player.position
        else:
            begin, end = sorted((self._begin, player.position))
            self._begin = None
            if begin < end:
                player.loop_range(begin, end)
