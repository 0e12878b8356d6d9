"""The steps of closing: each is done once, whatever cuts one short."""

import math
import threading

import pytest
from support.wait import HANG

from yarpy import scope
from yarpy.errors import LinkClosed
from yarpy.port.keep.closing import HURRY, Closing


def closing(*steps):
    return Closing(lambda: "/port", steps)


def test_steps_are_done_in_order_and_once():
    done = []
    end = closing((lambda: done.append(1), 0.5), (lambda: done.append(2), 1.0))
    end.run(1.0)
    end.run(1.0)
    assert done == [1, 2]
    assert end.done


def test_each_step_has_its_share_of_the_time():
    left = []
    look = lambda: left.append(scope.left())  # noqa: E731
    with scope.Scope(0.0):  # the call beneath a signal handler has no say
        closing((look, 0.5), (look, 1.0)).run(60.0)
    assert 20.0 < left[0] <= 30.0
    assert 50.0 < left[1] <= 60.0


def test_an_error_leaves_out_nothing(caplog):
    done = []

    def fail(error):
        raise error

    end = closing(
        (lambda: fail(LinkClosed("gone")), 1.0),
        (lambda: fail(ZeroDivisionError()), 1.0),
        (lambda: done.append(1), 1.0),
    )
    thread = threading.Thread(target=end.run, args=(1.0,))
    thread.start()
    thread.join(HANG)
    assert done == [1]
    assert end.done
    assert "a defect while closing" in caplog.text


def test_what_a_signal_handler_raises_is_raised_behind_the_other_steps(caplog):
    done = []

    def alarm():
        if not done:
            raise TimeoutError("the program gives up")

    end = closing((alarm, 1.0), (lambda: done.append(1), 1.0))
    with pytest.raises(TimeoutError, match="gives up"):
        end.run(1.0)
    assert done == [1]
    assert not end.done
    end.run(1.0)
    assert end.done
    assert not caplog.text


def test_after_ctrl_c_the_rest_is_done_in_a_hurry_and_the_cut_step_again():
    done, left = [], []

    def cut():
        done.append("cut")
        if len(done) == 1:
            raise KeyboardInterrupt

    def rest():
        done.append("rest")
        left.append(scope.left())

    end = closing((cut, 1.0), (rest, 1.0))
    with pytest.raises(KeyboardInterrupt):
        end.run(60.0)
    assert done == ["cut", "rest"]
    assert left[0] < 1.001 * HURRY  # what is added to a time and taken away is rounded
    assert not end.done
    end.run(60.0)
    assert done == ["cut", "rest", "cut"]
    assert end.done


def test_another_thread_waits_for_the_first():
    begun, go_on, order = threading.Event(), threading.Event(), []

    def slow():
        begun.set()
        go_on.wait()
        order.append("step")

    end = closing((slow, 1.0))
    first = threading.Thread(target=end.run, args=(60.0,))
    first.start()
    begun.wait()
    end.run(60.0, wait=False)  # as a thread that the first may be waiting for
    assert not end.done

    def second():
        end.run(60.0)
        order.append("second")

    other = threading.Thread(target=second)
    other.start()
    go_on.set()
    other.join(60.0)
    first.join(60.0)
    assert order == ["step", "second"]


def test_the_frame_beneath_goes_on():
    depth = []

    def step():
        depth.append(1)
        end.run(math.inf)  # as a signal handler, or a callback, would
        depth.append(2)

    end = closing((step, 1.0))
    end.run(1.0)
    assert depth == [1, 2]
    assert end.done


def test_the_last_step_has_time_of_its_own():
    left = []
    look = lambda: left.append(scope.remaining())  # noqa: E731
    closing((look, 0.5), (look, 1.0)).run(0.0, last=60.0)
    assert left[0] == 0.0
    assert 50.0 < left[1] <= 60.0


def test_but_none_after_ctrl_c():
    left = []

    def cut():
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        closing((cut, 1.0), (lambda: left.append(scope.left()), 1.0)).run(60.0, last=60.0)
    assert left[0] < 1.001 * HURRY  # what is added to a time and taken away is rounded
