"""Real time: what a busy Python thread does to a round trip, and what helps.

    python examples/realtime.py

Needs no name server. Threads of one Python program take turns, 5 ms each while they compute.
`yarpy.realtime()` makes the turns shorter. With a priority the calling thread gets SCHED_FIFO too,
which needs root or CAP_SYS_NICE. (`spin=True`, not shown, is for a reader with a core to itself.)
"""

import statistics
import threading
import time

import yarpy

names = yarpy.LocalNames()
done = threading.Event()


def round_trips(label: str) -> None:
    """Send to an answering port and back, and say how long that took."""
    took = []
    with (
        yarpy.Port("/echo", names=names, callback=lambda it: echo.write(it.value)) as echo,
        yarpy.Port("/me", names=names) as me,
    ):
        me.connect("/echo")
        echo.connect("/me")
        for number in range(100):
            start = time.perf_counter()
            me.write([number])
            me.read(timeout=5)
            took.append(1000 * (time.perf_counter() - start))
    print(f"{label:28} mean {statistics.mean(took):7.3f} ms, longest {max(took):7.3f} ms")


def compute() -> None:
    number = 0
    while not done.is_set():
        number += 1


if __name__ == "__main__":
    round_trips("alone")
    threading.Thread(target=compute).start()
    try:
        round_trips("beside a busy thread")
        with yarpy.realtime():
            round_trips("the same, yarpy.realtime()")
        with yarpy.realtime(priority=10):
            round_trips("the same, SCHED_FIFO")
    except yarpy.LocalProtocolError as error:
        print("SCHED_FIFO:", error)
    finally:
        done.set()
