"""Three hosts out of network namespaces, for the experiments with a slow link: a publisher, a
subscriber, and between them a switch whose two links are shaped (tbf, with pfifo_fast inside).

Rules: Linux, root and iproute2. Programs are functions of the experiment's own file, started in a
host by name: `FILE --as NAME` runs them, and the first line that they print is `ready`.
"""

import contextlib
import ctypes
import os
import subprocess
import sys
import time
from collections.abc import Iterator

PORT = 10000  # of the name server
SERVER = "10.78.1.1"
NETWORKS = {"switch": None, "pub": "10.78.1", "sub": "10.78.2"}


class Hosts:
    """The three namespaces, and the programs in them. `file`: the experiment's."""

    def __init__(self, file: str, mbit: float) -> None:
        self._stack = contextlib.ExitStack()
        self._prefix = f"q{os.getpid() % 10000}"
        self._file = file
        self._devices: list[tuple[str, str]] = []
        self._names = {host: f"{self._prefix}{host}" for host in NETWORKS}
        self._mbit = mbit

    def __enter__(self) -> "Hosts":
        os.environ.pop("YARPY_BIND", None)  # these hosts have to reach each other
        try:
            self._build()
        except BaseException:
            self._stack.close()
            raise
        return self

    def _build(self) -> None:
        names = self._names
        for name in names.values():
            run("ip", "netns", "add", name)
            self._stack.callback(run, "ip", "netns", "del", name, check=False)
            run("ip", "-n", name, "link", "set", "lo", "up")
        for host, network in NETWORKS.items():
            if network is None:
                continue
            near, far = f"{self._prefix}{host}s", f"{self._prefix}{host}h"
            run("ip", "link", "add", near, "netns", names["switch"], "type", "veth",
                "peer", "name", far, "netns", names[host])  # fmt: skip
            for where, device, number in ((names["switch"], near, 1), (names[host], far, 2)):
                run("ip", "-n", where, "addr", "add", f"{network}.{number}/24", "dev", device)
                run("ip", "-n", where, "link", "set", device, "up")
                self._devices.append((where, device))
            run("ip", "-n", names[host], "route", "add", "default", "via", f"{network}.1")
        self.inside("switch", "sysctl", "-q", "-w", "net.ipv4.ip_forward=1")
        self.shape(self._mbit, "add")

    def shape(self, mbit: float, how: str = "change") -> None:
        """The rate of all links, with the queue that Linux has by default."""
        for where, device in self._devices:
            tc = ("tc", "-n", where, "qdisc", how, "dev", device)
            shape = ("rate", f"{mbit}mbit", "burst", "32kb", "latency", "200ms")
            run(*tc, "root", "handle", "1:", "tbf", *shape)
            if how == "add":
                run(*tc, "parent", "1:1", "handle", "10:", "pfifo_fast")

    def inside(self, host: str, *words: str) -> None:
        """Run a command in a host."""
        run("ip", "netns", "exec", self._names[host], *words)

    def start(self, host: str, program: str, *words: str) -> subprocess.Popen:
        """A program of the experiment in a host, once it is ready."""
        process = self.spawn(host, sys.executable, self._file, "--as", program, *words)
        if process.stdout.readline().strip() != "ready":
            raise SystemExit(f"{program} did not start")
        return process

    def spawn(self, host: str, *words: str) -> subprocess.Popen:
        """Any program in a host; it ends with the hosts."""
        process = subprocess.Popen(
            ["ip", "netns", "exec", self._names[host], *words],
            env={**os.environ, "YARPY_SERVER": f"{SERVER}:{PORT}"},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self._stack.callback(end, process)
        return process

    def carried(self, host: str) -> int:
        """Bytes that the switch has sent to a host."""
        device = f"/sys/class/net/{self._prefix}{host}s/statistics/tx_bytes"
        words = ["ip", "netns", "exec", self._names["switch"], "cat", device]
        return int(subprocess.run(words, capture_output=True, check=True, timeout=20).stdout)

    @contextlib.contextmanager
    def entered(self) -> Iterator[None]:
        """This thread on the switch, where the name server can be reached."""
        home = os.open("/proc/self/ns/net", os.O_RDONLY)
        there = os.open(f"/run/netns/{self._names['switch']}", os.O_RDONLY)
        setns(there)
        os.environ["YARPY_SERVER"] = f"{SERVER}:{PORT}"
        try:
            yield
        finally:
            setns(home)
            os.close(there)
            os.close(home)

    def __exit__(self, *_: object) -> None:
        self._stack.close()


def run(*words: str, check: bool = True) -> None:
    """Run a command; its error ends the program."""
    done = subprocess.run(words, capture_output=True, text=True, timeout=20)
    if check and done.returncode:
        raise SystemExit(f"{' '.join(words)}: {done.stderr.strip()} (this needs root and iproute2)")


def end(process: subprocess.Popen) -> None:
    """End a program that was started here."""
    process.terminate()
    with contextlib.suppress(subprocess.TimeoutExpired):
        process.wait(5)
        return
    process.kill()
    process.wait(5)


def setns(handle: int) -> None:
    """`os.setns` is new in Python 3.12."""
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.setns(handle, 0x40000000):
        raise OSError(ctypes.get_errno(), "setns")


@contextlib.contextmanager
def hogs(count: int) -> Iterator[None]:
    """Processes that want the processor for themselves."""
    busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(count)]
    try:
        yield
    finally:
        for process in busy:
            end(process)


def ask(process: subprocess.Popen, what: object) -> str:
    """Write a line to a program, and read one."""
    process.stdin.write(f"{what}\n")
    process.stdin.flush()
    return process.stdout.readline()


def say(text: str) -> None:
    """To whoever watches."""
    print(text, file=sys.stderr, flush=True)


def serve_names() -> None:
    """A name server on the switch, until its input ends."""
    import yarpy

    with yarpy.NameServer(PORT, SERVER):
        print("ready", flush=True)
        sys.stdin.read()


class Idle:
    """How idle this computer was: a context, and then `percent`."""

    def __enter__(self) -> "Idle":
        self._before = _jiffies()
        self._began = time.monotonic()
        return self

    def __exit__(self, *_: object) -> None:
        idle, whole = (b - a for a, b in zip(self._before, _jiffies(), strict=True))
        self.percent = 100 * idle / max(whole, 1)


def _jiffies() -> tuple[int, int]:
    with open("/proc/stat", encoding="utf-8") as file:
        numbers = [int(word) for word in file.readline().split()[1:9]]
    return numbers[3] + numbers[4], sum(numbers)
