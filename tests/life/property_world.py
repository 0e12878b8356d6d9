"""Carries out a random program in this process, and judges what came of it.

Rules: the program that is tested is all of yarpy in this process; who judges knows only what was
written, what was read, and the counters. A judgement names what is wrong in a line of its own.
"""

from __future__ import annotations

import asyncio
import faulthandler
import gc
import json
import os
import signal
import subprocess
import sys
import threading
import time
import traceback
from collections import Counter
from collections.abc import Callable
from typing import Any, Final

from property_program import DATA, Program, Slot, Step

import yarpy
from yarpy import aio

MARGIN: Final = 20.0  # seconds beyond its limit that an operation may take on a loaded machine
SETTLING: Final = 6.0  # seconds for threads and descriptors to go
SERVICES: Final = ("yarpy accept", "yarpy reconnect", "yarpy aio")  # of the process, not of ports
CHILD: Final = """
import sys, yarpy
port = yarpy.Port("/exit", names=yarpy.LocalNames())
port.connect(sys.argv[1], sys.argv[3])
for number in range(int(sys.argv[2])):
    assert port.write(["/exit", 0, number, b""]) == 1
sys.exit(3)
"""


class Interruption(Exception):
    """What a signal raises."""


class Life:
    """One port of a slot, from opening to closing, and what is known of its messages."""

    def __init__(self, slot: Slot, number: int) -> None:
        self.slot = slot
        self.number = number
        self.port: Any = None
        self.taken = 0  # (message, connection) that `write` says were taken
        self.raised = 0  # writes that ended in an exception, at any moment
        self.got = 0  # messages that came to the program
        self.reacted = 0
        self.unsure = 0  # reads that ended in an exception that was not theirs

    @property
    def sync(self) -> Any:
        """The port itself, also of an asyncio one."""
        return self.port._port if self.slot.loop else self.port


