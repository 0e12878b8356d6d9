"""The commands that a recorder and a player are given over a port, and what each does.

    record   pause  resume  split  snapshot  mark [TEXT]  status  stop  help
    play     play  pause  resume  step  seek SECONDS  mark TEXT  rate N  loop [BEGIN END]  stop
             status  help

and, of C++ yarpdataplayer, `getStatus`, `getProgress`, `getSpeed`, `setSpeed N`, `quit`.

Rules: the answer is `[ok]` and what was asked for, or `[fail]` and why. Nobody can name a file.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from inspect import signature
from typing import Any, TypeAlias

from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text
from yarpy.data.value import Vocab
from yarpy.errors import YarpError
from yarpy.kits.record.capture.recorder import Recorder
from yarpy.kits.record.playback.player import Player
from yarpy.wire.message import Message

Act: TypeAlias = Callable[..., object]


class Commands:
    """Answers messages by a table of commands: what a function returns follows `[ok]`."""

    def __init__(self, table: Mapping[str, Act]) -> None:
        self._table: dict[str, Act] = {**table, "help": self._help}

    def _help(self) -> list[str]:
        return sorted(self._table)

    def __call__(self, message: Message) -> Bottle:
        try:
            said = message.as_(Bottle)
        except YarpError as error:
            return _failed(str(error))
        word = plain_text(said[0]) if said else ""
        act = self._table.get(word)
        if act is None:
            return _failed(f"no word {word[:100]!r}: there are {' '.join(sorted(self._table))}")
        wanted = signature(act).parameters.values()
        words = any(one.kind is one.VAR_POSITIONAL for one in wanted)
        least = 0 if words else sum(one.default is one.empty for one in wanted)
        if len(said) - 1 < least or not (words or len(said) - 1 <= len(wanted)):
            return _failed(" ".join([word, *(one.name.upper() for one in wanted)]))
        try:
            found = act(*said[1:])
        except (YarpError, ValueError, TypeError, OverflowError) as error:
            return _failed(str(error))
        if found is None:
            return Bottle([Vocab("ok")])
        return Bottle([Vocab("ok"), *(found if isinstance(found, list) else [found])])


def _failed(why: str) -> Bottle:
    return Bottle([Vocab("fail"), why])


def _line(words: Iterable[object]) -> str:
    """Return a text that was said with or without quotes."""
    return " ".join(map(plain_text, words))


def recorder_commands(recorder: Recorder, stop: Callable[[], object]) -> Commands:
    """Return what a recorder is told; `stop` ends it."""

    def mark(*text: object) -> None:
        recorder.mark(_line(text))

    def end() -> None:
        stop()

    def status() -> list[Any]:
        counts = sorted(recorder.counts.items())
        return [
            ["state", recorder.state],
            ["messages", recorder.messages],
            ["bytes", recorder.size],
            ["lost", recorder.lost],
            ["files", [*map(str, recorder.files)]],
            ["ports", [[name, count.messages, count.lost] for name, count in counts]],
            ["waiting", recorder.waiting],
        ]

    return Commands(
        {
            "pause": recorder.pause,
            "resume": recorder.resume,
            "split": recorder.split,
            "snapshot": lambda: recorder.snapshot(),
            "mark": mark,
            "status": status,
            "stop": end,
            "quit": end,
        }
    )


def player_commands(player: Player) -> Commands:
    """Return what a player is told."""

    def rate(n: float) -> None:
        player.rate = float(n)

    def seek(seconds: float) -> None:
        player.seek(float(seconds))

    def mark(*text: object) -> None:
        player.seek_mark(_line(text))

    def loop(begin: float | None = None, end: float | None = None) -> None:
        if begin is None:
            player.end_range()
        else:
            player.loop_range(float(begin), player.length if end is None else float(end))

    def state() -> str:
        return "paused" if player.paused else "playing"

    def status() -> list[Any]:
        return [
            ["state", state()],
            ["position", player.position],
            ["length", player.length],
            ["rate", player.rate],
            ["loop", [*(player.range or ())]],
            ["played", player.played],
            ["dropped", player.dropped],
        ]

    return Commands(
        {
            "play": player.resume,
            "resume": player.resume,
            "pause": player.pause,
            "step": player.step,
            "seek": seek,
            "mark": mark,
            "loop": loop,
            "rate": rate,
            "setSpeed": rate,
            "getSpeed": lambda: player.rate,
            "getStatus": state,
            "getProgress": lambda: (
                100 * player.position / player.length if player.length else 100.0
            ),
            "status": status,
            "stop": player.stop,
            "quit": player.stop,
        }
    )
