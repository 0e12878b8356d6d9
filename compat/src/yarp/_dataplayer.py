"""`yarpdataplayer --dataset FOLDER`, `yarpdataplayer-console`: play folders of yarpdatadumper.

    --dataset FOLDER   --name N (yarpdataplayer; --module_name N)   --add_prefix   --verbose
    --withExtraTimeCol N   --hidden, which it always is

Rules: the port `/N/rpc:i` (of the console always `/yarpdataplayer/rpc:i`) is told what to do, in
the words that `help` lists. All parts are on one time axis: `setFrame` means the frame of the first
one. At the end `getStatus` says `stopped`. Both programs end with `quit`. Names that live are not
taken: such a part is played to nobody, which is said.
"""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from inspect import signature
from typing import Any, Final, Literal, NoReturn

import yarpy
from yarp._log import print_lines
from yarpy.data.text import plain_text
from yarpy.kits import record

EXIT_USAGE: Final = 1
READER_TIMEOUT: Final = 0.5  # seconds that a reader may keep a message waiting, once
STRICT: Final = 10.0  # the same where nothing is to be lost
STEP: Final = 5.0  # seconds for the messages of a step
JUMP: Final = 5.0  # percent
SECOND: Final = 1_000_000_000  # nanoseconds

OK: Final = yarpy.Vocab("ok")
FAIL: Final = yarpy.Vocab("fail")


