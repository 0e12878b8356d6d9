"""`yarpy read`."""

import json
import re
import signal

import numpy as np
import pytest
from support.system import NO_MEMFD
from support.wait import HANG, wait_until

import yarpy
from yarpy.cli.verbs.read import Intent, Printer, parse_words


@pytest.fixture(scope="module")
def one_writer(names):
    with yarpy.Port("/read/writer", names=names) as port:
        yield port


@pytest.fixture
def writer(one_writer):
    # A reader of the test before that was killed, as all are on Windows, still counts for a moment.
    wait_until(lambda: not one_writer.outputs)
    return one_writer


def test_prints_what_arrives(cli, writer):
    """The messages of the recorded `yarp read`, and its lines."""
    with cli.start("read", "/read/a", "/read/writer") as process:
        assert writer.wait_for_outputs(timeout=HANG)
        for text in ("1 ping 3.14", "hello", "(a (1 2)) [set]", '"two words" ""', "", "x"):
            writer.write(yarpy.Bottle.from_text(text))
        writer.write(yarpy.Stamp(7, 1.25))
        writer.write(yarpy.Vector([0.5, 1.5]))
        writer.write([0, "plain text"])
        writer.write([7, "hello"])
        writer.write([0, 5])
        writer.write([-1, ""])
        writer.write([2, "caf\udce9"])
        writer.write(yarpy.Bottle.from_text("last"))
        process.wait_line("^last$", stream="out")
        process.signal(signal.SIGINT)
        assert process.wait() == 0
    assert process.stdout == (
        "1 ping 3.14000000000000012434\n"
        "hello\n"
        "(a (1 2)) [set]\n"
        '"two words" ""\n'
        "\n"
        "x\n"
        "7 1.25\n"
        "0.5 1.5\n"
        "plain text\n"
        "hello\n"
        "0 5\n"
        "\n"
        "caf\udce9\n"
        "last\n"
    )
    lines = process.stderr.splitlines()
    assert lines[0].startswith("[INFO] Port /read/a active at tcp://127.0.0.1:")
    carrier = "tcp" if NO_MEMFD else "memory"
    assert lines[1] == f"[INFO] Receiving input from /read/writer to /read/a using {carrier}"
    assert "Interrupting..." in lines


def test_image_is_told_in_short(cli, writer):
    numpy = pytest.importorskip("numpy")
    with cli.start("read", "/read/b", "/read/writer", "once") as process:
        assert writer.wait_for_outputs(timeout=HANG)
        writer.write(yarpy.Image(numpy.zeros((1, 2, 3), numpy.uint8)))
        assert process.wait() == 0
    assert re.fullmatch(r"<image rgb 2x1, \d+ bytes>\n", process.stdout)


def test_the_end_of_verbatim_lines_ends_it(cli, writer):
    with cli.start("read", "/read/c", "/read/writer") as process:
        assert writer.wait_for_outputs(timeout=HANG)
        writer.write([0, "line"])
        writer.write([1, "<EOF>"])
        assert process.wait() == 0
    assert process.stdout == "line\n"


def test_envelope_trim_and_once(cli, writer):
    words = ("read", "/read/d", "envelope", "trim", "10", "/read/writer", "once")
    with cli.start(*words) as process:
        assert writer.wait_for_outputs(timeout=HANG)
        writer.write(yarpy.Bottle.from_text("1 ping 3.14"), yarpy.Stamp(3, 4.5))
        assert process.wait() == 0
    assert process.stdout == "3 4.5 \n1 ping 3.1\n"


def test_json(cli, writer):
    with cli.start("read", "--json", "/read/e", "/read/writer") as process:
        assert writer.wait_for_outputs(timeout=HANG)
        writer.write(yarpy.Bottle(["x", 1, [2.5]]), yarpy.Stamp(3, 4.5))
        writer.write([0, "a line"])
        process.wait_line("line", stream="out")
    assert [json.loads(line) for line in process.stdout.splitlines()] == [
        {"source": "/read/writer", "envelope": "3 4.5", "value": ["x", 1, [2.5]]},
        {"source": "/read/writer", "envelope": "", "value": "a line"},
    ]


def test_what_is_no_list_is_shown_by_what_it_is(cli, writer):
    sound = yarpy.Sound([[1, 2, 3], [4, 5, 6]], 8000)
    with cli.start("read", "/read/s", "/read/writer") as process:
        assert writer.wait_for_outputs(timeout=HANG)
        writer.write(sound)
        writer.write(yarpy.Sound([7]))
        process.wait_line("1 samples", stream="out")
    assert process.stdout == (
        "<sound 8000 Hz, 2 channels, 3 samples>\n<sound 16000 Hz, 1 channel, 1 samples>\n"
    )
    assert "cannot be printed" not in process.stderr


def test_a_point_cloud(cli, writer):
    cloud = yarpy.PointCloud(np.arange(6.0).reshape(1, 2, 3))
    with cli.start("read", "/read/p", "/read/writer") as process:
        assert writer.wait_for_outputs(timeout=HANG)
        writer.write(cloud)
        process.wait_line("^<pointcloud xyz 2x1, 2 points>$", stream="out")
    wait_until(lambda: not writer.outputs)
    with cli.start("read", "--json", "/read/q", "/read/writer", "once") as process:
        assert writer.wait_for_outputs(timeout=HANG)
        writer.write(cloud)
        assert process.wait(HANG) == 0
    assert json.loads(process.stdout)["value"] == {
        "type": "pointcloud",
        "kind": "xyz",
        "width": 2,
        "height": 1,
        "points": [[0.0, 1.0, 2.0], [3.0, 4.0, 5.0]],
    }
    assert "cannot be printed" not in process.stderr