class World:
    """The ports of a program and everything that happens to them."""

    def __init__(self, program: Program) -> None:
        self.program = program
        self.names = yarpy.LocalNames()
        self.wrong: list[str] = []
        self.lives: list[Life] = []
        self.now: list[Life | None] = [None] * len(program.slots)
        self.changing = [threading.Lock() for _ in program.slots]
        self.ending = False
        self.operations: Counter[str] = Counter()
        self.seen: dict[tuple[str, str], int] = {}  # the newest number by reader and stream
        self.seeing = threading.Lock()
        self.depth = threading.local()  # of callbacks in callbacks, each with writes of its own
        self.handled: Counter[str] = Counter()  # questions, by what they say
        self.numbers = iter(range(1, 1 << 60))
        self.inside: dict[int, tuple[str, float]] = {}  # who is in which operation, until when

    def fail(self, text: str) -> None:
        """Something is wrong."""
        self.wrong.append(text)

    # -- what comes in ----------------------------------------------------------------------------

    def came(self, life: Life, message: Any, reader: int = 0) -> None:
        """A message came to the program: is it newer than those before it on its stream?

        `reader`: who of several took it, each of whom gets what it gets in order.
        """
        if message is None:
            return
        life.got += 1
        value = message.value
        if len(value) != 4:
            self.fail(f"{life.slot.name}: {value!r} from {message.source}, which nobody wrote")
            return
        writer, stream, number, _ = value
        key = (f"{life.slot.name}.{life.number}.{reader}", f"{writer}.{stream}")
        with self.seeing:
            before = self.seen.get(key, -1)
            if number <= before:
                self.fail(f"{key}: {number} came after {before}")
            self.seen[key] = max(before, number)

    def react(self, life: Life, event: object = None) -> None:
        """What a callback does, with the port that calls it and with others."""
        reaction = life.slot.reaction
        if not reaction or self.ending or life.port is None or life.reacted > 20:
            return
        life.reacted += 1  # a connection that makes connections would do so for ever
        other = self.program.slots[0].name
        depth = self.depth.__dict__.setdefault("now", 0)
        self.depth.now = depth + 1
        try:
            if reaction == "connect" and other != life.slot.name:
                life.sync.connect(other, self.program.carrier, 0.0)
            elif reaction == "disconnect":
                life.sync.disconnect(other)
            elif reaction == "stats":
                assert life.sync.stats.name
            elif reaction == "close" and life.got == 20:
                life.sync.close()
            elif reaction == "write":
                self.write(life, life.sync.write, Step("write", 0, timeout=0.002))
        except yarpy.YarpError:
            pass
        finally:
            self.depth.now = depth

    # -- opening and closing ----------------------------------------------------------------------

    def make(self, life: Life) -> Any:
        """A port for a life, open if it is not of the loop."""
        slot, names = life.slot, self.names
        module: Any = aio if slot.loop else yarpy

        def hear(message: Any) -> None:
            self.came(life, message)
            if not slot.loop:
                self.react(life)

        def connected(event: object) -> None:
            if not slot.loop:
                self.react(life, event)

        if slot.kind == "server":
            return module.RpcServer(slot.name, self.answer_soon if slot.loop else self.answer,
                                    names=names)  # fmt: skip
        if slot.kind == "client":
            return module.RpcClient("", name=slot.name, names=names)
        options: dict[str, Any] = {"names": names, "on_connection": connected}
        if slot.kind == "callback":
            options["callback"] = hear
        if slot.kind in ("port", "callback"):
            return module.Port(slot.name, **options)
        return module.BufferedPort(slot.name, strict=slot.kind == "strict", **options)

    def answer(self, message: Any) -> object:
        """The handler of a server."""
        question = message.value
        if not isinstance(question, list) or len(question) != 2:
            return ["?"]
        with self.seeing:
            self.handled[str(question[1])] += 1
        if self.slow:
            time.sleep(0.03)
        return ["answer", question[1]]

    async def answer_soon(self, message: Any) -> object:
        """The handler of a server in the loop."""
        if self.slow:
            await asyncio.sleep(0.03)
        slow, self.slow = self.slow, False
        try:
            return self.answer(message)
        finally:
            self.slow = slow

    slow = False

    def open(self, index: int) -> None:
        """Open the port of a slot, unless there is one."""
        with self.changing[index]:
            life = self.now[index]
            if self.ending or (life is not None and not life.port.closed):
                return
            life = self.born(index)
            life.port = self.make(life)
            self.now[index] = life
            if self.ending:  # since a moment, and whoever closes all has not seen it
                self.close(life)

    async def open_soon(self, index: int) -> None:
        """The same for one of the loop."""
        life = self.now[index]
        if self.ending or (life is not None and not life.port.closed):
            return
        life = self.born(index)
        life.port = self.make(life)
        self.now[index] = life
        await life.port.open()

    def born(self, index: int) -> Life:
        life = Life(self.program.slots[index], len(self.lives))
        self.lives.append(life)
        return life

    # -- operations -------------------------------------------------------------------------------

    def value(self, life: Life, size: int) -> list[object]:
        """The next message of this thread; of a callback in it, which may come in the middle of
        another write."""
        stream = f"{threading.get_ident() ^ id(life)}.{getattr(self.depth, 'now', 0)}"
        return [life.slot.name, stream, next(self.numbers), b"x" * size]

    def write(self, life: Life, write: Callable[..., int], step: Step) -> None:
        """Write one message, or several in a burst."""
        for _ in range(40 if step.verb == "burst" else 1):
            value = self.value(life, step.size if step.verb == "write" else 10)
            life.raised += 1
            try:
                took = write(value, wait=step.wait, timeout=step.timeout)
            except yarpy.PortClosed:
                raise
            life.raised -= 1
            life.taken += took

    def perform(self, step: Step) -> None:
        """Carry out one step with a port of threads."""
        index = step.slot
        if step.verb == "open":
            self.open(index)
            return
        life = self.now[index]
        if life is None or life.port is None:
            return
        port, verb, limit = life.port, step.verb, step.timeout
        target = self.program.slots[step.other].name
        data = life.slot.kind in DATA
        if verb in ("write", "burst"):
            self.write(life, port.write, step)
        elif verb in ("read", "poll"):
            life.unsure += 1
            try:
                message = port.read(limit) if verb == "read" else port.poll()
                self.came(life, message, threading.get_ident())
            except (yarpy.Timeout, yarpy.PortClosed):
                life.unsure -= 1
                raise
            life.unsure -= 1
        elif verb == "connect":
            carrier = self.program.carrier if data else "tcp"
            port.connect(target, carrier, min(limit or 0.0, 0.3))
        elif verb in ("call", "ask"):
            self.check(verb, next(self.numbers), lambda ask: port.ask(ask, limit))
        elif verb == "tell":
            port.tell(["tell"])
        elif verb == "cut":
            for connection in port.outputs + port.inputs:
                connection.close()
        elif verb in ("disconnect", "listen_to"):
            getattr(port, verb)(target)
        elif verb in ("flush", "wait_for_inputs", "wait_for_outputs"):
            getattr(port, verb)(timeout=0.3 if limit is None else limit)
        elif verb == "stats":
            assert port.stats.name == life.slot.name
        else:
            getattr(port, verb)()

    def check(self, verb: str, number: int, ask: Callable[[object], Any]) -> None:
        """Ask, and see that the answer is that of this question."""
        self.judge_answer(number, ask([verb, number]))

    def judge_answer(self, number: int, answer: Any) -> None:
        if answer is None or not len(answer.value) or str(answer.value[0]) == "fail":
            return  # its server was closing
        if list(answer.value) != ["answer", number]:
            self.fail(f"question {number} was answered by {answer.value!r}")

    async def perform_soon(self, step: Step) -> None:
        """Carry out one step with a port of the loop."""
        index = step.slot
        if step.verb == "open":
            await self.open_soon(index)
            return
        life = self.now[index]
        if life is None or life.port is None or life.port._port is None:
            return
        port, verb, limit = life.port, step.verb, step.timeout
        target = self.program.slots[step.other].name
        if verb in ("write", "burst"):
            for _ in range(40 if verb == "burst" else 1):
                value = self.value(life, step.size if verb == "write" else 10)
                value[1] = 0  # all tasks are one stream: they write in the order of their calls
                life.raised += 1
                took = await port.write(value, wait=step.wait, timeout=limit)
                life.raised -= 1
                life.taken += took
        elif verb == "read":
            self.came(life, await port.read(limit), id(asyncio.current_task()))
        elif verb == "poll":
            self.came(life, port.poll(), id(asyncio.current_task()))
        elif verb == "connect":
            carrier = self.program.carrier if life.slot.kind in DATA else "tcp"
            await port.connect(target, carrier, min(limit or 0.0, 0.3))
        elif verb in ("call", "ask"):
            number = next(self.numbers)
            self.judge_answer(number, await port.ask([verb, number], limit))
        elif verb == "tell":
            await port.tell(["tell"])
        elif verb == "cut":
            for connection in port.outputs + port.inputs:
                await asyncio.to_thread(connection.close)
        elif verb in ("disconnect", "listen_to"):
            await getattr(port, verb)(target)
        elif verb in ("flush", "wait_for_inputs", "wait_for_outputs"):
            await getattr(port, verb)(timeout=0.3 if limit is None else limit)
        elif verb == "stats":
            assert port.stats.name == life.slot.name
        elif verb == "close":
            await port.close()
        else:
            getattr(port, verb)()

    # -- actors -----------------------------------------------------------------------------------

    def begin(self, step: Step) -> int:
        """Note that an operation begins, and until when it may take."""
        self.operations[step.verb] += 1
        key = next(self.numbers)
        endless = step.timeout is None and step.verb in ("read", "write", "burst", "call", "ask")
        limit = 6.0 if step.timeout is None else 5.0 + step.timeout * 41  # connecting: 5 s
        until = float("inf") if endless and not self.ending else time.monotonic() + limit + MARGIN
        self.inside[key] = (str(step), until)
        return key

    def end(self, key: int) -> None:
        self.inside.pop(key)

    def unexpected(self, step: Step, error: BaseException) -> None:
        lines = "".join(traceback.format_exception(error))
        self.fail(f"{step} raises {type(error).__name__}: {error}\n{lines}")

    def act(self, steps: tuple[Step, ...]) -> None:
        """One thread's steps."""
        for step in steps:
            if step.pause:
                time.sleep(step.pause)
            key = self.begin(step)
            try:
                self.perform(step)
            except yarpy.YarpError:
                pass
            except Exception as error:
                self.unexpected(step, error)
            finally:
                self.end(key)

    def act_with_signals(self, steps: tuple[Step, ...]) -> None:
        """The main thread's steps: a signal may come in any of them."""
        armed: list[Step] = []

        def ring(*_: object) -> None:
            if not armed:
                return
            step = armed.pop()
            if step.action == "raise":
                raise Interruption
            life = self.now[step.slot]
            if life is None or life.port is None or life.slot.loop:
                return
            try:
                getattr(life.port, step.action)()
            except yarpy.YarpError as error:
                self.unexpected(step, error)

        before = signal.signal(signal.SIGALRM, ring)
        try:
            for step in steps:
                if step.pause:
                    time.sleep(step.pause)
                key = self.begin(step)
                try:
                    try:
                        if step.signal and step.verb != "open":
                            armed.append(step)
                            signal.setitimer(signal.ITIMER_REAL, step.signal)
                        self.perform(step)
                    finally:
                        armed.clear()
                        signal.setitimer(signal.ITIMER_REAL, 0.0)
                except (yarpy.YarpError, Interruption):
                    pass
                except Exception as error:
                    self.unexpected(step, error)
                finally:
                    self.end(key)
        finally:
            signal.signal(signal.SIGALRM, before)

    async def act_soon(self, steps: tuple[Step, ...]) -> None:
        """One task's steps."""
        for step in steps:
            await asyncio.sleep(step.pause)
            key = self.begin(step)
            try:
                async with asyncio.timeout(step.cancel):
                    await self.perform_soon(step)
            except (yarpy.YarpError, TimeoutError):
                pass
            except Exception as error:
                self.unexpected(step, error)
            finally:
                self.end(key)

    def run_loop(self, tasks: list[tuple[Step, ...]], over: threading.Event) -> None:
        """The thread of the loop."""

        async def main() -> None:
            slots = self.program.slots
            for index, slot in enumerate(slots):
                if slot.loop:
                    await self.open_soon(index)
            self.opened.set()
            running = [asyncio.create_task(self.act_soon(steps)) for steps in tasks]
            while not over.is_set() and not all(task.done() for task in running):
                await asyncio.sleep(0.02)
            if not over.is_set():
                await asyncio.to_thread(over.wait)
            closing = [life.port.close() for life in self.lives if life.slot.loop and life.port]
            await asyncio.gather(*closing)
            for task in running:
                task.cancel()
            await asyncio.gather(*running, return_exceptions=True)

        try:
            asyncio.run(main())
        except BaseException as error:
            self.fail(f"the loop ends with {error!r}")
        finally:
            self.opened.set()

    # -- the whole of it --------------------------------------------------------------------------

    def run(self) -> None:
        """Carry the program out, and close everything."""
        program = self.program
        self.slow = any(slot.reaction == "slow" for slot in program.slots)
        self.opened = threading.Event()
        over = threading.Event()
        sink = self.sink() if program.children else None
        for index, slot in enumerate(program.slots):
            if not slot.loop:
                self.open(index)
        threads = []
        tasks = [actor.steps for actor in program.actors if actor.kind == "task"]
        if tasks:
            threads.append(threading.Thread(target=self.run_loop, args=(tasks, over), name="loop"))
            threads[0].start()
            if not self.opened.wait(MARGIN):
                self.fail("the ports of the loop did not open")
        children = [] if sink is None else self.start_children(sink)
        for actor in program.actors:
            if actor.kind == "thread":
                thread = threading.Thread(target=self.act, args=(actor.steps,), name="actor")
                thread.start()
                threads.append(thread)
        for actor in program.actors:
            if actor.kind == "main":
                self.act_with_signals(actor.steps)
        for child in children:
            child()
        self.ending = True
        over.set()
        for life in [*self.lives]:
            if not life.slot.loop and life.port is not None:
                self.close(life)
        deadline = time.monotonic() + 3 * MARGIN
        for thread in threads:
            thread.join(max(0.0, deadline - time.monotonic()))
            if thread.is_alive():
                self.fail(f"{thread.name} does not end after everything was closed: {self.stuck()}")
        for life in [*self.lives]:
            if life.port is not None and life.sync is not None and not life.port.closed:
                life.sync.close()

    def stuck(self) -> str:
        frames = sys._current_frames()
        names = {thread.ident: thread.name for thread in threading.enumerate()}
        return "\n" + "\n".join(
            f"--- {names.get(ident)}\n{''.join(traceback.format_stack(frame))}"
            for ident, frame in frames.items()
        )

    def close(self, life: Life) -> None:
        key = next(self.numbers)
        self.inside[key] = (f"closing {life.slot.name}", time.monotonic() + MARGIN)
        life.port.close()
        del self.inside[key]

    # -- other processes --------------------------------------------------------------------------

    def sink(self) -> Life:
        """A port that takes what other processes write, open until the end."""
        life = Life(Slot("/sink", "callback", False), 0)
        life.port = yarpy.BufferedPort(
            "/sink", names=self.names, callback=lambda message: self.came(life, message)
        )
        self.lives.append(life)
        return life

    def start_children(self, sink: Life) -> list[Callable[[], None]]:
        program = self.program
        carrier = program.carrier if program.carrier != "local" else "tcp"
        where = f"/{sink.port.address}"
        ends: list[Callable[[], None]] = []
        for number, count in enumerate(program.children):
            self.operations["fork" if number < program.forks else "exit"] += 1
            start = self.fork if number < program.forks else self.exit
            ends.append(start(where, count, carrier, sink))
        return ends

    def fork(self, where: str, count: int, carrier: str, sink: Life) -> Callable[[], None]:
        """A forked child that writes with a port of its own."""
        inlet, outlet = os.pipe()
        inherited = [life.port for life in self.lives if life.port is not None]
        child = os.fork()
        if child == 0:
            code = 1
            try:
                # Not `dump_traceback_later`: it waits for the thread of the parent's, which is
                # not here. The signal's handler says where the child hangs, and then it dies.
                signal.signal(signal.SIGALRM, signal.SIG_DFL)
                faulthandler.register(signal.SIGALRM, chain=True)
                signal.alarm(30)
                for port in inherited:
                    try:
                        port.port.stats if hasattr(port, "open") else port.interrupt()
                    except yarpy.YarpError:
                        pass
                with yarpy.Port("/forked", names=yarpy.LocalNames()) as port:
                    port.connect(where, carrier)
                    took = sum(port.write(["/forked", 0, number, b""]) for number in range(count))
                os.write(outlet, json.dumps([took, port.stats.past.outputs.as_dict()]).encode())
                code = 0
            except BaseException:
                traceback.print_exc()
            finally:
                os._exit(code)
        os.close(outlet)

        def end() -> None:
            with open(inlet, "rb") as report:
                found = report.read()
            status = os.waitpid(child, 0)[1]
            if status or not found:
                self.fail(f"the forked child ends with {status}")
                return
            took, past = json.loads(found)
            self.judge_child("/forked", took, int(past["unconfirmed"]), sink)

        return end

    def exit(self, where: str, count: int, carrier: str, sink: Life) -> Callable[[], None]:
        """Another program that ends without closing anything."""
        command = [sys.executable, "-c", CHILD, where, str(count), carrier]
        child = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)

        def end() -> None:
            _, errors = child.communicate(timeout=60)
            if child.returncode != 3:
                self.fail(f"the other program ends with {child.returncode}: {errors}")
            self.judge_child("/exit", count, 0, sink)

        return end

    def judge_child(self, name: str, took: int, unsure: int, sink: Life) -> None:
        """Whether everything came that a child has written."""
        key = (f"/sink.{sink.number}.0", f"{name}.0")
        deadline = time.monotonic() + MARGIN
        lossy = self.program.carrier == "udp"
        while self.seen.get(key, -1) + 1 < took and time.monotonic() < deadline:
            time.sleep(0.01)
        if not (self.seen.get(key, -1) + 1 >= took - unsure or lossy):
            self.fail(f"{name} wrote {took}, {self.seen.get(key, -1) + 1} came")

    # -- the judgement ----------------------------------------------------------------------------

    def judge(self) -> None:
        """Sent = delivered + counted; and every question was heard once."""
        for question, times in self.handled.items():
            if times > 1:
                self.fail(f"question {question} was handled {times} times")
        out: Counter[str] = Counter()
        into: Counter[str] = Counter()
        taken = raised = 0
        for life in self.lives:
            if life.slot.kind not in DATA or life.sync is None or life.slot.name == "/sink":
                continue
            stats = life.sync.stats.as_dict()
            ours = [*stats["outputs"], stats["past"]["outputs"]]
            theirs = [*stats["inputs"], stats["past"]["inputs"]]
            sent: Counter[str] = Counter()
            for part in ours:
                sent.update({name: int(part[name]) for name in SUMS})
            came: Counter[str] = Counter()
            for part in theirs:
                came.update({name: int(part[name]) for name in SUMS})
            out.update(sent)
            into.update(came)
            taken, raised = taken + life.taken, raised + life.raised
            counted = sum(sent.values())
            if life.taken > counted:
                self.fail(f"{life.slot.name}: {life.taken} were taken, {dict(sent)} are counted")
            least = life.got + came["drops"] + came["replaced"]
            most = least + life.unsure
            if not least <= came["messages"] <= most:
                self.fail(
                    f"{life.slot.name}: {came['messages']} came, {life.got} were read and "
                    f"{dict(came)} are counted, {life.unsure} unsure"
                )
        if self.program.carrier in CERTAIN and into["messages"] < out["messages"]:
            self.fail(f"{dict(out)} were sent, {dict(into)} came")
        # Over udp what is not known to have come counts as a drop.
        perhaps = raised + (out["drops"] if self.program.carrier == "udp" else 0)
        if into["messages"] > out["messages"] + out["unconfirmed"] + perhaps:
            self.fail(f"{dict(out)} were sent, {perhaps} perhaps, {dict(into)} came: too many")


