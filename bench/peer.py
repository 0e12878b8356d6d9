"""The two sides every peer program has:  peer_x.py server|client WORKLOAD

A peer is a table of small functions, two per workload. A server function opens its end, calls
`ready(**address)` and serves until it is killed. A client function finds that address in
`options.at` and returns the exchange to be timed:
    exchange(index)   sends message `index` and returns when its answer is there, or
    burst(count)      (flood) sends messages count-1 ... 0 and returns when 0 was answered,
or, for programs that time themselves, the list of samples.
Both sides print one line of JSON. Runs under CPython 3.10 too.
"""

import argparse
import gc
import json
import os
import time


def ready(**address):
    """Tell the client's side how to reach this server."""
    print(json.dumps(address), flush=True)


def start_router():
    """The address of a router of Zenoh, in a process that ends with this one's group."""
    import socket
    import subprocess
    import sys

    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        where = f"tcp/127.0.0.1:{probe.getsockname()[1]}"
    command = [sys.executable, "-m", "yarpy", "router", where]
    router = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert where in router.stdout.readline()
    return where


def main(functions):
    """Run one side; `functions` maps a workload's name to its (server, client) functions."""
    parser = argparse.ArgumentParser()
    parser.add_argument("side", choices=["server", "client"])
    parser.add_argument("workload", choices=[*functions])
    parser.add_argument("--carrier", default="tcp")
    parser.add_argument("--spin", action="store_true", help="readers poll instead of sleeping")
    parser.add_argument("--router", action="store_true", help="through a router of Zenoh")
    parser.add_argument("--at", type=json.loads, default={}, help="what the server printed")
    parser.add_argument("--warmup", type=int, default=100)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--side", type=int, default=1024, help="of images, in pixels")
    parser.add_argument("--prepare", action="store_true", help="images are made in shared memory")
    parser.add_argument("--pause", type=float, default=0.0, help="seconds before each exchange")
    parser.add_argument("--server", type=int, help="process id of the server, to ask what it used")
    parser.add_argument("--core", type=int, help="the only processor core to run on")
    options = parser.parse_args()
    if options.core is not None:
        os.sched_setaffinity(0, {options.core})  # before any thread: they inherit it
    serve, ask = functions[options.workload]
    if options.side == "server":
        serve(options)
        return
    timed = ask(options)
    if isinstance(timed, list):
        answer = {"samples": timed, "processor": None}
    elif options.workload == "flood":
        answer = time_burst(timed, options)
    else:
        answer = time_each(timed, options)
    print(json.dumps(answer), flush=True)
    # Closing politely is not measured, and a library may wait in it for threads that block.
    os._exit(0)


def time_each(exchange, options):
    """`samples`: nanoseconds of each exchange; `processor`: see `processor_time`, per exchange."""
    for index in range(options.warmup):
        exchange(index)
    gc.collect()
    now, pause = time.perf_counter_ns, options.pause
    samples = []
    before = processor_time(options.server)
    for index in range(options.count):
        if pause:
            time.sleep(pause)
        start = now()
        exchange(index)
        samples.append(now() - start)
    return {"samples": samples, "processor": used_since(before, options)}


def time_burst(burst, options):
    """`samples`: one, messages per second; `processor` per message."""
    burst(options.warmup)
    gc.collect()
    before = processor_time(options.server)
    start = time.perf_counter_ns()
    burst(options.count)
    rate = options.count * 1e9 / (time.perf_counter_ns() - start)
    return {"samples": [rate], "processor": used_since(before, options)}


def used_since(before, options):
    after = processor_time(options.server)
    return None if None in (before, after) else (after - before) / options.count


def processor_time(server):
    """Nanoseconds that all threads of this process and of the server have run; None if unknown.

    Latency can be bought by looking for messages instead of sleeping: this is the price.
    """
    total = 0
    try:
        for process in ("self", server):
            for thread in os.listdir(f"/proc/{process}/task"):
                with open(f"/proc/{process}/task/{thread}/schedstat", encoding="utf-8") as status:
                    total += int(status.read().split()[0])
    except OSError:
        return None
    return total
