"""Random histories of what takes a clock, on a clock of the test's own, beside simple models."""

from __future__ import annotations

import asyncio
import math

from hypothesis import given
from hypothesis import strategies as st

from yarpy.aio.thread import Turn
from yarpy.data.stamp import Stamp
from yarpy.link.timing import DAYTIME, Timing
from yarpy.monitors.event import Events
from yarpy.qos import Qos
from yarpy.transports.pace import BURST, RATE, Pace
from yarpy.wire.message import DATA, Message

OWNERS = st.sampled_from(("a", "b", "c"))
NAMES = st.sampled_from(("grasp", "look"))
PAUSES = st.sampled_from((0.0, 0.01, 0.5, 1.0, 3.0))
HISTORY = st.lists(
    st.one_of(
        st.tuples(st.just("set"), OWNERS, NAMES, st.sampled_from((None, -1.0, 0.0, 0.5, 1.0, 2.0))),
        st.tuples(st.just("unset"), OWNERS, NAMES),
        st.tuples(st.just("clear"), OWNERS),
        st.tuples(st.just("pass"), PAUSES),
    ),
    max_size=40,
)


class Clock:
    """Time that passes when it is told to."""

    def __init__(self) -> None:
        self.now = 2 * DAYTIME

    def __call__(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.now += seconds


@given(HISTORY)
def test_events_last_as_long_as_one_of_their_owners_says(history):
    clock = Clock()
    events, model = Events(clock), {}
    for act, *what in history:
        if act == "set":
            owner, name, lifetime = what
            events.set(owner, name, lifetime)
            forever = lifetime is None or lifetime < 0
            model[owner, name] = math.inf if forever else clock.now + lifetime
        elif act == "unset":
            events.unset(*what)
            model.pop(tuple(what), None)
        elif act == "clear":
            events.clear(*what)
            model = {key: end for key, end in model.items() if key[0] != what[0]}
        else:
            clock.sleep(what[0])
        for name in ("grasp", "look"):
            wanted = any(end > clock.now for (_, one), end in model.items() if one == name)
            assert events.has(name) == wanted


@given(
    st.lists(st.tuples(PAUSES, st.sampled_from((0.0, 0.2, 5.0)), st.booleans()), max_size=40),
    st.sampled_from((0.1, 1.0)),
    st.sampled_from((None, 0.5, 2.0)),
    st.booleans(),
)
def test_each_late_message_counts_once_and_each_silence_once(history, deadline, rate, drop):
    clock, told = Clock(), []
    qos = Qos(deadline=deadline, rate=rate, late="drop" if drop else None)
    timing = Timing(qos, lambda late, silent: told.append((late, silent)), clock, clock)
    late = dropped = silences = 0
    for pause, age, look in history:
        clock.sleep(pause)
        if look:
            before = timing.missed
            timing.look()
            timing.look()  # the same silence
            silences += timing.missed - before
            assert timing.missed - before <= 1
        message = Message(DATA, b"", Stamp(1, clock.now - age).to_text().encode())
        is_late = age > deadline
        late += is_late
        dropped += is_late and drop
        assert timing.accept(message) == (not (is_late and drop))
    found = timing.as_dict()
    assert (found["missed"], found["dropped"]) == (late + silences, dropped)
    assert len(told) == timing.missed
    assert all(lateness > 0 for lateness, _ in told)
    assert rate is not None or not silences


@given(
    st.lists(st.tuples(st.integers(1, BURST), PAUSES), max_size=60), st.sampled_from((0.0, 0.005))
)
def test_receiver_of_datagrams_never_has_more_waiting_than_a_burst(history, overslept):
    clock = Clock()
    clock.now = 100.0  # a smaller number, which keeps microseconds
    pace = Pace(clock, lambda seconds: clock.sleep(seconds + overslept))
    waiting, read_until = 0.0, clock.now
    for size, pause in history:
        clock.sleep(pause / 1000)
        pace.wait(size)
        waiting = max(0.0, waiting - (clock.now - read_until) * RATE) + size
        read_until = clock.now
        assert waiting <= BURST + 1


@given(st.lists(st.tuples(st.sampled_from(("wait", "cancel", "release")), st.integers(0, 9))))
def test_turn_belongs_to_one_at_a_time_in_the_order_of_the_calls(history):
    async def main():
        turn, tasks, order = Turn(), [], []

        async def take(number):
            await turn.wait()
            order.append(number)

        async def settle():
            for _ in range(4):
                await asyncio.sleep(0)

        released = 0
        for act, number in history:
            if act == "wait":
                tasks.append(asyncio.create_task(take(len(tasks))))
                await asyncio.sleep(0)
            elif act == "cancel" and tasks:
                tasks[number % len(tasks)].cancel()
            elif released < len(order):
                turn.release()
                released += 1
            assert len(order) - released <= 1
        await settle()
        while released < len(order):
            turn.release()
            released += 1
            await settle()
        assert order == sorted(order)
        assert set(order) == {n for n, task in enumerate(tasks) if not task.cancelled()}
        assert turn.take()

    asyncio.run(main())
