"""The ports of a control board: people, browsers, streams; and that nothing is left behind."""

import json
import logging
import re
import socket
import threading
from http.client import HTTPConnection

import pytest
from support.board import Bare, FakeBoard
from support.capture import load_capture
from support.wait import HANG, wait_until

import yarpy
from yarpy import Bottle, Vocab
from yarpy.errors import AddressError, UnknownName
from yarpy.kits.devices.control_board.server import ControlBoardServer
from yarpy.kits.devices.control_board.state import State


@pytest.fixture
def device():
    return FakeBoard(3)


@pytest.fixture
def server(device, names):
    with ControlBoardServer("/cap/mc", device, 0.005, names=names) as server:
        yield server


def query(names, port):
    contact = names.query(port)
    assert contact is not None
    return contact.host, contact.port


TIMES = re.compile(rb"1795224\d{3}\.\d+|\d{10}\.\d+")


@pytest.mark.parametrize("pieces", [0, 1])
def test_recorded_telnet_session(server, device, names, pieces):
    """Byte for byte but for the time of day, and for [help] [more], where ours lists more."""
    device.axis_names[:] = ["joint0", "joint1", "joint2"]
    capture = load_capture("mc_rpc_text")
    with socket.create_connection(query(names, "/cap/mc/rpc:i"), HANG) as line:
        line.settimeout(HANG)
        stream = line.makefile("rb")
        # The recorded board had been asked five questions, and stood at 3.5 degrees.
        line.sendall(capture.steps[0].data)
        assert stream.readline() == capture.steps[1].data
        for _ in range(5):
            line.sendall(b"d\r\nget axes\r\n")
            assert stream.readline().startswith(b"[is] axes 3 ")
            assert stream.readline() == b"<ACK>\r\n"
        device.where[0] = 3.5
        for asked, answered in zip(capture.steps[2::2], capture.steps[3::2], strict=True):
            if pieces:
                for byte in asked.data:
                    line.sendall(bytes([byte]))
            else:
                line.sendall(asked.data)
            said = b""
            while not said.endswith(b"<ACK>\r\n"):
                said += stream.readline()
            if b"more" in asked.data:
                assert said.startswith(b'[help] [all]\r\n"   these lines"\r\n[help] [more]\r\n')
                assert said.endswith(b"[ok]\r\n<ACK>\r\n")
                continue
            theirs = answered.data.replace(b"joint1 ", b"joint0 ")
            assert TIMES.sub(b"t", said) == TIMES.sub(b"t", theirs)


HTTP = ["http_mc_get_encs", "http_mc_get_pos", "http_mc_set_pos", "http_mc_set_vocab",
        "http_mc_bad", "http_mc_ver", "http_mc_html_get_encs"]  # fmt: skip


@pytest.mark.parametrize("name", HTTP)
def test_recorded_browsers(server, device, names, name):
    capture = load_capture(name)
    target = capture.steps[0].data.split()[1].decode()
    theirs = capture.steps[1].data.decode()
    where = re.search(r"[\[(](\d+\.\d)[, ]", theirs) or re.search(r'"enc", (\d\.\d)', theirs)
    device.where[0] = float(where[1]) if where else 0.0
    web = HTTPConnection(*query(names, "/cap/mc/rpc:i"), timeout=HANG)
    web.request("GET", target)
    response = web.getresponse()
    body = response.read().decode()
    web.close()
    assert response.status == 200
    if "data=" in target:
        shown = re.search(r"\[is\] encs \(.*?\)", theirs)
        assert shown is not None and shown[0] in body
        return
    ours, recorded = json.loads(body), json.loads(theirs.partition("\n\n")[2])
    if "tsta" in recorded:
        ours[4:6] = recorded[4:6]
    assert ours == recorded
    if name.startswith("http_mc_set"):
        assert device.where[0] == (5.0 if name == "http_mc_set_pos" else 3.5)


