"""Buffered ports: writing does not wait, and what it does not send it counts."""

import threading
import time
from collections.abc import Iterator

import numpy as np
import pytest
from support.lasted import lasted
from support.wait import HANG, wait_until

import yarpy


@pytest.fixture
def names() -> yarpy.LocalNames:
    return yarpy.LocalNames()


@pytest.fixture
def ports(names: yarpy.LocalNames) -> Iterator[tuple[yarpy.BufferedPort, yarpy.BufferedPort]]:
    """A writer connected to a reader that keeps every message."""
    with (
        yarpy.BufferedPort("/writer", names=names) as writer,
        yarpy.BufferedPort("/reader", strict=True, names=names) as reader,
    ):
        writer.connect("/reader")
        yield writer, reader


def test_what_cannot_be_sent_is_the_writers_error_and_the_connection_goes_on(ports):
    writer, reader = ports
    for bad in (object(), [1, object()], {"key": object()}):
        with pytest.raises(TypeError):
            writer.write(bad)
    assert writer.write([1]) == 1
    assert reader.read(timeout=HANG).value == [1]


def test_a_list_may_be_changed_after_writing(ports):
    writer, reader = ports
    for number in range(50):
        numbers = [number] * 100
        assert writer.write(numbers) == 1
        numbers[:] = [-1] * 100
        assert reader.read(timeout=HANG).value == [number] * 100
        writer.flush(timeout=HANG)


def test_an_array_may_be_changed_after_writing(ports):
    """Also when it leaves later, in the thread of its connection, and is too large to be copied."""
    writer, reader = ports
    for turn in range(20):
        image = np.full((200, 200), turn, np.uint8)
        assert writer.write(image) == 1
        image[:] = 255
        assert int(reader.read(timeout=HANG).value.array.max()) == turn
        writer.flush(timeout=HANG)


# ---------------------------------------------------------------------------------- policies


def wait_until_sent(port: yarpy.BufferedPort, count: int) -> None:
    wait_until(lambda: sum(o.stats.messages + o.stats.replaced for o in port.outputs) == count)


def test_reader_gets_the_newest(names):
    with (
        yarpy.Port("/writer", names=names) as writer,
        yarpy.BufferedPort("/reader", names=names) as reader,
    ):
        writer.connect("/reader")
        for number in range(20):
            writer.write([number], wait=True)
        assert reader.waiting == 1
        assert reader.read(timeout=HANG).value == [19]
        assert reader.poll() is None
        assert reader.inputs[0].stats.replaced == 19
        with pytest.raises(yarpy.Timeout):
            reader.read(timeout=0.01)


def test_strict_reader_gets_everything(names):
    with (
        yarpy.Port("/writer", names=names) as writer,
        yarpy.BufferedPort("/reader", strict=True, names=names) as reader,
    ):
        writer.connect("/reader")
        for number in range(200):
            writer.write([number])
        assert [reader.read(timeout=HANG).value[0] for _ in range(200)] == list(range(200))
        assert reader.inputs[0].stats.drops == 0


def test_writer_does_not_wait_for_a_slow_reader(names):
    with (
        yarpy.BufferedPort("/writer", names=names) as writer,
        yarpy.Port("/reader", names=names) as reader,
    ):
        writer.connect("/reader")
        started = time.monotonic()
        taken = sum(writer.write([number]) for number in range(100))
        assert lasted(started) < 10
        assert 1 <= taken < 100
        wait_until_sent(writer, 100)
        assert reader.read(timeout=HANG).value == [0]


@pytest.mark.parametrize("carrier", ["text", "text_ack"])
def test_thread_of_a_connection_that_broke_ends(names, carrier):
    """It used to wait for messages for ever, one for each reader that was killed."""
    with (
        yarpy.BufferedPort("/writer", names=names) as writer,
        yarpy.BufferedPort("/reader", names=names) as reader,
    ):
        writer.connect("/reader", carrier)
        writer.write([1])
        assert reader.read(timeout=HANG).value == [1]
        thread = writer._hub.outputs.links[0].thread
        assert thread.is_alive()
        link = next(link for link in reader._hub.inputs.links if link.route.source == "/writer")
        link.driver.transport.interrupt()  # as when its process is killed
        wait_until(lambda: writer.write([2]) + 1 and not thread.is_alive())