#: Whose writers know what came.
CERTAIN: Final = ("tcp", "fast_tcp", "memory", "unix_stream", "local")
SUMS: Final = ("messages", "drops", "replaced", "unconfirmed")


def descriptors() -> dict[str, str]:
    """What each descriptor of this process is."""
    found = {}
    for number in os.listdir("/proc/self/fd"):
        try:
            found[number] = os.readlink(f"/proc/self/fd/{number}")
        except OSError:
            pass  # that of the list itself
    return found


def threads() -> list[str]:
    """The threads that belong to ports."""
    return [
        thread.name
        for thread in threading.enumerate()
        if thread is not threading.main_thread()
        and not thread.name.startswith(SERVICES)
        and thread.name != "property watch"
    ]


def watch(world: World, give_up: Callable[[World], object], over: threading.Event) -> None:
    """See that no operation takes longer than it may; else `give_up`."""
    while not over.wait(0.5):
        for text, until in tuple(world.inside.values()):
            if time.monotonic() > until:
                world.fail(f"hangs: {text}{world.stuck()}")
                give_up(world)
                return


def live(program: Program, give_up: Callable[[World], object]) -> World:
    """Carry out a program, and judge it. `wrong` says what is not as it should be. `give_up` is
    called in a thread where it hangs."""
    before = len(descriptors()), threads()
    world = World(program)
    over = threading.Event()
    watcher = threading.Thread(target=watch, args=(world, give_up, over), name="property watch")
    watcher.start()
    world.run()
    over.set()
    watcher.join()
    deadline = time.monotonic() + SETTLING
    while threads() != before[1] or len(descriptors()) > before[0]:
        if time.monotonic() > deadline:
            break
        gc.collect()
        time.sleep(0.01)
    world.judge()
    rest = [name for name in threads() if name not in before[1]]
    if rest:
        world.fail(f"threads are left: {rest} {world.stuck()}")
    if len(descriptors()) > before[0]:
        world.fail(f"descriptors are left, {before[0]} before: {descriptors()}")
    return world
