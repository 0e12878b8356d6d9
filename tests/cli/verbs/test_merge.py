"""`yarpy merge`."""

import pytest
from support.wait import HANG

import yarpy
from yarpy.cli.verbs.merge import Merger


@pytest.mark.parametrize(
    ("words", "output", "worker"),
    [
        (("/merge/a", "/merge/b"), "/portsMerge/o0", "/portsMerge/i"),
        (
            ("--input", "/merge/a", "/merge/b", "--output", "/merge/o", "--worker", "/merge/w",
             "--carrier", "tcp"),
            "/merge/o",
            "/merge/w",
        ),
    ],
)  # fmt: skip
def test_two_sources(cli, names, words, output, worker):
    with (
        yarpy.Port("/merge/a", names=names) as a,
        yarpy.Port("/merge/b", names=names) as b,
        yarpy.BufferedPort("/merge/sink", strict=True, names=names) as sink,
        cli.start("merge", *words) as process,
    ):
        process.wait_line(f"^Ready. Output goes to {output}$", stream="out")
        carrier = "tcp" if "tcp" in words else "udp"
        assert [(link.name, link.carrier) for link in a.outputs] == [(f"{worker}0", carrier)]
        assert [link.name for link in b.outputs] == [f"{worker}1"]
        sink.listen_to(output)
        a.write([1, "x"])
        first = sink.read(timeout=HANG)
        assert first.value == [1, "x"]
        b.write([2.5])
        second = sink.read(timeout=HANG)
        assert second.value == [1, "x", 2.5]
        a.write([3])
        assert sink.read(timeout=HANG).value == [3, 2.5]
        assert first.stamp is not None and second.stamp is not None
        assert (first.stamp.count, second.stamp.count) == (0, 1)
        assert second.stamp.time >= first.stamp.time > 1e9


def test_no_ports(here):
    said = here("merge")
    assert (said.code, said.out) == (255, "") and "yarpy merge /port1" in said.err


def test_recordings_are_merged_elsewhere(here, tmp_path):
    file = tmp_path / "a.mcap"
    file.touch()
    said = here("merge", str(file), str(file), "-o", "b")
    assert said.code == 255 and "yarpy convert" in said.err


def test_a_source_that_is_not_there(here, names):
    said = here("merge", "/nobody")
    assert said.code == 255 and '"/nobody"' in said.err
    assert names.query("/portsMerge/o0") is None


def test_merger():
    sent = []
    merger = Merger(3, lambda value, stamp: sent.append((list(value), stamp.count)))
    merger.take(2, ["c"])
    merger.take(0, ["a", 1])
    merger.take(2, [])
    assert sent == [(["c"], 0), (["a", 1, "c"], 1), (["a", 1], 2)]
