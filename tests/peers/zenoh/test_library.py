"""Zenoh as a library: what it says, and threads that wait in it."""

from __future__ import annotations

import sys
import threading

import pytest
from support.wait import HANG

from yarpy.errors import (
    UnknownPlugin,
)
from yarpy.peers.zenoh import library as zenoh_library
from yarpy.peers.zenoh.transport import share


def test_the_end_of_a_program_waits_for_those_who_wait_in_zenoh() -> None:
    calls, woken = zenoh_library.Calls(), threading.Event()
    inside = threading.Event()
    calls.waking.append(woken.set)

    def wait() -> None:
        with calls:
            inside.set()
            woken.wait(HANG)

    thread = threading.Thread(target=wait)
    thread.start()
    inside.wait(HANG)
    calls.refuse()
    calls.wait()
    assert woken.is_set() and not calls._waiting
    thread.join(HANG)
    with pytest.raises(ConnectionAbortedError), calls:
        raise AssertionError("it is over")


def test_the_end_of_a_program_waits_for_the_locks_that_are_taken() -> None:
    calls = zenoh_library.Calls()
    lock, _ = calls.new_lock(), calls.new_lock()
    lock.acquire()
    threading.Timer(0.05, lock.release).start()
    calls.refuse()
    calls.wait()
    assert calls.over and not lock.locked()


def test_not_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "zenoh", None)
    with pytest.raises(UnknownPlugin, match=r"pip install .*yarpy\[zenoh\]"):
        share("tcp/127.0.0.1:1")


def test_what_zenoh_says_is_told_without_its_sources() -> None:
    error = RuntimeError("Invalid key!  at /root/zenoh/src/key.rs:12.")
    assert zenoh_library.plain(error) == "Invalid key"
