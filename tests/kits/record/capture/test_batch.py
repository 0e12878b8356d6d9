"""What was given to the files and is not in the system's hands yet."""

from contextlib import closing
from pathlib import Path

import pytest
from support.recordings import payload_of
from support.system import NO_UNLINK

from yarpy.kits.record.capture.batch import Batch
from yarpy.kits.record.capture.output import Output
from yarpy.kits.record.capture.queue import MessageQueue
from yarpy.kits.record.mcap import writer
from yarpy.kits.record.mcap.storage import McapStorage
from yarpy.wire.message import DATA, Message


def put(queue: MessageQueue, value: object, envelope: str = "") -> None:
    message = Message(DATA, payload_of(value), envelope)
    message.source = "/a"
    queue.put(message)


@pytest.fixture
def output(tmp_path: Path):
    output = Output(tmp_path / "x")
    yield output
    output.close()


def test_memory_counts_until_it_is_written(output: Output) -> None:
    queue = MessageQueue()
    batch = Batch(queue, output)
    put(queue, [1])
    for queued in queue.take():
        batch.add(queued)
    assert queue.held > 0 and output.pending
    batch.flush()
    assert queue.held == 0 and not output.pending and not batch.due


def test_a_chunk_that_is_full_frees_its_memory(
    output: Output, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(writer, "CHUNK_SIZE", 100)
    queue = MessageQueue()
    batch = Batch(queue, output)
    put(queue, "x" * 200)
    for queued in queue.take():
        batch.add(queued)
    assert queue.held == 0


def test_it_is_due_after_a_while_or_when_memory_gets_short(
    output: Output, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = [100.0]
    monkeypatch.setattr("yarpy.kits.record.capture.batch.time.monotonic", lambda: now[0])
    queue = MessageQueue(memory=100_000)
    batch = Batch(queue, output)
    assert not batch.due
    put(queue, [1])
    for queued in queue.take():
        batch.add(queued)
    assert not batch.due
    now[0] += 0.5
    assert batch.due
    batch.flush()
    put(queue, "x" * 10_000)
    for queued in queue.take():
        batch.add(queued)
    assert batch.due


def test_what_envelopes_leave_out(output: Output) -> None:
    queue = MessageQueue()
    batch = Batch(queue, output)
    for envelope in ("5 1", "6 1", "9 1", "", "10 1", "2 1", "3 1", "word 1", "99"):
        put(queue, [1], envelope)
    for queued in queue.take():
        batch.add(queued)
    assert queue.counts["/a"].missed == 2
    queue.paused = True
    put(queue, [1], "4 1")
    queue.paused = False
    put(queue, [1], "100 1")
    for queued in queue.take():
        batch.add(queued)
    assert queue.counts["/a"].missed == 2


@pytest.mark.skipif(bool(NO_UNLINK), reason=NO_UNLINK)
def test_what_was_in_a_file_that_is_gone_goes_into_the_next(output: Output) -> None:
    queue = MessageQueue()
    batch = Batch(queue, output)
    for number in range(3):
        put(queue, [number], f"{2 * number} 1")
    for queued in queue.take():
        batch.add(queued)
    output.path.unlink()
    output.leave()
    batch.again()
    batch.flush()
    count = queue.counts["/a"]
    assert (count.messages, count.lost, count.missed, queue.held) == (3, 0, 2, 0)
    with closing(McapStorage(output.path)) as found:
        assert [one.value for one in found.messages()] == [[0], [1], [2]]


def test_what_no_file_takes_and_what_was_not_written_is_lost(
    output: Output, monkeypatch: pytest.MonkeyPatch
) -> None:
    queue = MessageQueue()
    batch = Batch(queue, output)
    put(queue, "x" * 100)
    put(queue, [1])
    monkeypatch.setattr(writer, "LARGEST", 50)
    for queued in queue.take():
        batch.add(queued)
    assert queue.counts["/a"].lost == 1
    batch.lose()
    assert (queue.counts["/a"].lost, queue.counts["/a"].messages, queue.held) == (2, 0, 0)