def test_what_python_alone_has_is_shown_without_its_description(cli, writer):
    sent = [
        [1, None],
        {"t": (1, 2.5)},
        2.5 - 1j,
        np.array([[1, 2], [3, 4]], "i8"),
        np.zeros((3, 7), "i8"),
        {"a": np.array([1, 2], "u1"), "s": yarpy.Sound([3])},
    ]
    with cli.start("read", "/read/d", "/read/writer") as process:
        assert writer.wait_for_outputs(timeout=HANG)
        for value in sent:
            writer.write(value)
        process.wait_line("sound", stream="out")
    assert process.stdout.splitlines() == [
        "1 ()",
        "(t (1 2.5))",
        "(2.5 -1.0)",
        "((1 2) (3 4))",
        "<array int64 3x7>",
        '(a (1 2)) (s "<sound 16000 Hz, 1 channel, 1 samples>")',
    ]


def test_json_of_what_python_alone_has(cli, writer):
    sent = [
        yarpy.Sound([1, 2], 8000),
        [None, True, float("nan"), yarpy.Vocab("ok"), b"x"],
        {1: 2},
        {"a b": (1, None)},
        2.5 - 1j,
        {"array": np.array([1, 2], "u1"), "sound": yarpy.Sound([3])},
    ]
    with cli.start("read", "--json", "/read/j", "/read/writer") as process:
        assert writer.wait_for_outputs(timeout=HANG)
        for value in sent:
            writer.write(value)
        process.wait_line('"sound": {"type": "sound"', stream="out")
    assert [json.loads(line)["value"] for line in process.stdout.splitlines()] == [
        {"type": "sound", "frequency": 8000, "channels": [[1, 2]]},
        [None, True, "nan", "[ok]", {"type": "blob", "base64": "eA=="}],
        {"1": 2},
        {"a b": [1, None]},
        [2.5, -1.0],
        {
            "array": {"type": "array", "dtype": "|u1", "shape": [2], "base64": "AQI="},
            "sound": {"type": "sound", "frequency": 16000, "channels": [[3]]},
        },
    ]


def test_keeps_every_message(cli, writer):
    with cli.start("read", "/read/f", "/read/writer") as process:
        assert writer.wait_for_outputs(timeout=HANG)
        for number in range(2000):
            writer.write([number])
        process.wait_line("^1999$", stream="out")
    assert process.stdout == "".join(f"{number}\n" for number in range(2000))


def test_what_is_no_bottle_does_not_end_it(cli, writer):
    class Odd:
        def to_wire(self):
            return (b"\xff" * 20,)

    with cli.start("read", "/read/g", "/read/writer") as process:
        assert writer.wait_for_outputs(timeout=HANG)
        writer.write(Odd())
        writer.write(["x"])
        process.wait_line("^x$", stream="out")
        process.wait_line("error: a message from /read/writer cannot be printed: ", stream="err")


def test_a_living_name_is_refused_with_the_hint(cli, writer):
    with cli.start("read", "/read/writer") as process:  # as another program
        assert process.wait(HANG) == 1
    assert process.stdout == ""
    assert "is in use" in process.stderr and "`yarpy read ... /read/writer`" in process.stderr


def test_a_name_that_cannot_be_one(here):
    said = here("read", "noslash")
    assert said.code == 1 and 'must start with "/"' in said.err


def test_a_remote_that_is_not_there_is_only_told(cli, names):
    with cli.start("read", "/read/h", "/nobody", "once") as process:
        process.wait_line('error: no port "/nobody"', stream="err")
        process.wait_line("waiting for .*: yarpy connect /PORT /read/h$", stream="err")
        with yarpy.Port("/read/late", names=names) as late:
            late.connect("/read/h")
            late.write(["x"])
            assert process.wait() == 0
    assert process.stdout == "x\n"


def test_without_a_name_server(lone):
    """Ports talk by address."""
    with (
        yarpy.Port("", names=None) as writer,
        lone.start("read", "...", f"/{writer.address}") as process,
    ):
        assert writer.wait_for_outputs(timeout=HANG)
        writer.write(["x"])
        process.wait_line("^x$", stream="out")


@pytest.mark.parametrize(
    ("words", "intent"),
    [
        ([], Intent()),
        (["/a", "envelope", "/b"], Intent(["/a", "/b"], envelope=True)),
        (["trim"], Intent(trim=80)),
        (["trim", "once"], Intent(trim=80, once=True)),
        (["once", "trim", "5", "/a"], Intent(["/a"], trim=5, once=True)),
    ],
)
def test_words(words, intent):
    assert parse_words(words) == intent


@pytest.mark.parametrize(
    ("value", "line"),
    [
        (yarpy.Bottle([True, "x"]), "true x\n"),
        (yarpy.Bottle([1, yarpy.Vocab("x")]), "1 [x]\n"),
        (yarpy.Bottle([1.0, "x"]), "1.0 x\n"),
        (yarpy.Bottle([2, "x", 3]), "2 x 3\n"),
    ],
)
def test_only_an_integer_and_a_string_are_verbatim(capsys, value, line):
    message = yarpy.Message("D", value, spelling="object")
    assert Printer().show(message) is True
    assert capsys.readouterr().out == line


def test_a_word_that_can_never_become_right_ends_it(here):
    code, _, err = here("read", "/read/x", "onse")
    assert code == 1 and "error: invalid source" in err
