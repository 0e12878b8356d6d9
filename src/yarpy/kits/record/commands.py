"""The commands that a recorder and a player are given over a port, and what each does.

    record   pause  resume  split  snapshot  mark [TEXT]  status  stop  help
    play     play  pause  resume  step  seek SECONDS  mark TEXT  rate N  loop [BEGIN END]  stop
             status  help

and those of C++ yarpdataplayer that mean something where parts are ports:

    getStatus  getProgress  getSliderPercentage  getSpeed  setSpeed N  forward [PERCENT]
    backward [PERCENT]  repeat [0|1]  setStrict [0|1]  getAllParts  enable PORT  disable PORT
    getPortName PORT  setPortName PORT NEW  quit

Rules: the answer is `[ok]` and what was asked for, or `[fail]` and why. Nobody can name a file.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from inspect import signature
from typing import Any, Final, TypeAlias

from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text
from yarpy.data.value import Vocab
from yarpy.errors import LocalProtocolError, UnknownName, YarpError
from yarpy.kits.record.capture.recorder import Recorder
from yarpy.kits.record.playback.player import READER_TIMEOUT, Player
from yarpy.wire.message import Message

Act: TypeAlias = Callable[..., object]

JUMP: Final = 5.0  # percent
STRICT: Final = 10.0  # seconds that a reader may keep a message waiting where nothing is to be lost


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


def flag(value: object) -> bool:
    """Return what 0 or 1 says. Raises LocalProtocolError."""
    if value not in (0, 1):
        raise LocalProtocolError(f"{value!r} is neither 0 nor 1")
    return bool(value)


def player_commands(player: Player) -> Commands:
    """Return what a player is told."""
    return Commands({**_player_words(player), **_words_of_cpp(player)})


def _player_words(player: Player) -> dict[str, Act]:

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

    def status() -> list[Any]:
        return [
            ["state", _state(player)],
            ["position", player.position],
            ["length", player.length],
            ["rate", player.rate],
            ["loop", [*(player.range or ())]],
            ["played", player.played],
            ["dropped", player.dropped],
        ]

    return {
        "play": player.resume,
        "resume": player.resume,
        "pause": player.pause,
        "step": player.step,
        "seek": seek,
        "mark": mark,
        "loop": loop,
        "rate": rate,
        "setSpeed": rate,
        "status": status,
        "stop": player.stop,
        "quit": player.stop,
    }


def _state(player: Player) -> str:
    return "paused" if player.paused else "playing"


def _words_of_cpp(player: Player) -> dict[str, Act]:
    def progress() -> float:
        return 100 * player.position / player.length if player.length else 100.0

    def forward(percent: float = JUMP) -> None:
        position = player.position + player.length * float(percent) / 100
        if not 0 <= position <= player.length:
            raise LocalProtocolError(f"{position:.1f} s is not within {player.length:.1f} s")
        player.seek(position)

    def backward(percent: float = JUMP) -> None:
        forward(-float(percent))

    def repeat(on: int = 1) -> None:
        player.loop = flag(on)

    def strict(on: int = 1) -> None:
        player.reader_timeout = STRICT if flag(on) else READER_TIMEOUT

    def known(port: object) -> str:
        found = plain_text(port)
        if found not in player.ports:
            raise UnknownName(f'"{found}" is not played: there are {" ".join(player.ports)}')
        return found

    def rename(port: str, new: str) -> None:
        player.rename(known(port), plain_text(new))

    return {
        "getStatus": lambda: _state(player),
        "getProgress": progress,
        "getSliderPercentage": lambda: int(progress()),
        "getSpeed": lambda: player.rate,
        "forward": forward,
        "backward": backward,
        "repeat": repeat,
        "setStrict": strict,
        "getAllParts": lambda: [[*player.ports]],
        "enable": lambda port: player.muted.discard(known(port)),
        "disable": lambda port: player.muted.add(known(port)),
        "getPortName": lambda port: player.ports[known(port)],
        "setPortName": rename,
    }
