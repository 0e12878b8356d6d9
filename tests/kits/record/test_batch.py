"""What was given to the files and is not in the system's hands yet."""

from pathlib import Path

import pytest
from support.recordings import payload_of

from yarpy.kits.record.batch import Batch
from yarpy.kits.record.intake import Intake
from yarpy.kits.record.mcap import writer
from yarpy.kits.record.output import Output
from yarpy.wire.message import DATA, Message


def put(intake: Intake, value: object, envelope: str = "") -> None:
    message = Message(DATA, payload_of(value), envelope)
    message.source = "/a"
    intake.put(message)


@pytest.fixture
def output(tmp_path: Path):
    output = Output(tmp_path / "x")
    yield output
    output.close()


def test_memory_counts_until_it_is_written(output: Output) -> None:
    intake = Intake()
    batch = Batch(intake, output)
    put(intake, [1])
    for taken in intake.take():
        batch.add(taken)
    assert intake.held > 0 and output.pending
    batch.flush()
    assert intake.held == 0 and not output.pending and not batch.due


def test_a_chunk_that_is_full_frees_its_memory(
    output: Output, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(writer, "CHUNK_SIZE", 100)
    intake = Intake()
    batch = Batch(intake, output)
    put(intake, "x" * 200)
    for taken in intake.take():
        batch.add(taken)
    assert intake.held == 0


def test_it_is_due_after_a_while_or_when_memory_gets_short(
    output: Output, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = [100.0]
    monkeypatch.setattr("yarpy.kits.record.batch.time.monotonic", lambda: now[0])
    intake = Intake(memory=100_000)
    batch = Batch(intake, output)
    assert not batch.due
    put(intake, [1])
    for taken in intake.take():
        batch.add(taken)
    assert not batch.due
    now[0] += 0.5
    assert batch.due
    batch.flush()
    put(intake, "x" * 10_000)
    for taken in intake.take():
        batch.add(taken)
    assert batch.due


def test_what_envelopes_leave_out(output: Output) -> None:
    intake = Intake()
    batch = Batch(intake, output)
    for envelope in ("5 1", "6 1", "9 1", "", "10 1", "2 1", "3 1", "word 1", "99"):
        put(intake, [1], envelope)
    for taken in intake.take():
        batch.add(taken)
    assert intake.counts["/a"].missed == 2
    intake.paused = True
    put(intake, [1], "4 1")
    intake.paused = False
    put(intake, [1], "100 1")
    for taken in intake.take():
        batch.add(taken)
    assert intake.counts["/a"].missed == 2


def test_what_no_file_takes_and_what_was_not_written_is_lost(
    output: Output, monkeypatch: pytest.MonkeyPatch
) -> None:
    intake = Intake()
    batch = Batch(intake, output)
    put(intake, "x" * 100)
    put(intake, [1])
    monkeypatch.setattr(writer, "LARGEST", 50)
    for taken in intake.take():
        batch.add(taken)
    assert intake.counts["/a"].lost == 1
    batch.lose()
    assert (intake.counts["/a"].lost, intake.counts["/a"].messages, intake.held) == (2, 0, 0)
