"""A random program: ports of several kinds, and what threads, tasks and signals do with them.

Rules: pure, and a function of the seed alone; nothing here opens a port. Every verb has a time
limit, or none where interrupting or closing the port has to end it.
"""

from __future__ import annotations

import random
from dataclasses import dataclass, field
from typing import Final, Literal, TypeAlias

Kind: TypeAlias = Literal["port", "strict", "latest", "callback", "server", "client"]

CARRIERS: Final = ("tcp", "fast_tcp", "udp", "memory", "unix_stream", "local")
DATA: Final[tuple[Kind, ...]] = ("port", "strict", "latest", "callback")
LIMITS: Final = (0.0, 0.002, 0.05, 0.3)
SIZES: Final = (1, 10, 1_000, 40_000, 400_000)
#: How often each verb comes; those on ports with messages, and those on clients and servers.
DATA_VERBS: Final = {
    "write": 30, "burst": 6, "read": 16, "poll": 4, "flush": 3, "connect": 8, "disconnect": 3,
    "listen_to": 2, "cut": 2, "wait_for_inputs": 1, "wait_for_outputs": 1, "interrupt": 2,
    "resume": 4, "close": 1, "open": 5, "stats": 1,
}  # fmt: skip
RPC_VERBS: Final = {
    "call": 24, "ask": 4, "tell": 4, "connect": 3, "disconnect": 1, "interrupt": 2, "resume": 4,
    "close": 1, "open": 5, "stats": 1,
}  # fmt: skip
RESUMED: Final = ("interrupt",)  # verbs after which the next one undoes them, mostly


@dataclass(frozen=True)
class Slot:
    """A place for a port: one at a time has this name."""

    name: str
    kind: Kind
    loop: bool  # an asyncio one
    reaction: str = ""  # what its callbacks do with the port itself, or another one


@dataclass(frozen=True)
class Step:
    """One operation on a port."""

    verb: str
    slot: int
    other: int = 0  # the port that it connects to
    timeout: float | None = None
    size: int = 1
    wait: bool = False
    signal: float = 0.0  # seconds after which a signal comes; 0.0: none
    action: str = "raise"  # what its handler does
    cancel: float | None = None  # seconds after which the task is cancelled
    pause: float = 0.0  # seconds before it


@dataclass(frozen=True)
class Actor:
    """Who does something: the main thread, another one, or a task of the loop."""

    kind: Literal["main", "thread", "task"]
    steps: tuple[Step, ...]


@dataclass(frozen=True)
class Program:
    """All that one seed says."""

    seed: int
    carrier: str
    slots: tuple[Slot, ...]
    actors: tuple[Actor, ...]
    forks: int = 0  # children that write to the sink
    exits: int = 0  # other programs that write to the sink and end without closing
    children: tuple[int, ...] = field(default=())  # messages of each of them

    def __str__(self) -> str:
        slots = "\n".join(f"  {index} {slot}" for index, slot in enumerate(self.slots))
        acts = "\n".join(
            f"  {actor.kind}\n" + "\n".join(f"    {step}" for step in actor.steps)
            for actor in self.actors
        )
        children = f"{self.forks} forks, {self.exits} exits: {self.children}"
        return f"seed {self.seed}: {self.carrier}, {children}\n{slots}\n{acts}"


def random_program(seed: int) -> Program:
    """Return the program of that seed."""
    dice = random.Random(seed)
    carrier = dice.choice(CARRIERS)
    slots = [_slot(dice, index) for index in range(dice.randint(2, 6))]
    if dice.random() < 0.5:
        loop = dice.random() < 0.4
        slots.append(Slot("/server", "server", loop, dice.choice(("", "", "slow", "call"))))
        slots.extend(
            Slot(f"/client{index}", "client", dice.random() < 0.4)
            for index in range(dice.randint(1, 2))
        )
    own = [index for index, slot in enumerate(slots) if not slot.loop]
    awaited = [index for index, slot in enumerate(slots) if slot.loop]
    actors = []
    if own:
        actors.append(Actor("main", _steps(dice, slots, own, signals=True, endings=False)))
        for _ in range(dice.randint(0, 3)):
            actors.append(Actor("thread", _steps(dice, slots, own)))
    if awaited:
        for _ in range(dice.randint(1, 4)):
            actors.append(Actor("task", _steps(dice, slots, awaited, cancels=True)))
    forks, exits = int(dice.random() < 0.06), int(dice.random() < 0.04)
    children = tuple(dice.choice((1, 50, 300)) for _ in range(forks + exits))
    return Program(seed, carrier, tuple(slots), tuple(actors), forks, exits, children)


def _slot(dice: random.Random, index: int) -> Slot:
    reaction = dice.choice(("", "", "", "connect", "disconnect", "write", "stats", "close"))
    return Slot(f"/data{index}", dice.choice(DATA), dice.random() < 0.3, reaction)


def _steps(
    dice: random.Random,
    slots: list[Slot],
    mine: list[int],
    signals: bool = False,
    cancels: bool = False,
    endings: bool = True,
) -> tuple[Step, ...]:
    """What one actor does with the ports `mine`: first some connections, then anything. With
    `endings`, somebody else ends what has no time limit."""
    steps = []
    signals = signals and dice.random() < 0.6
    for number in range(dice.randint(5, 60)):
        slot = dice.choice(mine)
        kind = slots[slot].kind
        verbs = DATA_VERBS if kind in DATA else RPC_VERBS
        if kind == "server":
            verbs = {"interrupt": 1, "resume": 4, "close": 1, "open": 4, "stats": 2}
        verb = dice.choices(tuple(verbs), tuple(verbs.values()))[0]
        if number < 3 and "connect" in verbs:
            verb = "connect"
        wanted = DATA if kind in DATA else ("server",)
        others = [index for index, one in enumerate(slots) if one.kind in wanted and index != slot]
        if not others:
            others = [slot]
        signal, cancel = 0.0, None
        if signals and dice.random() < 0.4:
            signal = dice.choice((0.0001, 0.0005, 0.002, 0.02))
        if cancels and dice.random() < 0.3:
            cancel = dice.choice((0.0, 0.0005, 0.005, 0.05))
        endless = endings and dice.random() < 0.1
        step = Step(
            verb,
            slot,
            dice.choice(others),
            None if endless else dice.choice(LIMITS),
            dice.choice(SIZES),
            dice.random() < 0.1,
            signal,
            dice.choices(("raise", "close", "interrupt"), (8, 1, 1))[0],
            cancel,
            dice.choice((0.0, 0.0, 0.0, 0.001, 0.01)),
        )
        steps.append(step)
        if verb in RESUMED and dice.random() < 0.9:
            steps.append(Step("resume", slot, pause=dice.choice((0.0, 0.02))))
        if verb == "close" and dice.random() < 0.7:
            steps.append(Step("open", slot))
            steps.append(Step("connect", slot, step.other, 0.3))
    return tuple(steps)
