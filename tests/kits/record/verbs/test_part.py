"""`yarpy cut`, `merge` and `filter`: what is left."""

from support.recordings import START, STEP, fill, payload_of, recorded

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


def test_several_as_one(here, tmp_path) -> None:
    paths = [tmp_path / "even.mcap", tmp_path / "odd.mcap"]
    for n, path in enumerate(paths):
        with McapWriter(path) as writer:
            for m in range(5):
                writer.add(f"/{n}", "", START + (2 * m + n) * STEP, payload_of([2 * m + n]))
    out = tmp_path / "both"
    assert here("merge", *map(str, paths), "-o", str(out)).code == 0
    assert values(f"{out}.mcap") == [[n] for n in range(10)]
    said = here("merge", *map(str, paths), "-o", str(out))
    assert said.code == 1 and "there already" in said.err


def test_some_of_the_ports(here, tmp_path) -> None:
    path = str(recorded(tmp_path / "x.mcap"))
    rows = [
        (["--ports", "/a"], [0, 2, 4, 6, 8]),
        (["-e", "b$"], [1, 3, 5, 7, 9]),
        (["--exclude", "a"], [1, 3, 5, 7, 9]),
        (["--kind", "bottle"], [*range(10)]),
        (["--ports", "/a", "--max-rate", "*=25"], [0, 4, 8]),
    ]
    for number, (words, left) in enumerate(rows):
        out = tmp_path / f"out{number}"
        assert here("filter", path, "-o", str(out), *words).code == 0
        assert values(f"{out}.mcap") == [[n] for n in left]
    said = here("filter", path, "-o", str(tmp_path / "none"), "--kind", "image")
    assert said.code == 1 and "no port is left of /a /b" in said.err
    assert here("filter", path, "-o", str(tmp_path / "none"), "--ports", "/c").code == 1


def test_what_is_damaged_is_told(here, tmp_path) -> None:
    path = recorded(tmp_path / "x.mcap")
    path.write_bytes(path.read_bytes()[:400])
    said = here("merge", str(path), "-o", str(tmp_path / "y"))
    assert said.code == 1 and "x.mcap: byte " in said.err