def test_people_in_browsers_get_help(server, names):
    """C++ shows the first line of it."""
    web = HTTPConnection(*query(names, "/cap/mc/rpc:i"), timeout=HANG)
    web.request("GET", "/?req=help")
    body = json.loads(web.getresponse().read())
    web.request("GET", "/?data=help")
    page = web.getresponse().read().decode()
    web.close()
    assert "[get] [encs]" in body
    assert "[set] [poss] (values)" in page


def test_help_for_people_who_type_is_lines(server, names):
    with socket.create_connection(query(names, "/cap/mc/rpc:i"), HANG) as line:
        line.settimeout(HANG)
        stream = line.makefile("rb")
        line.sendall(b"CONNECT me\r\nd\r\nhelp all\r\n")
        assert stream.readline() == b"Welcome me\r\n"
        assert stream.readline() == b'"[help] [all]"\r\n'
        while (said := stream.readline()) != b"[ok]\r\n":
            assert said.startswith(b'"[')


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "udp", "mcast", "unix_stream"])
def test_streamed_commands(server, device, names, carrier):
    with yarpy.Port("/joystick", names=names) as port:
        port.connect("/cap/mc/command:i", carrier)
        port.write([[Vocab("vmos")], [1.0, 2.0, 3.0]])
        wait_until(lambda: device.done)
        assert device.done == [("velocity_move", [0, 1, 2], [1.0, 2.0, 3.0])]


def test_commands_that_are_none_change_nothing(server, device, names, caplog):
    bad = [
        [[Vocab("vmos")], [1, 2, 3]],
        [[Vocab("vmos")], [1.0, 2.0]],
        [[Vocab("vmo"), 7], [1.0]],
        [[Vocab("vmo"), 0], [float("nan")]],
        [],
        5,
        {"vmo": 1},
        b"\xff" * 40,
        yarpy.Vector([1.0, 2.0]),
    ]
    with caplog.at_level(logging.WARNING), yarpy.Port("/joystick", names=names) as port:
        port.connect("/cap/mc/command:i")
        for message in bad:
            port.write(message)
        port.write([[Vocab("dpo"), 1], [4.0]])
        wait_until(lambda: device.done)
    assert device.done == [("position_direct", [1], [4.0])]
    assert "/cap/mc: command from /joystick: the values are not all float64" in caplog.text


def test_commands_may_be_typed(server, device, names):
    with socket.create_connection(query(names, "/cap/mc/command:i"), HANG) as line:
        line.sendall(b"CONNECT me\r\nD\r\n([vmo] 1) (8)\r\n")
        wait_until(lambda: device.done)
    assert device.done == [("velocity_move", [1], [8.0])]


def test_both_outputs_carry_count_and_time(server, device, names):
    device.timestamps = lambda: [10.0, 10.5, 11.0]
    device.where[:] = [1.0, 2.0, 3.0]
    with (
        yarpy.BufferedPort("/all", strict=True, names=names) as everything,
        yarpy.BufferedPort("/some", strict=True, names=names) as positions,
    ):
        everything.listen_to("/cap/mc/stateExt:o")
        positions.listen_to("/cap/mc/state:o")
        states = [everything.read(HANG) for _ in range(3)]
        counts = [message.stamp.count for message in states]
        assert counts[0] < counts[1] < counts[2]  # one may be dropped on a busy machine
        assert {message.stamp.time for message in states} == {10.5}
        assert State.from_bottle(states[0].as_(Bottle)).values["encoders"] == [1.0, 2.0, 3.0]
        message = positions.read(HANG)
        assert bytes(message.payload) == yarpy.Vector([1.0, 2.0, 3.0]).to_wire()[0]
        assert message.stamp.time == 10.5


def test_bytes_of_the_position_stream(server, device, names):
    device.where[0] = 5.0
    recorded = load_capture("mc_state_o").steps[2].data
    with yarpy.BufferedPort("/some", names=names) as positions:
        positions.listen_to("/cap/mc/state:o")
        assert recorded.endswith(bytes(positions.read(HANG).payload))


