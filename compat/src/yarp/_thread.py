"""Thread, PeriodicThread, RateThread and Semaphore: subclasses define `run`."""

from __future__ import annotations

import threading
import time
from typing import Self

import yarpy


class Thread:
    """Subclasses define `run`, and perhaps `threadInit`, `threadRelease` and `onStop`."""

    _runner: threading.Thread | None
    _ending: threading.Event

    def __new__(cls, *args: object, **values: object) -> Self:
        self = super().__new__(cls)
        self._runner = None
        self._ending = threading.Event()
        return self

    def run(self) -> None:
        """The work; it looks at `isStopping`."""

    def threadInit(self) -> bool:
        """Called first, in the thread; False: do not run."""
        return True

    def threadRelease(self) -> None:
        """Called last, in the thread."""

    def beforeStart(self) -> None:
        """Called by `start`."""

    def afterStart(self, success: bool) -> None:
        """Called by `start`, when `threadInit` has returned."""

    def onStop(self) -> None:
        """Called by `stop`: wake what `run` waits for."""

    def start(self) -> bool:
        """Run it in a thread."""
        self._ending.clear()
        self.beforeStart()
        begun: list[bool] = []
        ready = threading.Event()

        def body() -> None:
            begun.append(bool(self.threadInit()))
            ready.set()
            if begun[0]:
                self._work()
                self.threadRelease()

        self._runner = threading.Thread(target=body, name="yarp thread", daemon=True)
        self._runner.start()
        ready.wait()
        self.afterStart(begun[0])
        return begun[0]

    def _work(self) -> None:
        self.run()

    def stop(self) -> bool:
        """Ask it to end, and wait until it has."""
        self._ending.set()
        self.onStop()
        return self.join()

    def join(self, seconds: float = -1) -> bool:
        """Wait until it has ended."""
        runner = self._runner
        if runner is None or runner is threading.current_thread():
            return True
        runner.join(None if seconds < 0 else seconds)
        return not runner.is_alive()

    def isStopping(self) -> bool:
        return self._ending.is_set()

    def isRunning(self) -> bool:
        return self._runner is not None and self._runner.is_alive()

    def setPriority(self, priority: int, policy: int = -1) -> int:
        """Threads of Python share their time; `yarpy.realtime` is for the whole program."""
        return -1

    def getPriority(self) -> int:
        return 0

    def getPolicy(self) -> int:
        return 0

    def setOptions(self, stackSize: int = 0) -> None:
        """Stacks grow by themselves."""

    def getKey(self) -> int:
        return (self._runner.ident or 0) if self._runner is not None else 0

    @staticmethod
    def getKeyOfCaller() -> int:
        return threading.get_ident()

    @staticmethod
    def getCount() -> int:
        return threading.active_count()

    @staticmethod
    def setDefaultStackSize(stackSize: int) -> None:
        """Stacks grow by themselves."""

    @staticmethod
    def yield_c() -> None:
        time.sleep(0)


class PeriodicThread(Thread):
    """`run` is called every `period` seconds."""

    _scale = 1.0

    def __init__(self, period: float = 0.01) -> None:
        self._period = period * self._scale
        self._suspended = False
        self._iterations = 0
        self._used = 0.0

    def _work(self) -> None:
        while not self._ending.is_set():
            by = yarpy.clock.current()
            begun = by.monotonic()
            if not self._suspended:
                self.step()
            by.wait(self._ending, begun + self._period - by.monotonic())

    def step(self) -> None:
        """Call `run` once."""
        begun = time.monotonic()
        self.run()
        self._used += time.monotonic() - begun
        self._iterations += 1

    def askToStop(self) -> None:
        """Ask it to end, and do not wait."""
        self._ending.set()

    def suspend(self) -> None:
        self._suspended = True

    def resume(self) -> None:  # type: ignore[override,unused-ignore]
        self._suspended = False

    def isSuspended(self) -> bool:
        return self._suspended

    def getPeriod(self) -> float:
        return self._period

    def setPeriod(self, period: float) -> bool:
        self._period = period
        return True

    def getIterations(self) -> int:
        return self._iterations

    def getEstimatedPeriod(self) -> float:
        return self._period

    def getEstimatedUsed(self) -> float:
        return self._used / self._iterations if self._iterations else 0.0

    def resetStat(self) -> None:
        self._iterations, self._used = 0, 0.0


class RateThread(PeriodicThread):
    """The same in milliseconds, as it was called before."""

    _scale = 0.001

    def getRate(self) -> float:
        return self._period * 1000

    def setRate(self, p: float) -> bool:
        return self.setPeriod(p * 0.001)

    def getEstPeriod(self) -> float:
        return self._period * 1000

    def getEstUsed(self) -> float:
        return self.getEstimatedUsed() * 1000


class Semaphore:
    """`wait` until somebody says `post`."""

    def __init__(self, initialCount: int = 1) -> None:
        self._semaphore = threading.Semaphore(initialCount)

    def wait(self) -> None:
        self._semaphore.acquire()

    def waitWithTimeout(self, timeoutInSeconds: float) -> bool:
        return self._semaphore.acquire(timeout=max(0.0, timeoutInSeconds))

    def check(self) -> bool:
        return self._semaphore.acquire(blocking=False)

    def post(self) -> None:
        self._semaphore.release()