class DataPlayer:
    """A recording, and how far it is played. prefix: put before the names of ports. column: see
    `record.Dataset`. Methods answer as the words of the same names do."""

    def __init__(self, prefix: str = "", column: Literal[0, 1, 2] = 0) -> None:
        self._prefix = prefix
        self._column = column
        self._data: record.Dataset | None = None
        self._player: record.Player | None = None
        self._thread = threading.Thread()
        self._lock = threading.RLock()  # the end may come while somebody says something
        self._status = ""
        self._repeat = False
        self._strict = False
        self._rate = 1.0

    def _play(self, player: record.Player) -> None:
        """The thread of a data set."""
        while True:
            try:
                ended = player.play(paused=True)
            except (yarpy.YarpError, OSError) as error:
                _say(str(error))
                ended = True
            with self._lock:
                if not ended or self._player is not player:
                    return
                self._halt(player)

    def _halt(self, player: record.Player) -> None:
        player.pause()
        player.seek(0)
        self._status = "stopped"

    def load(self, path: str) -> bool:
        """Play another data set from now on."""
        self.close()
        try:
            data = record.Dataset(path, self._column)
            named = {name: f"{self._prefix}{part.port}" for name, part in data.parts.items()}
            player = record.Player(record.Recording([data]), rename=named, taken=_taken)
        except (yarpy.YarpError, OSError) as error:
            _say(str(error))
            return False
        for damage in data.damages:
            _say(f"{path}: {damage}")
        self._data, self._player, self._status = data, player, ""
        self.repeat(int(self._repeat))
        self.setStrict(int(self._strict))
        self.setSpeed(self._rate)
        self._thread = threading.Thread(target=self._play, args=(player,), daemon=True)
        self._thread.start()
        return True

    def close(self) -> None:
        """Close the ports."""
        with self._lock:
            player, self._player, self._data = self._player, None, None
        if player is not None:
            player.close()
            self._thread.join()

    def _loaded(self) -> tuple[record.Dataset, record.Player]:
        if self._data is None or self._player is None:
            raise ValueError("no data set is loaded")
        return self._data, self._player

    def play(self) -> bool:
        """Go on, or begin."""
        _, player = self._loaded()
        self._status = "playing"
        player.resume()
        return True

    resume = play

    def pause(self) -> bool:
        """Let time stand still."""
        _, player = self._loaded()
        player.pause()
        self._status = "paused"
        return True

    def stop(self) -> bool:
        """Go back to the beginning."""
        _, player = self._loaded()
        self._halt(player)
        return True

    def step(self) -> bool:
        """Send until each part that has not ended has sent one message more."""
        data, player = self._loaded()
        player.pause()
        self._status = "paused"
        nexts = {part: self.getFrame(part) for part in data.parts}
        ahead = [part for part in nexts if nexts[part] < data.parts[part].messages]
        if not ahead:
            return False
        moment = max(data.moment(part, nexts[part]) for part in ahead)
        ends = {part: data.frame(part, moment + 1) for part in ahead}
        for part in ahead:
            for _ in range(ends[part] - nexts[part]):
                player.step()
        deadline = time.monotonic() + STEP
        while any(self.getFrame(part) < ends[part] for part in ahead):
            if time.monotonic() > deadline:
                return False
            time.sleep(0.001)
        return True

    def setFrame(self, number: int) -> bool:
        """Go to a message of the first part, and to its time in the others."""
        data, player = self._loaded()
        part = next(iter(data.parts))
        player.seek((data.moment(part, int(number)) - player.begin) / SECOND)
        return True

    def getFrame(self, part: str) -> int:
        """Return the number of the next message of a part; -1 if there is no such part."""
        data, player = self._loaded()
        if part not in data.parts:
            return -1
        return data.frame(part, player.next_moment(part))

    def forward(self, percent: float = JUMP) -> bool:
        """Jump by so much of the whole."""
        _, player = self._loaded()
        position = player.position + player.length * float(percent) / 100
        if not 0 <= position <= player.length:
            return False
        player.seek(position)
        return True

    def backward(self, percent: float = JUMP) -> bool:
        """Jump back by so much of the whole."""
        return self.forward(-float(percent))

    def getAllParts(self) -> list[list[str]]:
        """Return the names of all parts, as one list."""
        return [[*self._loaded()[0].parts]]

    def enable(self, part: str) -> bool:
        """Send what is of a part again."""
        data, player = self._loaded()
        player.muted.discard(part)
        return part in data.parts

    def disable(self, part: str) -> bool:
        """Send nothing of a part; its time goes on."""
        data, player = self._loaded()
        if part not in data.parts:
            return False
        player.muted.add(part)
        return True

    def getPortName(self, part: str) -> str:
        """Return the port of a part."""
        data, player = self._loaded()
        return player.ports.get(part) or f"{self._prefix}{data.parts[part].port}"

    def setPortName(self, part: str, name: str) -> bool:
        """Send what is of a part from another port."""
        self._loaded()[1].rename(part, name)
        return True

    def setSpeed(self, speed: float) -> bool:
        """Set how many seconds of the recording pass in a second."""
        self._loaded()[1].rate = float(speed)
        self._rate = float(speed)
        return True

    def getSpeed(self) -> float:
        """Return how many seconds of the recording pass in a second."""
        return self._rate

    def repeat(self, on: int = 1) -> bool:
        """Begin again at the end, or do not."""
        self._repeat = _flag(on)
        with suppress(ValueError):
            self._loaded()[1].loop = self._repeat
        return True

    def setStrict(self, on: int = 1) -> bool:
        """Wait for readers that are slow, or do not."""
        self._strict = _flag(on)
        with suppress(ValueError):
            self._loaded()[1].reader_timeout = STRICT if self._strict else READER_TIMEOUT
        return True

    def getProgress(self) -> float:
        """Return how many percent were played."""
        _, player = self._loaded()
        if self._status == "stopped" or not player.length:
            return 0.0
        return 100 * player.position / player.length

    def getSliderPercentage(self) -> int:
        """Return how many percent were played, as a whole number."""
        return int(self.getProgress())

    def getStatus(self) -> str:
        """Return `playing`, `paused`, `stopped`, or nothing before the first `play`."""
        return self._status