def test_strict_writer_waits_and_loses_nothing(names):
    with (
        yarpy.BufferedPort("/writer", strict=True, names=names) as writer,
        yarpy.Port("/reader", names=names) as reader,
    ):
        writer.connect("/reader")
        thread = threading.Thread(target=lambda: [writer.write([n]) for n in range(500)])
        thread.start()
        assert [reader.read(timeout=HANG).value[0] for _ in range(500)] == list(range(500))
        thread.join(HANG)
        assert writer.outputs[0].stats.drops == 0


def test_one_slow_reader_does_not_hold_up_the_other(names):
    quick = []
    with (
        yarpy.BufferedPort("/writer", names=names) as writer,
        yarpy.Port("/slow", names=names),
        yarpy.Port("/quick", names=names, callback=quick.append),
    ):
        writer.connect("/slow")
        writer.connect("/quick")

        def arrives(number: int) -> bool:
            """Written again while the connection waits for its acknowledgement, and drops."""
            writer.write([number])
            return bool(quick) and quick[-1].value[0] == number

        for number in range(30):
            wait_until(lambda number=number: arrives(number))
        by_name = {o.target: o.stats for o in writer.outputs}
        assert by_name["/slow"].replaced >= 28


def test_callback_sees_every_message(names):
    heard = []
    with (
        yarpy.BufferedPort("/writer", strict=True, names=names) as writer,
        yarpy.BufferedPort("/reader", names=names, callback=heard.append) as reader,
    ):
        writer.connect("/reader")
        for number in range(50):
            writer.write([number])
        writer.flush(timeout=HANG)
        assert [m.value[0] for m in heard] == list(range(50))
        with pytest.raises(yarpy.PortClosed):
            reader.read(timeout=0)


def test_iteration_ends_with_the_port(names):
    with (
        yarpy.BufferedPort("/writer", strict=True, names=names) as writer,
        yarpy.BufferedPort("/reader", strict=True, names=names) as reader,
    ):
        writer.connect("/reader")
        found = []
        thread = threading.Thread(target=lambda: found.extend(m.value[0] for m in reader))
        thread.start()
        for number in range(5):
            writer.write([number])
        writer.flush(timeout=HANG)
        wait_until(lambda: len(found) == 5)
        reader.close()
        thread.join(HANG)
        assert found == [0, 1, 2, 3, 4]


def test_call_to_a_buffered_port_gets_an_empty_answer_or_the_readers(names):
    """A question is a message too; who reads it quickly enough may answer."""
    with (
        yarpy.BufferedPort("/reader", strict=True, names=names) as reader,
        yarpy.RpcClient("/reader", names=names) as client,
    ):
        assert client.call("x", timeout=HANG) == []
        message = reader.read(timeout=HANG)
        assert message.value == ["x"]
        assert not message.wants_reply


def test_reading_policy_may_be_chosen_after_opening(names: yarpy.LocalNames) -> None:
    with (
        yarpy.BufferedPort("/out", strict=True, names=names) as out,
        yarpy.BufferedPort("/in", names=names) as in_,
    ):
        out.connect("/in")
        out.write([0])
        wait_until(lambda: in_.waiting)
        in_.read_strictly()
        in_.read_strictly()
        for number in range(1, 4):
            out.write([number])
        wait_until(lambda: in_.waiting == 4)
        assert [in_.read(timeout=HANG).value for _ in range(4)] == [[0], [1], [2], [3]]
        for number in range(4, 7):
            out.write([number])
        wait_until(lambda: in_.waiting == 3)
        in_.read_strictly(False)  # of what waits the newest stays
        assert in_.read(timeout=HANG).value == [6]
        assert in_.poll() is None
        in_.interrupt()
        in_.read_strictly()
        with pytest.raises(yarpy.PortClosed):
            in_.read(timeout=HANG)
        in_.resume()
        out.write([7])
        assert in_.read(timeout=HANG).value == [7]


def test_callback_gets_everything_anyway(names: yarpy.LocalNames) -> None:
    with yarpy.BufferedPort("/in", names=names, callback=lambda message: None) as in_:
        in_.read_strictly()
        with pytest.raises(yarpy.PortClosed, match="hands its messages to a callback"):
            in_.read(timeout=1)