def test_joints_read_at_different_times_make_no_state(server, device, names, caplog):
    device.timestamps = lambda: [10.0, 11.5, 10.0]
    with (
        caplog.at_level(logging.WARNING),
        yarpy.BufferedPort("/all", strict=True, names=names) as everything,
    ):
        everything.listen_to("/cap/mc/stateExt:o")
        wait_until(lambda: "apart: not published" in caplog.text)
        assert everything.poll() is None
        device.timestamps = lambda: [10.0, 11.0, 10.0]
        assert everything.read(HANG).stamp.count == 0


def test_nothing_is_read_while_nobody_listens(names):
    asked = []

    class Watched(Bare):
        def encoders(self):
            asked.append(1)
            return super().encoders()

    with (
        ControlBoardServer("/head", Watched(), 0.001, names=names),
        yarpy.BufferedPort("/all", names=names) as everything,
    ):
        before = len(asked)
        threading.Event().wait(0.05)
        assert len(asked) == before
        everything.listen_to("/head/stateExt:o")
        everything.read(HANG)
        assert asked


def test_sensors_may_fail(server, device, names, caplog):
    def fail():
        raise OSError("cable")

    device.torques = fail
    with (
        caplog.at_level(logging.WARNING),
        yarpy.BufferedPort("/all", strict=True, names=names) as everything,
    ):
        everything.listen_to("/cap/mc/stateExt:o")
        for _ in range(5):
            state = State.from_bottle(everything.read(HANG).as_(Bottle))
        assert "torques" not in state.values and "encoders" in state.values
    assert caplog.text.count("cable") == 1


def test_calls_from_many_at_once(server, device, names):
    def work(index):
        with yarpy.RpcClient("/cap/mc/rpc:i", names=names) as client:
            for number in range(40):
                assert client.call(Vocab("set"), Vocab("pos"), index, number) == ["ok"]
                client.call(Vocab("get"), Vocab("encs"))

    threads = [threading.Thread(target=work, args=(index,)) for index in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(HANG)
    assert device.where == [39.0, 39.0, 39.0]
    with yarpy.RpcClient("/cap/mc/rpc:i", names=names) as client:
        assert client.call("get", "axes")[4] == 120  # every question was counted once


def test_undecodable_requests_fail(server, names):
    class Garbage:
        def to_wire(self):
            return (b"\xff" * 40,)

    with yarpy.RpcClient("/cap/mc/rpc:i", names=names) as client:
        assert client.ask(Garbage(), timeout=HANG).value == ["fail"]
        assert client.call("get", "axes", timeout=HANG)[2] == 3


def test_closing_leaves_nothing(names):
    before = {thread.name for thread in threading.enumerate()}
    server = ControlBoardServer("robot/head/", Bare(), names=names)
    assert server.name == "/robot/head"
    assert server.axes == 2
    assert repr(server) == "<ControlBoardServer /robot/head, 2 joints>"
    assert "yarpy device /robot/head" in {thread.name for thread in threading.enumerate()}
    server.close()
    server.close()
    wait_until(lambda: {thread.name for thread in threading.enumerate()} <= before)
    for port in ("rpc:i", "command:i", "state:o", "stateExt:o"):
        assert names.query(f"/robot/head/{port}") is None


def test_a_name_that_is_taken(names):
    with yarpy.Port("/head/stateExt:o", names=names):
        with pytest.raises(AddressError, match="stateExt:o"):
            ControlBoardServer("/head", Bare(), names=names)
        assert names.query("/head/rpc:i") is None
    with ControlBoardServer("/head", Bare(), names=names), pytest.raises(AddressError):
        ControlBoardServer("/head", Bare(), names=names)


def test_bad_devices_open_nothing(names):
    with pytest.raises(ValueError, match="axis_names"):
        ControlBoardServer("/head", object(), names=names)
    with pytest.raises(ValueError, match="period"):
        ControlBoardServer("/head", Bare(), 0.0, names=names)
    assert names.query("/head/rpc:i") is None
    with pytest.raises(UnknownName):
        yarpy.RpcClient("/head/rpc:i", names=names)
