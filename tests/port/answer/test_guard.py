"""What peers get that may not do everything, over every protocol in its own way."""

from __future__ import annotations

import logging
import socket
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.access import allow, write
from support.guest import guest
from support.tls import prepare
from support.wait import HANG, wait_until

import yarpy
from yarpy.contact import Contact
from yarpy.monitors.chain import Chain
from yarpy.port.answer import admin, guard
from yarpy.port.connect import probe

FAR = "127.0.0.2"  # an address that tests dial from, as if it were another computer
NEAR = '[[allow]]\nwho = "127.0.0.1"\nmay = "all"\n'


@pytest.fixture
def names() -> yarpy.LocalNames:
    return yarpy.LocalNames()


def rules(folder: Path, monkeypatch: pytest.MonkeyPatch, *may: str, ports: str = "*") -> None:
    """This program may do everything; who dials from FAR, what is listed."""
    listed = ", ".join(f'"{right}"' for right in may)
    far = f'[[allow]]\nwho = "{FAR}"\nmay = [{listed}]\nports = "{ports}"\n' if may else ""
    write(folder, monkeypatch, NEAR + far)


class Person:
    """Somebody at a terminal of another computer."""

    def __init__(self, port: yarpy.Port, name: str = "me") -> None:
        where = "127.0.0.1", port.contact.port
        self.sock = socket.create_connection(where, HANG, source_address=(FAR, 0))
        self.file = self.sock.makefile("rwb")
        self.say(f"CONNECT {name}")
        self.welcome = self.hear()

    def say(self, *lines: str) -> None:
        self.file.write("".join(f"{line}\r\n" for line in lines).encode())
        self.file.flush()

    def hear(self) -> str:
        return self.file.readline().decode().rstrip("\r\n")

    def __enter__(self) -> Person:
        return self

    def __exit__(self, *details: object) -> None:
        self.file.close()
        self.sock.close()


@pytest.fixture
def port(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, names: yarpy.LocalNames
) -> Iterator[yarpy.Port]:
    """A port that others may read."""
    rules(tmp_path, monkeypatch, "read")
    with yarpy.Port("/arm", names=names) as port:
        yield port


# -- what is refused ------------------------------------------------------------------------------


CARRIERS = ["tcp", "fast_tcp", "udp", "unix_stream", "text_ack", "local"]


@pytest.mark.parametrize("carrier", CARRIERS)
def test_a_writer_is_told_so_when_it_connects(
    carrier: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, names: yarpy.LocalNames
) -> None:
    allow(tmp_path, monkeypatch, "read")
    with yarpy.Port("/in", names=names) as reader, yarpy.Port("/out", names=names) as writer:
        with pytest.raises(
            yarpy.AccessRefused, match="Access refused: this computer may not write"
        ):
            writer.connect("/in", carrier, timeout=HANG)  # and it is not tried again
        assert not writer.outputs
        assert "/out" not in [link.source for link in reader.inputs]
        with pytest.raises(yarpy.AccessRefused, match="may not write to /in"):
            yarpy.connect("/out", "/in", carrier, names=names)


def test_monitors_of_a_sender_need_attach(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, names: yarpy.LocalNames
) -> None:
    allow(tmp_path, monkeypatch, "read write")
    with yarpy.Port("/in", names=names), yarpy.Port("/out", names=names) as writer:
        with pytest.raises(yarpy.AccessRefused, match="may not attach monitors to /in"):
            writer.connect("/in", "tcp+recv.priority")
        writer.connect("/in")
        assert len(writer.outputs) == 1


def test_a_message_without_leave_ends_the_connection(
    port: yarpy.Port, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.WARNING)
    for _ in range(3):
        with Person(port) as person:
            assert person.welcome == "Welcome me"
            person.say("d", "hello")
            answer = person.hear()
            assert "Access refused: this computer may not write to /arm, only read" in answer
            assert person.hear() == ""
    wait_until(lambda: not port.inputs)
    assert port.stats.past.inputs.drops == 3
    refused = [r.getMessage() for r in caplog.records if "refused" in r.getMessage()]
    assert len(refused) == 1  # one line, however often


