"""Work of a callback is waited for by the thread of its connection, as long as that waits."""

import threading
from contextvars import copy_context

from yarpy.callback_thread import in_callback_of, waited_by


def test_the_current_thread_waits_for_what_is_called_in_it() -> None:
    assert waited_by() is threading.current_thread()


def test_the_thread_that_waits_is_known_inside_and_in_copies_of_the_context() -> None:
    other = threading.Thread()
    with in_callback_of(other):
        assert waited_by() is other
        within = copy_context()
        assert within.run(waited_by) is other
    assert waited_by() is threading.current_thread()
    assert within.run(waited_by) is threading.current_thread()  # nobody waits any more
