"""Devices that only newer C++ has, most of them both ways in one chain each.

our client -> nws of C++ -> nwc of C++ -> our server
"""

from __future__ import annotations

import wave
from pathlib import Path

import numpy as np
import pytest
from support.cpp import CppYarp
from support.cpp_device import PATIENT, between, cpp_device, device_host
from support.wait import wait_until

from yarpy import Bottle, RpcClient, Sound
from yarpy.errors import LocalProtocolError
from yarpy.kits import devices
from yarpy.kits.devices.interfaces.joypad import Point

pytestmark = pytest.mark.peer("g++")

PAD = {"period": 10, "use_separate_ports": 1, "name": "/cpp"}
EYE, ARM = devices.Description("eye", "camera"), devices.Description("arm", "board")


@pytest.fixture
def newer(network: CppYarp) -> CppYarp:
    """C++ YARP 3.9 or later, with devices."""
    if network.version < (3, 9):
        pytest.skip("needs C++ YARP 3.9 or later: YARPY_CPP_YARP says where it is")
    device_host(network)
    return network


def test_a_base(newer: CppYarp) -> None:
    base = devices.SimulatedBase("kitchen")
    place = {"local": "/cpp", "server": "/ours"}
    names = ("mobileBaseVelocityControl_nws_yarp", "mobileBaseVelocityControl_nwc_yarp")
    with (
        devices.MobileBase.serve("/ours", base),
        between(newer, *names, **place),
        devices.MobileBase.connect("/cpp") as client,
    ):
        client.apply_velocity(0.1, 0.2, 5.0, 60.0)
        assert base.last_velocity() == (0.1, 0.2, 5.0) == client.last_velocity()


def test_a_microphone(newer: CppYarp) -> None:
    microphone = devices.SimulatedMicrophone()
    options = {"min_samples_over_network": 100, "max_samples_over_network": 2000}
    with (
        devices.AudioRecorder.serve("/ours", microphone),
        between(newer, "audioRecorder_nws_yarp", "audioRecorder_nwc_yarp", **options),
        devices.AudioRecorder.connect("/cpp") as client,
    ):
        assert not client.recording()
        client.start()
        assert microphone.recording() and client.recording()
        sound = client.sound(100, 2000)
        assert sound.frequency == 16000 and sound.channels == 1 and 0 < sound.length <= 2000
        assert client.buffer_limit() == microphone.buffer_limit()
        client.stop()
        assert not microphone.recording()
        client.clear()
        assert client.buffer_size().samples == 0


def test_a_loudspeaker(newer: CppYarp) -> None:
    """It has no client in C++: ours, its server, and a device that writes a file."""
    sound = Sound(np.arange(-400, 400, dtype="int16"), 16000)
    options = {"file_name": newer.home / "heard.wav", "save_mode": "break_file"}
    options["playback_network_buffer_size"] = 0
    with (
        between(newer, "AudioPlayerWrapper", "audioToFileDevice", **options),
        devices.AudioPlayer.connect("/cpp") as client,
    ):
        client.start()
        client.amplify(1.0)
        wait_until(lambda: client.status().enabled)
        client.play(sound)
        wait_until(lambda: [each for each in files(newer) if each.stat().st_size >= 1644])
        client.stop()
        wait_until(lambda: not client.status().enabled)
    with wave.open(str(files(newer)[0])) as heard:
        assert heard.getframerate() == 16000
        assert heard.readframes(800) == sound.array.tobytes()


def files(newer: CppYarp) -> list[Path]:
    return [*newer.home.glob("heard*.wav")]


def test_a_voice(newer: CppYarp) -> None:
    device = devices.SimulatedSynthesizer()
    with (
        devices.SpeechSynthesizer.serve("/ours", device),
        between(newer, "speechSynthesizer_nws_yarp", "speechSynthesizer_nwc_yarp"),
        devices.SpeechSynthesizer.connect("/cpp") as client,
    ):
        client.switch_language("it-IT")
        client.switch_voice("anna")
        client.change_speed(1.5)
        client.change_pitch(0.5)
        assert (client.language(), client.voice()) == ("it-IT", "anna")
        assert (client.speed(), client.pitch()) == (1.5, 0.5)
        heard, said = client.synthesize("hi"), device.synthesize("hi")
        assert heard.frequency == said.frequency and heard.array.tolist() == said.array.tolist()


def test_an_ear(newer: CppYarp) -> None:
    with (
        devices.SpeechTranscription.serve("/ours", devices.SimulatedTranscription()),
        between(newer, "speechTranscription_nws_yarp", "speechTranscription_nwc_yarp"),
        devices.SpeechTranscription.connect("/cpp") as client,
    ):
        client.switch_language("it-IT")
        assert client.language() == "it-IT"
        sound = devices.SimulatedSynthesizer().synthesize("hi")
        assert client.transcribe(sound) == ("hello world", 1.0)


def test_somebody_to_talk_to(newer: CppYarp) -> None:
    with (
        devices.ChatBot.serve("/ours", devices.SimulatedChatBot()),
        between(newer, "chatBot_nws_yarp", "chatBot_nwc_yarp", remote="/ours/rpc"),
        devices.ChatBot.connect("/cpp") as client,
    ):
        assert client.interact("hi there") == "You said: hi there"
        client.switch_language("it-IT")
        assert (client.language(), client.status()) == ("it-IT", "heard 1")
        client.reset()
        assert (client.language(), client.status()) == ("auto", "heard 0")