def test_a_port_of_another_computer_does_not_get_in(port: yarpy.Port) -> None:
    with Person(port, "/walk") as person:
        assert person.welcome.startswith("* Access refused: ")
        assert person.hear() == ""


@pytest.mark.parametrize("command", ["/walk", "!/walk", "~/walk"])
def test_commands_are_answered_and_the_connection_goes_on(port: yarpy.Port, command: str) -> None:
    with Person(port) as person:
        person.say(command)
        assert "may not administer /arm, only read" in person.hear()
        person.say("*")
        assert person.hear().startswith("This is /arm at ")
        assert "no outgoing connections" in person.hear()


@pytest.mark.parametrize(
    ("question", "right"),
    [
        ("add /walk", "administer"),
        ("del /walk", "administer"),
        ("prop set note 5", "administer"),
        ("prop set /arm (sched ((priority 5)))", "administer"),
        ("set in /walk (tc 1)", "administer"),
        ("atch in (type dll) (file priority)", "attach"),
        ("dtch in", "attach"),
        ("dance", "write to"),  # whatever the program itself understands
        ("publisherUpdate x", "administer"),
    ],
)
def test_administration_is_answered_with_fail(port: yarpy.Port, question: str, right: str) -> None:
    port.on_admin(lambda message: ["danced"])
    with Person(port) as person:
        person.say("a", question)
        answer = yarpy.Bottle.from_text(person.hear())
        assert answer[0] == yarpy.Vocab("fail")
        assert answer[1].startswith(f"Access refused: this computer may not {right} ")


@pytest.mark.parametrize(
    "question",
    ["help", "ver", "list in", "list out", "stat", "prop get", "prop get /arm", "getPid"],
)
def test_questions_are_for_whoever_may_do_anything(port: yarpy.Port, question: str) -> None:
    if question == "getPid":
        guest("ros")
    with Person(port) as person:
        person.say("a", question)
        assert "fail" not in person.hear()


def test_every_administrative_request_is_judged() -> None:
    """A request that is new has to be thought of here; `prop` is both."""
    assert {*admin._HANDLERS} <= guard.QUESTIONS | guard.CHANGES | guard.MONITORS


def test_strangers_learn_the_name_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, names: yarpy.LocalNames
) -> None:
    rules(tmp_path, monkeypatch)
    with yarpy.Port("/arm", names=names) as port, Person(port) as person:
        person.say("*")
        assert person.hear() == f"This is /arm at tcp://{port.address}/"
        assert "may not ask anything of /arm" in person.hear()
        person.say("a", "list in")
        assert "Access refused" in person.hear()
        person.say("r")
        assert "may not read /arm" in person.hear()


def test_a_call_is_answered(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, names: yarpy.LocalNames
) -> None:
    allow(tmp_path, monkeypatch, "read")
    with yarpy.RpcServer("/arm", lambda message: ["moved"], names=names) as server:
        for carrier in ("tcp", "text_ack"):
            with probe.Caller(Contact("tcp", "/arm", *where(server)), carrier=carrier) as caller:
                answer = caller.ask(["up"], HANG)
                assert answer is not None
                assert answer.value[0] == yarpy.Vocab("fail")
                assert "may not write to /arm" in answer.value[1]


def where(port: yarpy.Port | yarpy.RpcServer) -> tuple[str, int]:
    return port.contact.host, port.contact.port


# -- what is allowed ------------------------------------------------------------------------------


def test_a_reader_reads(port: yarpy.Port) -> None:
    with Person(port) as person:
        person.say("r")
        wait_until(lambda: len(port.outputs) == 1)
        port.write(["hello"])
        heard = person.hear(), person.hear()
        assert "hello" in heard