WORDS: Final = (
    *("load", "play", "pause", "stop", "resume", "step", "setFrame", "getFrame", "forward"),
    *("backward", "getAllParts", "enable", "disable", "getPortName", "setPortName", "setSpeed"),
    *("getSpeed", "repeat", "setStrict", "getProgress", "getSliderPercentage", "getStatus"),
)


def answer(player: DataPlayer, request: yarpy.Bottle, quit: Callable[[], object]) -> yarpy.Bottle:
    """Return what the port says to some words."""
    word = plain_text(request[0]) if request else ""
    if word == "quit":
        quit()
        return yarpy.Bottle([OK])
    if word == "help":
        listed = ["*** Available commands:", *WORDS, "quit", "help"]
        return yarpy.Bottle([yarpy.Vocab("many"), *listed])
    if word not in WORDS:
        return yarpy.Bottle([FAIL])
    act: Callable[..., Any] = getattr(player, word)
    try:
        wanted = signature(act).parameters.values()
        texts = {n for n, one in enumerate(wanted) if one.annotation == "str"}
        given = [plain_text(x) if n in texts else x for n, x in enumerate(request[1:])]
        signature(act).bind(*given)
        found = act(*given)
    except (yarpy.YarpError, ValueError, TypeError, LookupError, OverflowError) as error:
        _say(f"{word}: {error}")
        return yarpy.Bottle([FAIL])
    if isinstance(found, bool):
        return yarpy.Bottle([OK if found else FAIL])
    return yarpy.Bottle(found if isinstance(found, list) else [found])


def _flag(value: object) -> bool:
    if value not in (0, 1):
        raise ValueError(f"{value!r} is neither 0 nor 1")
    return bool(value)


def _taken(part: str, error: yarpy.YarpError) -> None:
    _say(f"{part} is played to nobody: {error}; --add_prefix puts a name before it")


def _say(line: str) -> None:
    print(f"[WARNING] {line}", file=sys.stderr, flush=True)


class _Program(yarpy.Module):
    """The player as a program."""

    period = 1.0
    console = False

    def configure(self, resources: yarpy.ResourceFinder) -> bool:
        key = "module_name" if resources.check("module_name") else "name"
        name = plain_text(resources.find(key) or "yarpdataplayer").strip("/")
        self.name = ""  # its port is called otherwise
        extra = resources.check("withExtraTimeCol")
        late = extra and resources.find("withExtraTimeCol") == 2
        prefix = f"/{name}" if resources.check("add_prefix") else ""
        self.player = DataPlayer(prefix, 2 if late else 1 if extra else 0)
        port = "yarpdataplayer" if self.console else name
        self.port = yarpy.RpcServer(f"/{port}/rpc:i", self._answered, lock=True)
        dataset = plain_text(resources.find("dataset") or "")
        if dataset and not self.player.load(dataset):
            self.port.close()
            return False
        print(f"[INFO] {self.port.name} is told what to do: help, play, quit", flush=True)
        return True

    def _answered(self, message: yarpy.Message) -> yarpy.Bottle:
        return answer(self.player, message.as_(yarpy.Bottle), self._end)

    def _end(self) -> None:
        # From another thread, since the answer is still to leave.
        threading.Thread(target=self.stop, daemon=True).start()

    def close(self) -> None:
        self.port.close()
        self.player.close()


class _Console(_Program):
    """The player with the port of the console."""

    console = True


def _run(program: _Program) -> NoReturn:
    if {"-h", "--help"} & {*sys.argv[1:]}:
        print_lines([__doc__ or ""])
        sys.exit(0)
    try:
        sys.exit(program.run(yarpy.ResourceFinder(sys.argv[1:])))
    except (yarpy.YarpError, OSError) as error:
        print(f"error: yarpdataplayer: {error}", file=sys.stderr)
        sys.exit(EXIT_USAGE)


def main() -> NoReturn:
    """The program `yarpdataplayer`."""
    _run(_Program())


def console() -> NoReturn:
    """The program `yarpdataplayer-console`."""
    _run(_Console())