def test_a_language_model(newer: CppYarp) -> None:
    name = "/cpp/rpc:i" if newer.version < (4, 0) else "/cpp"
    place = {"name": name, "streaming_name": "/cpp/stream", "remote": "/ours/rpc:i"}
    with (
        devices.LanguageModel.serve("/ours", devices.SimulatedLanguageModel()),
        between(newer, "LLM_nws_yarp", "LLM_nwc_yarp", **place),
        devices.LanguageModel.connect("/cpp") as client,
    ):
        client.begin("be short")
        assert client.prompt() == "be short"
        answer = client.ask("why")
        assert (answer.type, answer.content) == ("assistant", "You said: why")
        lines = [(line.type, line.content) for line in client.conversation()]
        assert lines == [
            ("system", "be short"),
            ("user", "why"),
            ("assistant", "You said: why"),
        ]
        with pytest.raises(LocalProtocolError, match='"/cpp" refuses begin'):
            client.begin("be long")
        client.forget()
        assert client.conversation() == []


def test_a_serial_port(newer: CppYarp) -> None:
    """The client in C++ receives nothing, and writes to one name only."""
    device, name = devices.SimulatedSerialPort(), "/serialPort_nws_yarp"
    with (
        devices.SerialPort.serve(name, device),
        between(newer, "serialPort_nws_yarp", "serialPort_nwc_yarp", remote=f"{name}/rpc"),
        devices.SerialPort.connect("/cpp") as client,
    ):
        assert client.enable_ready_line(True) and device.ready
        client.send(Bottle(["AT"]))
        wait_until(lambda: client.flush() == 2)


def test_odometry(newer: CppYarp) -> None:
    """It has no client in C++: a simulated robot that always turns."""
    with (
        between(newer, "odometry2D_nws_yarp", "fakeOdometry2D"),
        devices.Odometry2D.connect("/cpp") as client,
    ):
        client.reset_odometry()
        first = client.odometry()
        wait_until(lambda: client.odometry() != first)


def test_frames_of_cpp(newer: CppYarp) -> None:
    with (
        cpp_device(newer, "frameTransformServer", filexml_option="fts_yarp_only.xml"),
        devices.TransformClient() as client,
    ):
        client.place("head", "base", (0.5, 1.5, 2.5), constant=True)
        client.place("eye", "head", (0.25, 0, 0), constant=True)
        assert client.pose("eye", "base")[:3, 3].tolist() == [0.75, 1.5, 2.5]
        client.remove("eye", "head")
        assert client.frames() == ["base", "head"]
        client.clear()
        assert client.all() == []


def test_frames_of_ours(newer: CppYarp) -> None:
    options = {"filexml_option": "ftc_yarp_only.xml", "local_rpc": "/client/rpc"}
    with (
        devices.TransformServer(expiry=60.0) as server,
        cpp_device(newer, "frameTransformClient", **options),
        RpcClient("/client/rpc") as client,
    ):
        server.frames.place("hand", "base", constant=True)
        client.call("set_static_transform_rad", "head", "base", 0.5, 1.5, 2.5, 0.0, 0.0, 0.0)
        wait_until(lambda: len(server.frames.all()) == 2)
        assert server.frames.pose("head", "base")[:3, 3].tolist() == [0.5, 1.5, 2.5]
        wait_until(lambda: "hand" in str(client.call("list_frames")))
        client.call("delete_static_transform", "head", "base")
        wait_until(lambda: len(server.frames.all()) == 1)


def test_descriptions_of_cpp(newer: CppYarp) -> None:
    with (
        cpp_device(newer, "robotDescriptionServer", local="/cpp"),
        devices.Descriptions.connect("/cpp/rpc") as client,
    ):
        assert client.devices() == []
        client.register(EYE)
        client.register(ARM)
        assert client.devices() == [EYE, ARM] and client.devices_of("board") == [ARM]
        client.unregister("eye")
        assert client.devices() == [ARM]
        with pytest.raises(LocalProtocolError, match='"/cpp/rpc" refuses unregister'):
            client.unregister("eye")


def test_descriptions_of_ours(newer: CppYarp) -> None:
    device = devices.DescriptionStorage()
    device.register(EYE)
    device.register(ARM)
    remote = "/ours" if newer.version < (4, 0) else "/ours/rpc"
    options = {"inner": "robotDescriptionClient", "local": "/between", "remote": remote}
    with (
        devices.Descriptions.serve("/ours/rpc", device),
        cpp_device(newer, PATIENT, **options) as process,
    ):
        assert "not available" not in process.stdout, process.stdout + process.stderr
        assert device.devices() == [EYE, devices.Description("eye_twin", "camera")]


def test_sticks_and_surfaces_of_cpp(newer: CppYarp) -> None:
    """Its simulated joypad says three numbers of a finger, and none of a stick."""
    with (
        cpp_device(newer, "JoypadControlServer", subdevice="fakeJoypad", **PAD),
        devices.Joypad.connect("/cpp") as client,
    ):
        assert client.stick_count() == 4 and client.stick_freedom(1) == 2
        last = Point(10.0, 11.0) if newer.version < (4, 0) else Point(112.0, 113.0)
        assert client.touch(1)[-1] == last
        said = (10.0, 10.0, 10) if newer.version < (4, 0) else (11.0, 10.0, 12)
        assert (client.button(1), client.axis(1), client.hat(1)) == said
        ball = Point(10.0, 11.0) if newer.version < (4, 0) else Point(120.0, 121.0)
        assert client.trackball(1) == ball
        with pytest.raises(LocalProtocolError, match='"/cpp" refuses touch'):
            client.touch(9)