def test_a_reader_has_the_port_connected_to_its_own_computer(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, names: yarpy.LocalNames
) -> None:
    write(
        tmp_path,
        monkeypatch,
        '[[allow]]\nwho = "loopback"\nmay = "read"\nports = "/cam"\n'
        '[[allow]]\nwho = "loopback"\nmay = "all"\nports = "/view"\n',
    )
    with yarpy.Port("/cam", names=names) as camera, yarpy.Port("/view", names=names) as view:
        view.listen_to("/cam")
        camera.write(["picture"])
        assert view.read(timeout=HANG).value == ["picture"]
        assert yarpy.admin("/cam", "del", "/view", names=names)[0] == 0
        wait_until(lambda: not camera.outputs)
        with pytest.raises(yarpy.AccessRefused, match="may not attach monitors to /cam"):
            view.listen_to("/cam", "tcp+send.throttle_down")
        with pytest.raises(yarpy.AccessRefused, match="may not administer /cam"):
            yarpy.connect("/cam", "/view", "tcp+log.in", names=names)
        names.register("/elsewhere", "tcp", "192.0.2.1", 5)
        with pytest.raises(yarpy.AccessRefused, match="may not administer /cam"):
            yarpy.connect("/cam", "/elsewhere", names=names)


def test_a_port_is_made_to_receive_only_by_a_writer(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, names: yarpy.LocalNames
) -> None:
    """Over mjpeg and the like, who is connected to receives."""
    other = '[[allow]]\nwho = "loopback"\nmay = "all"\nports = "/cam"\n'
    rule = '[[allow]]\nwho = "loopback"\nmay = "{}"\nports = "/view"\n'
    write(tmp_path, monkeypatch, other + rule.format("read"))
    with yarpy.Port("/cam", names=names), yarpy.Port("/view", names=names) as view:
        for spelled in ("mjpeg", ["mjpeg"], "mjpeg+quality.5"):
            answer = yarpy.admin("/view", "add", "/cam", spelled, names=names)
            assert "may not write to /view" in answer[1]
        # What is dialled is what was judged, however it is spelled.
        for target, carrier in (("mqtt+sub://127.0.0.1:1/x", "mqtt"), ("zenoh+sub://x", "zenoh")):
            answer = yarpy.admin("/view", "add", target, carrier, names=names)
            assert "no carrier" in answer[1] or "may not" in answer[1]
        for carrier in ("mjpeg", "mjpeg+recv.priority"):
            with pytest.raises(yarpy.AccessRefused, match=r"may not (write to|attach monitors to)"):
                yarpy.connect("/cam", "/view", carrier, names=names)
        assert not view.inputs
    write(tmp_path, monkeypatch, other + rule.format("write"))
    with yarpy.Port("/cam", names=names), yarpy.Port("/view", names=names) as view:
        yarpy.connect("/cam", "/view", "mjpeg", names=names)
        wait_until(lambda: [link.source for link in view.inputs] == ["/cam"])


