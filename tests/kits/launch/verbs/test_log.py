"""`yarpy log`."""

import json
import signal
from functools import partial
from urllib.request import urlopen

import pytest
from support.cpp import CppYarp
from support.cpp_program import CppProgram
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits.launch.log.collector import LogCollector
from yarpy.kits.launch.verbs import log
from yarpy.port.assembly import open_hub
from yarpy.port.keep.log_sender import LogSender
from yarpy.wire.message import Packet


def line(port, text, level="INFO", time=1795219554.5):
    told = yarpy.Bottle([["level", level], ["systemtime", time], ["message", text]])
    return yarpy.Bottle([f"[{port}]", told.to_text()])


def test_lines_of_all_that_log_as_people_and_programs_read_them(cli, names):
    with yarpy.Port("/log/vm/one/1", names=names) as one:
        with (
            cli.start("log") as plain,
            cli.start("log", "--json", "--level", "WARNING", "/log/*/one/*") as narrow,
        ):
            assert one.wait_for_outputs(2, timeout=HANG)
            with yarpy.Port("/yarprunlog/two", names=names) as two:  # comes later
                two.wait_for_outputs(1, timeout=HANG)
                two.write(["[/log/vm/two/2]", "[ERROR] worse"])
                plain.wait_line(r"^--:--:-- vm/two/2 \[ERROR\] worse$", stream="out")
            one.write(line("/log/vm/one/1", "hello\n00:00:00 forged [INFO] line \x1b[2J"))
            plain.wait_line(r" vm/one/1 \[INFO\] hello\\n00:00:00 forged", stream="out")
            one.write([1, 2, 3])  # no line
            one.write(line("/log/vm/one/1", "hello\n00:00:00 forged [INFO] line \x1b[2J"))  # again
            one.write(line("/log/vm/one/1", "hot", "WARNING", 1795219555.5))
            found = json.loads(narrow.wait_line(r"^\{", stream="out").string)
            assert found == {
                "port": "/log/vm/one/1",
                "level": "WARNING",
                "time": 1795219555.5,
                "component": "",
                "message": "hot",
            }
            plain.wait_line(r"\[WARNING\] hot$", stream="out")
            for process in (plain, narrow):
                process.signal(signal.SIGINT)
                assert process.wait() == 0
        assert "\x1b" not in plain.stdout
        assert plain.stdout.count("hello") == 1


def test_no_server(lone):
    done = lone.run("log")
    assert (done.returncode, "yarpy server" in done.stderr) == (1, True)


@pytest.mark.peer("cpp")
def test_programs_of_cpp(cli, server, tmp_path):
    cpp = CppYarp.prepare(tmp_path)
    with cli.start("log") as process:
        process.wait_line("Port /.* active", stream="err")
        told = {"YARP_FORWARD_LOG_ENABLE": "1", "YARP_FORWARD_HOSTNAME_ENABLE": "1"}
        with cpp.at("127.0.0.1", server.port, **told) as there, CppProgram(there) as program:
            program.do("yarp.Log('f', 3, 'g').warning('joint 3 is \"hot\"'); time.sleep(0.5)")
            process.wait_line(r"\[WARNING\] joint 3 is \"hot\"$", stream="out")


def test_filters_and_files(cli, names, tmp_path):
    files = [tmp_path / name for name in ("x.log", "x.json")]
    words = [word for file in files for word in ("-o", str(file))]
    with yarpy.Port("/log/vm/three/3", names=names) as three:
        options = ("--program", "three", "--grep", "wanted", "--name", "/mine", *words)
        with cli.start("log", *options) as process:
            assert three.wait_for_outputs(timeout=HANG)
            three.write(line("/log/vm/three/3", "other", time=1795219554.5))
            three.write(line("/log/vm/three/3", "Wanted", time=1795219555.5))
            process.wait_line(r" vm/three/3 \[INFO\] Wanted$", stream="out")
            process.signal(signal.SIGINT)
            assert process.wait() == 0, process.stderr
    assert "other" not in process.stdout
    assert files[0].read_text().endswith(" vm/three/3 [INFO] Wanted\n")
    assert json.loads(files[1].read_text())["message"] == "Wanted"
    again = cli.run("log", *words)
    assert again.returncode == 1 and "x.log" in again.stderr


def test_no_follow_ends_when_all_is_told(here, names, monkeypatch):
    waits = []

    def wait(collector, timeout):
        """A silence comes when the line has come, and not while a busy machine is slow."""
        if timeout != log.QUIET:
            return until(collector, timeout)
        waits.append(timeout)
        return until(collector, 0.0 if collector.taken else HANG)

    until = LogCollector.wait
    monkeypatch.setattr(LogCollector, "wait", wait)
    sender = LogSender(partial(open_hub, names=names), "/log/vm/four/4", yarpy.Bottle)
    sender.put([Packet(line("/log/vm/four/4", "last"))])
    done = here("log", "--no-follow", "--colour", "/four/")
    sender.close()
    assert done.code == 0 and "[\x1b[1;34mINFO\x1b[0m] last" in done.out
    assert waits
    assert "no regular expression" in here("log", "--grep", "(").err


def test_the_page_shows_all_of_it(cli, names):
    with (
        yarpy.Port("/log/vm/shown/1", names=names) as one,
        cli.start("log", "--page", "--quiet", "/log/*/shown/*") as process,
    ):
        url = process.wait_line(r"is shown at (http://127\.0\.0\.1:\d+/)", stream="out")[1]
        assert one.wait_for_outputs(1, timeout=HANG)
        one.write(line("/log/vm/shown/1", "hello"))

        def shown() -> list[str]:
            with urlopen(f"{url}lines?most=9", timeout=HANG) as reply:
                return [each[-1] for each in json.load(reply)["lines"]]

        wait_until(lambda: shown() == ["hello"])
        process.signal(signal.SIGINT)
        assert process.wait() == 0
