"""What is asked of a server, and how it answers."""

from yarpy.data.bottle import Bottle
from yarpy.kits.launch.run import request


def test_the_word_that_counts() -> None:
    found = request.read(Bottle.from_text('(on /h) (as tag1) (cmd "sleep 60") (env "A=b")'))
    assert found.verb == "cmd" and found.command == "sleep 60"
    assert (found.text("as"), found.text("env"), found.text("workdir")) == ("tag1", "A=b", "")
    assert request.read(Bottle.from_text("(cmd x) (stdio /t)")).verb == "stdio"
    assert request.read(Bottle.from_text("(cmd sleep 60)")).command == "sleep 60"
    found = request.read(Bottle.from_text("(on /h) (kill tag 9)"))
    assert (found.verb, found.text("kill"), found.number("kill", 1)) == ("kill", "tag", 9)
    assert found.number("kill") == found.number("ps") == 0 and "kill" in found


def test_what_is_no_request() -> None:
    for value in (Bottle(), Bottle.from_text("cmd x"), Bottle.from_text("(nothing)"), 7, "ps"):
        assert request.read(value).verb == ""
    assert request.read(Bottle.from_text("(kill tag yes)")).number("kill", 1) == 0


def test_answers() -> None:
    text = "STARTED: server=/n alias=t cmd=sleep 6 pid=7\n"
    assert request.started("/n", "t", "sleep 6", 7) == [7, text]
    assert request.started("/n", "t", "sleep 6", 7, "/u") == [7, text, "/u"]
    answer = request.aborted("/n", "t", "x", "so")
    assert answer == [-1, "ABORTED: server=/n alias=t cmd=x\nCan't execute command because so\n"]
