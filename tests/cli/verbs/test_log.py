"""`yarpy log`."""

import json
import signal

import pytest
from support.cpp import CppYarp, MissingPeer
from support.cpp_program import CppProgram

import yarpy


def line(port, text, level="INFO", time=1795219554.5):
    told = yarpy.Bottle([["level", level], ["systemtime", time], ["message", text]])
    return yarpy.Bottle([f"[{port}]", told.to_text()])


def test_lines_of_all_that_log_as_people_and_programs_read_them(cli, names):
    with yarpy.Port("/log/vm/one/1", names=names) as one:
        with (
            cli.start("log") as plain,
            cli.start("log", "--json", "--level", "WARNING", "/log/*/one/*") as narrow,
        ):
            assert one.wait_for_outputs(2, timeout=20)
            with yarpy.Port("/yarprunlog/two", names=names) as two:  # comes later
                two.wait_for_outputs(1, timeout=20)
                two.write(["[/log/vm/two/2]", "[ERROR] worse"])
                plain.wait_line(r"^--:--:-- vm/two/2 \[ERROR\] worse$", stream="out")
            one.write(line("/log/vm/one/1", "hello\n00:00:00 forged [INFO] line \x1b[2J"))
            plain.wait_line(r" vm/one/1 \[INFO\] hello\\n00:00:00 forged", stream="out")
            one.write([1, 2, 3])  # no line
            one.write(line("/log/vm/one/1", "older", time=1.0))  # it was told before
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
        assert "older" not in plain.stdout


def test_no_server(lone):
    done = lone.run("log")
    assert (done.returncode, "yarpy server" in done.stderr) == (1, True)


def test_programs_of_cpp(cli, server, tmp_path):
    try:
        cpp = CppYarp.prepare(tmp_path)
    except MissingPeer as missing:
        pytest.skip(str(missing))
    with cli.start("log") as process:
        process.wait_line("Port /.* active", stream="err")
        told = {"YARP_FORWARD_LOG_ENABLE": "1", "YARP_FORWARD_HOSTNAME_ENABLE": "1"}
        with cpp.at("127.0.0.1", server.port, **told) as there, CppProgram(there) as program:
            program.do("yarp.Log('f', 3, 'g').warning('joint 3 is \"hot\"'); time.sleep(0.5)")
            process.wait_line(r"\[WARNING\] joint 3 is \"hot\"$", stream="out")
