"""`yarpy convert`; tests/kits/record/test_convert.py has what it writes."""

from support.recordings import recorded


def test_there_and_back(here, tmp_path) -> None:
    path = recorded(tmp_path / "x.mcap")
    cpp, back = str(tmp_path / "cpp"), str(tmp_path / "back")
    said = here("convert", str(path), "-o", cpp, "--format", "dumper", "--times", "tx+rx")
    assert (said.code, said.out) == (0, f"{cpp}: 10 messages\n")
    said = here("convert", cpp, "-o", back, "--compress", "lz4", "--ports", "/a")
    assert (said.code, said.out) == (0, f"{back}.mcap: 5 messages\n")
    said = here("convert", cpp, "-o", back)
    assert said.code == 1 and "is there already: choose another name" in said.err


def test_what_is_damaged_is_told(here, tmp_path) -> None:
    path = recorded(tmp_path / "x.mcap")
    path.write_bytes(path.read_bytes()[:400])
    said = here("convert", str(path), "-o", str(tmp_path / "y"))
    assert said.code == 1 and "x.mcap: byte " in said.err and "messages" in said.out