def test_a_name_server_is_connected_by_its_administrators_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Who may register may give commands, which are messages; its events are not for all."""
    allow(tmp_path, monkeypatch, "register")
    with yarpy.NameServer() as server, yarpy.Port("/mine") as mine:
        for request in (["add", "/mine"], ["add", "/mine", "udp"], ["add", "/mine", "mjpeg"]):
            answer = yarpy.admin("/root", *request)
            assert "may not administer /root" in answer[1]
        host, number = server.address.split(":")
        with socket.create_connection((host, int(number)), HANG) as sock:
            sock.sendall(b"CONNECT me\r\n/mine\r\n")
            file = sock.makefile("rb")
            assert file.readline() == b"Welcome me\r\n"
            assert b"may not administer /root" in file.readline()
            file.close()
        assert not server.hub.outputs.links
        assert not mine.inputs


def test_a_writer_ends_what_it_began(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, names: yarpy.LocalNames
) -> None:
    allow(tmp_path, monkeypatch, "write")
    with yarpy.Port("/in", names=names) as reader, yarpy.Port("/out", names=names) as writer:
        writer.connect("/in", "udp")
        wait_until(lambda: len(reader.inputs) == 1)
        writer.write(["hello"])
        assert reader.read(timeout=HANG).value == ["hello"]
        writer.disconnect("/in")
        wait_until(lambda: not reader.inputs)


def test_rules_are_for_ports_by_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, names: yarpy.LocalNames
) -> None:
    rules(tmp_path, monkeypatch, "write", ports="/robot/*")
    with (
        yarpy.BufferedPort("/robot/arm", names=names) as arm,
        yarpy.BufferedPort("/other", names=names) as other,
    ):
        with Person(arm) as person:
            person.say("do", "up")
            assert arm.read(timeout=HANG).value == ["up"]
        with Person(other) as person:
            person.say("do", "up")
            assert "Access refused" in person.hear()


def test_a_guarded_port_costs_nothing_for_each_message(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, names: yarpy.LocalNames
) -> None:
    """Who may do everything has an ordinary connection."""
    rules(tmp_path, monkeypatch, "read")
    with yarpy.Port("/in", names=names) as reader, yarpy.Port("/out", names=names) as writer:
        writer.connect("/in")
        wait_until(lambda: len(reader.inputs) == 1)
        link = reader.inputs[0]._link
        assert link.advance == link.receiver.advance
        assert link.answer == link.carry_out


# -- what is not to be noticed by others ----------------------------------------------------------


def test_monitors_see_no_message_that_is_refused(port: yarpy.Port) -> None:
    class Counting:
        seen = 0

        def accept(self, message: yarpy.Message) -> bool:
            self.seen += 1
            return True

    counting = Counting()
    port._hub.monitoring.input = Chain([counting], "test")
    with Person(port) as person:
        person.say("d", "hello")
        assert "Access refused" in person.hear()
        assert person.hear() == ""
    assert counting.seen == 0


@pytest.mark.parametrize(
    ("name", "right"), [("me (send throttle_down)", "attach"), ("me (log in)", "administer")]
)
def test_readers_with_more_in_mind_need_more(port: yarpy.Port, name: str, right: str) -> None:
    with Person(port, name) as person:
        assert person.welcome == "Welcome me"
        person.say("r")
        assert f"may not {right}" in person.hear()
        person.say("?")
        assert person.hear() == "This is a YARP port.  Here are the commands it responds to:"
    assert port.outputs == []


def test_nobody_is_displaced_by_who_may_not_write(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, names: yarpy.LocalNames
) -> None:
    rules(tmp_path, monkeypatch, "read")
    with yarpy.Port("/in", names=names) as reader, yarpy.Port("/walk", names=names) as walk:
        walk.connect("/in")
        wait_until(lambda: len(reader.inputs) == 1)
        with Person(reader, "/walk") as person:
            assert "Access refused" in person.welcome
        walk.write([1])
        assert reader.read(timeout=HANG).value == [1]


# -- who is who -----------------------------------------------------------------------------------


def test_who_knows_the_key(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, names: yarpy.LocalNames
) -> None:
    allow(tmp_path, monkeypatch, "write", who="key")
    with yarpy.Port("/in", names=names), yarpy.Port("/out", names=names) as writer:
        with pytest.raises(yarpy.AccessRefused):
            writer.connect("/in")
        assert not writer.outputs
    monkeypatch.setenv("YARP_CONFIG_HOME", str(tmp_path))
    (tmp_path / "auth.conf").write_text("[AUTH]\nkey secret\n")
    with yarpy.Port("/in", names=names) as reader, yarpy.Port("/out", names=names) as writer:
        writer.connect("/in")
        writer.write([1])
        assert reader.read(timeout=HANG).value == [1]


def test_who_shows_a_certificate(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, names: yarpy.LocalNames
) -> None:
    """Nothing but the rule asks for it; without TLS there is none."""
    prepare(tmp_path / "tls", monkeypatch)
    allow(tmp_path, monkeypatch, "write", who="tls:localhost")
    with yarpy.Port("/in", names=names) as reader, yarpy.Port("/out", names=names) as writer:
        with pytest.raises(yarpy.AccessRefused):
            writer.connect("/in")
        writer.connect("/in", "tls")
        writer.write([1])
        assert reader.read(timeout=HANG).value == [1]
