"""Files within a file of MCAP: written, read by us and by the library, kept, and damaged."""

from pathlib import Path

import mcap.reader
import pytest
from support.recordings import fill, recorded

from yarpy import record
from yarpy.errors import DecodeError, LocalProtocolError
from yarpy.kits.record.capture.output import Output, contents
from yarpy.kits.record.convert import convert
from yarpy.kits.record.mcap import index
from yarpy.kits.record.mcap.attachment import Attachment, parse_attachment
from yarpy.kits.record.mcap.layout import Damaged
from yarpy.kits.record.mcap.writer import McapWriter
from yarpy.kits.record.report import lines, report

XML = b"<application><name>walk</name></application>"


@pytest.fixture
def path(tmp_path: Path) -> Path:
    with McapWriter(tmp_path / "x.mcap", metadata={"host": "lab"}) as writer:
        fill(writer, 4)
        writer.attach("walk.xml", XML, "text/xml")
        fill(writer, 2)
        writer.attach("empty", b"", "")
    return tmp_path / "x.mcap"


def test_the_library_reads_and_checks_them(path: Path) -> None:
    with open(path, "rb") as file:
        reader = mcap.reader.make_reader(file, validate_crcs=True)
        summary = reader.get_summary()
        assert summary is not None and summary.statistics is not None
        assert summary.statistics.attachment_count == 2
        assert [one.name for one in summary.attachment_indexes] == ["walk.xml", "empty"]
        found = [(one.name, one.media_type, one.data) for one in reader.iter_attachments()]
        assert found == [("walk.xml", "text/xml", XML), ("empty", "", b"")]


@pytest.mark.parametrize("finished", [True, False])
def test_they_are_read(path: Path, finished: bool) -> None:
    if not finished:
        path.write_bytes(path.read_bytes()[:-30])
    with record.open(path) as found:
        assert found.complete == finished and len([*found]) == 6
        assert found.attachments() == {"walk.xml": XML, "empty": b""}
        told = lines(report(found))
    assert (
        f"attached:  walk.xml (text/xml, {len(XML)} B)" in told and "attached:  empty (0 B)" in told
    )


def test_each_is_kept_once_by_convert(path: Path, tmp_path: Path) -> None:
    with record.open(path, path) as found:
        convert(found, tmp_path / "both")
    with record.open(tmp_path / "both.mcap") as found:
        assert found.attachments() == {"walk.xml": XML, "empty": b""}
        assert len([*found]) == 12 and not found.damages


def test_one_that_has_changed_is_told(path: Path, tmp_path: Path) -> None:
    whole = path.read_bytes()
    path.write_bytes(whole.replace(b"<name>walk", b"<name>fall"))
    with record.open(path) as found:
        assert len([*found]) == 6
        with pytest.raises(DecodeError, match=r'byte \d+: the attachment "walk.xml" has changed'):
            found.attachments()
        convert(found, tmp_path / "rest")
        assert "has changed" in found.damages[0]
    with record.open(tmp_path / "rest.mcap") as found:
        assert found.attachments() == {"empty": b""}


@pytest.mark.parametrize("body", [b"", bytes(16), bytes(16) + b"\xff\xff\xff\xff", bytes(35)])
def test_a_lie_about_lengths_is_damage(body: bytes) -> None:
    with pytest.raises(Damaged):
        parse_attachment(body, 9, len(body))


def test_a_large_one_is_not_read(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(index, "LARGEST", len(XML) - 1)
    with record.open(path) as found, pytest.raises(DecodeError, match="an attachment of 44 bytes"):
        found.attachments()


def test_too_many_are_damage(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(index, "MOST", 1)
    with record.open(path) as found:
        assert [*found.attachments()] == ["walk.xml"] and "more than 1" in found.damages[0]


def test_what_lies_beyond_the_file_is_damage() -> None:
    whole = Attachment("a", "", 9, 50, 0)
    assert whole.size == 0
    with pytest.raises(Damaged, match="an attachment of 0 bytes in a record of 50"):
        parse_attachment(bytes(50), 9, 50)


def test_each_file_of_a_recording_gets_them(tmp_path: Path) -> None:
    (tmp_path / "walk.xml").write_bytes(XML)
    given = contents([tmp_path / "walk.xml"])
    output = Output(tmp_path / "y", attached=given)
    output.split()
    output.close()
    for path in output.files:
        with record.open(path) as found:
            assert found.attachments() == {"walk.xml": XML}
            assert found.storages[0].attachments[0].kind == "application/xml"  # type: ignore[attr-defined]


def test_what_cannot_be_attached(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.msg"
    path.write_bytes(b"float64 x")
    with pytest.raises(LocalProtocolError, match=r"two files are called a\.msg"):
        contents([path, path])
    monkeypatch.setattr("yarpy.kits.record.capture.output.LARGEST", 3)
    with pytest.raises(LocalProtocolError, match="too large to be attached"):
        contents([path])
    if Path("/dev/zero").exists():
        with pytest.raises(LocalProtocolError, match="too large to be attached"):
            contents(["/dev/zero"])
    with pytest.raises(OSError):
        contents([tmp_path / "none"])


def test_most_files_have_none(tmp_path: Path) -> None:
    with record.open(recorded(tmp_path / "x.mcap")) as found:
        assert found.attachments() == {} and report(found).attachments == []
