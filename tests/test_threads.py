"""Threads of the library run whole, also where a signal handler raises in their start."""

from __future__ import annotations

import contextlib
import signal
import sys
import threading
from functools import partial
from pathlib import Path

import pytest
from support.build import COMPILED
from support.moments import Cut, cut, moments
from support.wait import HANG, wait_until

from yarpy.threads import Thread, imported, undisturbed


def test_it_is_a_thread_as_others_are() -> None:
    found: list[object] = []
    thread = Thread(target=found.append, args=(1,), name="yarpy test", daemon=True)
    assert (thread.name, thread.daemon, thread.is_alive()) == ("yarpy test", True, False)
    thread.start()
    thread.join(HANG)
    assert found == [1]
    assert not thread.is_alive()
    with pytest.raises(RuntimeError):
        thread.start()


@pytest.mark.skipif(COMPILED, reason="compiled code has no steps to cut at")
def test_an_exception_of_a_signal_handler_in_its_start_leaves_it_running_or_not_begun() -> None:
    for moment in moments():
        done: list[int] = []
        thread = Thread(target=done.append, args=(1,), daemon=True)
        with contextlib.suppress(Cut), moment.interrupts(cut):
            thread.start()
        wait_until(partial(_ran_or_not_begun, thread, done), HANG)
        if not moment.came:
            thread.join(HANG)
            assert done == [1]


def _ran_or_not_begun(thread: Thread, done: list[int]) -> bool:
    return bool(done) or thread.ident is None


class Alarm(Exception):
    """What the signal raises."""


@pytest.mark.skipif(not hasattr(signal, "pthread_kill"), reason="this system cannot signal threads")
def test_what_must_not_be_cut_goes_on_in_another_thread() -> None:
    main, go_on, over = threading.get_ident(), threading.Event(), threading.Event()

    def ring(*_: object) -> None:
        raise Alarm

    def work() -> None:
        signal.pthread_kill(main, signal.SIGUSR1)
        assert go_on.wait(HANG)
        over.set()

    before = signal.signal(signal.SIGUSR1, ring)
    try:
        with pytest.raises(Alarm):
            undisturbed(work)
    finally:
        signal.signal(signal.SIGUSR1, before)
    assert not over.is_set()
    go_on.set()
    assert over.wait(HANG)


def test_what_it_returns_and_raises() -> None:
    assert undisturbed(threading.current_thread) is not threading.main_thread()
    with pytest.raises(ZeroDivisionError):
        undisturbed(lambda: 1 // 0)
    found: list[bool] = []
    thread = threading.Thread(
        target=lambda: found.append(undisturbed(threading.current_thread) is thread)
    )
    thread.start()
    thread.join()
    assert found == [True]


@pytest.mark.skipif(
    not hasattr(signal, "pthread_kill"), reason="this system sends no signal to a thread"
)
def test_a_module_is_imported_whole_whatever_a_handler_raises(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As numpy is, which cannot be imported a second time after that."""
    begun = threading.Event()
    monkeypatch.setattr(threading, "begun_in_a_test", begun, raising=False)
    (tmp_path / "slow_one_of_a_test.py").write_text(
        "import threading, time\nthreading.begun_in_a_test.set()\ntime.sleep(0.1)\nwhole = True\n"
    )
    monkeypatch.syspath_prepend(tmp_path)

    def ring(*_: object) -> None:
        raise Alarm

    before = signal.signal(signal.SIGUSR1, ring)
    bell = threading.Thread(
        target=lambda: (begun.wait(HANG), signal.pthread_kill(main.ident, signal.SIGUSR1))
    )
    main = threading.main_thread()
    try:
        bell.start()
        with pytest.raises(Alarm):
            imported("slow_one_of_a_test")
        bell.join(HANG)
        assert imported("slow_one_of_a_test").whole
    finally:
        signal.signal(signal.SIGUSR1, before)
        sys.modules.pop("slow_one_of_a_test", None)
