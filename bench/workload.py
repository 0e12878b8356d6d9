"""What is measured, how often, and what yarpy wants to reach.

Rules: every peer carries the same information (an integer and a float, 1 kB, or a 1 MiB image) in
the way that is natural for it, packs it anew for each message and looks into what it received.
Runs under CPython 3.10 too, because the C++ peer does.
"""

from dataclasses import dataclass, replace

READERS = 50
KILOBYTE_TEXT = "x" * 1000
NUMBER = 1.5


@dataclass(frozen=True)
class Workload:
    """`count` samples of `unit` per round after `warmup` that are thrown away.

    `cores` is 2 where the client and the server have a processor core each: every message wakes a
    sleeping core up, as on a robot that has time to spare. It is 1 where they share one: then only
    work and thread switches count. Left to the system, placement changes from run to run and with
    it the result, by a factor of ten.

    `pause` is what the client waits before each exchange, as a control loop does. Without it both
    sides are asked again within microseconds, and one that looks for the next message for a while
    before it sleeps shows its best; with it everybody has gone to sleep.
    """

    function: str
    """What the peers call it; two workloads may differ in the cores alone."""
    title: str
    unit: str
    warmup: int
    count: int
    cores: int = 2
    pause: float = 0.0  # seconds
    side: int = 1024
    """Pixels of the square, mono images, if there are any: 1 MiB."""

    @property
    def more_is_better(self) -> bool:
        return self.unit == "messages/s"

    def quick(self) -> "Workload":
        return replace(self, warmup=max(self.warmup // 2, 5), count=max(self.count // 5, 20))


_STREAM = Workload("stream", "small message there and back, two streams", "us", 500, 4000)
_RPC = Workload("rpc", "small request and its reply, one connection", "us", 500, 4000)
_LARGE = Workload("large", "1 MiB image there and back, two streams", "us", 30, 200)

WORKLOADS = {
    "stream": _STREAM,
    "stream-paced": replace(_STREAM, warmup=50, count=400, pause=0.002),
    "stream-1-core": replace(_STREAM, cores=1),
    "rpc": _RPC,
    "rpc-paced": replace(_RPC, warmup=50, count=400, pause=0.002),
    "rpc-1-core": replace(_RPC, cores=1),
    "large": _LARGE,
    "large-1-core": replace(_LARGE, cores=1),
    "large-8": replace(
        _LARGE, title="8 MiB image there and back, two streams", warmup=10, count=50, side=2896
    ),
    "flood": Workload(
        "flood", "small messages one way, until the last is read", "messages/s", 2000, 30000
    ),
    "fan": Workload("fan", f"1 kB to {READERS} readers, until all have read it", "us", 30, 200),
}


@dataclass(frozen=True)
class Goal:
    """`peer` shall need at most (or, for a rate, reach at least) `factor` times `against`,
    in every workload that asks for `function`; `processor`: of the processor's time."""

    function: str
    peer: str
    against: str
    factor: float
    processor: bool = False

    @property
    def title(self) -> str:
        """What is compared, for people."""
        return f"{self.peer} / {self.against}" + ", processor time" * self.processor


GOALS = (
    Goal("stream", "yarpy-tcp", "raw", 1.3),
    Goal("stream", "yarpy-tcp", "zmq", 1.0),
    Goal("stream", "yarpy-tcp", "zenoh", 1.0),
    Goal("stream", "yarpy-tcp", "cpp-tcp", 0.75),
    Goal("stream", "yarpy-tcp", "cpp-latency-test", 0.75),
    Goal("stream", "yarpy-spin", "raw", 1.0),
    Goal("rpc", "yarpy-tcp", "cpp-tcp", 0.7),
    Goal("rpc", "yarpy-tcp", "cpp-latency-test", 0.7),
    Goal("large", "yarpy-tcp", "cpp-tcp", 0.9),
    Goal("large", "yarpy-tcp", "raw", 1.2),
    Goal("stream", "yarpy-memory", "raw", 1.0),
    Goal("stream", "yarpy-memory-spin", "raw", 0.3),
    Goal("large", "yarpy-memory", "raw", 0.3),
    Goal("large", "yarpy-memory", "cpp-tcp", 0.35),
    Goal("stream", "yarpy-tls", "yarpy-tcp", 1.3),
    Goal("rpc", "yarpy-tls", "yarpy-tcp", 1.3),
    Goal("large", "yarpy-tls", "yarpy-tcp", 2.0),
    Goal("flood", "yarpy-tcp", "cpp-tcp", 15.0),
    Goal("flood", "yarpy-fast_tcp", "cpp-fast_tcp", 3.0),
    Goal("fan", "yarpy-fast_tcp", "cpp-fast_tcp", 0.5),
    Goal("stream", "yarpy-zmq", "zmq", 1.3),
    Goal("flood", "yarpy-zmq", "zmq", 0.3),
    Goal("stream", "yarpy-zenoh", "zenoh-router", 1.15),
    Goal("rpc", "yarpy-zenoh", "zenoh-router", 1.15),
    Goal("large", "yarpy-zenoh", "zenoh-router", 1.15),
    Goal("stream", "compat-tcp", "cpp-tcp", 0.6),
    Goal("stream", "compat-fast_tcp", "cpp-fast_tcp", 0.6),
    Goal("rpc", "compat-tcp", "cpp-tcp", 0.6),
    Goal("flood", "compat-tcp", "cpp-tcp", 2.0),
    Goal("flood", "compat-fast_tcp", "cpp-fast_tcp", 2.0),
    *(
        Goal(function, f"yarpy-{carrier}", f"cpp-{carrier}", 1.0, processor=True)
        for function in ("stream", "rpc", "flood")
        for carrier in ("tcp", "fast_tcp")
    ),
)
