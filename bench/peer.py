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


def main(functions):
    """Run one side; `functions` maps a workload's name to its (server, client) functions."""
    parser = argparse.ArgumentParser()
    parser.add_argument("side", choices=["server", "client"])
    parser.add_argument("workload", choices=[*functions])
    parser.add_argument("--carrier", default="tcp")
    parser.add_argument("--spin", action="store_true", help="readers poll instead of sleeping")
    parser.add_argument("--at", type=json.loads, default={}, help="what the server printed")
    parser.add_argument("--warmup", type=int, default=100)
    parser.add_argument("--count", type=int, default=1000)
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
        samples = timed
    elif options.workload == "flood":
        samples = time_burst(timed, options.warmup, options.count)
    else:
        samples = time_each(timed, options.warmup, options.count)
    print(json.dumps({"samples": samples}), flush=True)
    # Closing politely is not measured, and a library may wait in it for threads that block.
    os._exit(0)


def time_each(exchange, warmup, count):
    """Nanoseconds of each exchange."""
    for index in range(warmup):
        exchange(index)
    gc.collect()
    now = time.perf_counter_ns
    samples = []
    for index in range(count):
        start = now()
        exchange(index)
        samples.append(now() - start)
    return samples


def time_burst(burst, warmup, count):
    """One sample: messages per second."""
    burst(warmup)
    gc.collect()
    start = time.perf_counter_ns()
    burst(count)
    return [count * 1e9 / (time.perf_counter_ns() - start)]
