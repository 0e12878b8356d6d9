"""The demo: a name server, a talker that publishes this computer's load, and a listener.

    make demo

It prints what to try in another terminal. Ctrl-C ends it; `--seconds N` lets it end by itself.
"""

import argparse
import os
import shutil
import sys
import threading
import time
from contextlib import suppress
from pathlib import Path

import yarpy

TRY = """
A YARP name server runs at {server}. In another terminal, try:

  {yarpy} name list
  {yarpy} read /demo/view /machine/load
  echo cpu | {yarpy} rpc /machine/rpc

or, without any YARP:

  {{ echo CONNECT me; echo r; cat; }} | nc {talker}
  printf 'CONNECT me\\nd\\nhelp\\nd\\nload\\nq\\n' | nc {rpc}
  echo hello there | nc {rpc}

C++ YARP finds this server after `yarp conf {where}`. Ctrl-C ends it all.
"""


class Machine:
    """What this computer is doing: from /proc where there is one, else what Python knows."""

    def __init__(self) -> None:
        self._ticks = cpu_ticks()

    def state(self) -> dict[str, object]:
        """The load average over a minute; cpu and memory in use, in percent."""
        state: dict[str, object] = {}
        if hasattr(os, "getloadavg"):
            state["load"] = round(os.getloadavg()[0], 2)
        before, self._ticks = self._ticks, cpu_ticks()
        if before and self._ticks[0] > before[0]:
            total, idle = (now - then for now, then in zip(self._ticks, before, strict=True))
            state["cpu"] = round(100 * (1 - idle / total))
        with suppress(OSError, KeyError):
            lines = Path("/proc/meminfo").read_text().splitlines()
            sizes = {key: int(rest.split()[0]) for key, rest in (x.split(":") for x in lines)}
            state["memory"] = round(100 * (1 - sizes["MemAvailable"] / sizes["MemTotal"]))
        return state

    def answer(self, message: yarpy.Message) -> object:
        """The reply to `load`, `cpu`, `memory`; anything else is told what there is."""
        state, words = self.state(), message.as_(list)
        known = words and words[0] in state
        return [state[words[0]]] if known else [yarpy.Vocab("many"), *state]


def cpu_ticks() -> tuple[int, ...]:
    """All ticks of all processors so far, and the idle ones among them; () without /proc."""
    with suppress(OSError):
        ticks = [int(word) for word in Path("/proc/stat").read_text().split()[1:9]]
        return sum(ticks), ticks[3] + ticks[4]
    return ()


def talk(port: yarpy.BufferedPort, period: float = 0.5) -> None:
    machine, stamp = Machine(), yarpy.Stamp()
    with suppress(yarpy.PortClosed):
        while True:
            time.sleep(period)
            stamp = stamp.next(time.time())
            port.write(machine.state(), stamp)


def main(seconds: float) -> None:
    end = time.monotonic() + seconds
    with (
        yarpy.NameServer() as server,
        yarpy.BufferedPort("/machine/load") as talker,
        yarpy.RpcServer("/machine/rpc", Machine().answer, lock=True) as rpc,
        yarpy.Port("/demo/listener") as listener,
    ):
        where, *ports = (each.address.replace(":", " ") for each in (server, talker, rpc))
        beside = Path(sys.executable).with_name("yarpy")
        command = "yarpy" if shutil.which("yarpy") else os.path.relpath(beside)
        run = f"YARPY_SERVER={server.address} {command}"
        print(
            TRY.format(server=server.address, where=where, yarpy=run, talker=ports[0], rpc=ports[1])
        )
        talker.connect(listener.name)
        threading.Thread(target=talk, args=(talker,), daemon=True).start()
        while time.monotonic() < end:
            message = listener.read(timeout=5)
            words = " ".join(f"{key} {value}" for key, value in message.as_(dict).items())
            print(f"{message.stamp.count:5} {message.source}: {words}", flush=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="A name server, a talker and a listener.")
    parser.add_argument("--seconds", type=float, default=float("inf"), help="end by itself")
    with suppress(KeyboardInterrupt):
        main(parser.parse_args().seconds)
