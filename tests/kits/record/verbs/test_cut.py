"""`yarpy cut`: a stretch of time is left."""

from support.recordings import START, STEP, fill, recorded

from yarpy import record
from yarpy.kits.record.mcap.writer import McapWriter


def values(path) -> list:
    with record.open(path) as found:
        return [one.value for one in found]


def test_a_stretch_of_time(here, tmp_path) -> None:
    path = tmp_path / "x.mcap"
    with McapWriter(path) as writer:
        fill(writer, 10)
        writer.note({"what": "mark", "text": "fell"}, START + 3 * STEP)
        writer.note({"what": "mark", "text": "stood up"}, START + 6 * STEP)
    for number, words in enumerate(
        (["--start", "0.03", "--duration", "0.03"], ["--from", "fell", "--to", "stood up"])
    ):
        out = tmp_path / f"part{number}"
        said = here("cut", str(path), "-o", str(out), *words)
        assert (said.code, said.out) == (0, f"{out}.mcap: 3 messages\n")
        assert values(f"{out}.mcap") == [[3], [4], [5]]
    said = here("cut", str(path), "-o", "y", "--from", "stood up", "--to", "fell")
    assert said.code == 1 and "not behind" in said.err
    said = here("cut", str(path), "-o", "y", "--duration", "1", "--to", "fell")
    assert said.code == 1 and "both say where it ends" in said.err


def test_what_is_damaged_is_told(here, tmp_path) -> None:
    path = recorded(tmp_path / "x.mcap")
    path.write_bytes(path.read_bytes()[:400])
    said = here("cut", str(path), "-o", str(tmp_path / "y"))
    assert said.code == 1 and "x.mcap: byte " in said.err
