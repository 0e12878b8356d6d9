"""Voices, ears, cameras with distances, microphones and joypads through `import yarp`."""

from collections.abc import Iterator
from typing import Any

import pytest
from support.wait import wait_until

import yarp


@pytest.fixture(autouse=True)
def local() -> Iterator[None]:
    yarp.Network.init()
    yarp.Network.setLocalMode(True)
    yield
    yarp.Network.setLocalMode(False)


@pytest.fixture
def devices() -> Iterator[Any]:
    opened: list[yarp.PolyDriver] = []

    def make(options: str) -> yarp.PolyDriver:
        driver = yarp.PolyDriver()
        opened.append(driver)
        assert driver.open(yarp.Property(options)), options
        return driver

    yield make
    for driver in reversed(opened):
        driver.close()


def test_speech(devices: Any) -> None:
    for kind in ("speechSynthesizer", "speechTranscription"):
        fake = devices(f"(device fake{kind[0].upper()}{kind[1:]})")
        assert devices(f"(device {kind}_nws_yarp) (name /{kind})").attach(fake)
    voice = devices("(device speechSynthesizer_nwc_yarp) (remote /speechSynthesizer)")
    ear = devices("(device speechTranscription_nwc_yarp) (remote /speechTranscription)")
    speak, hear = voice.viewISpeechSynthesizer(), ear.viewISpeechTranscription()
    assert speak.setLanguage("it-IT") and speak.getLanguage() == "it-IT"
    assert speak.setSpeed(1.5) and speak.getSpeed() == 1.5
    sound = yarp.Sound()
    assert speak.synthesize("hello", sound) and sound.getSamples() == 4000
    assert hear.transcribe(sound) == ("hello world", 1.0)
    assert voice.viewISpeechTranscription() is None


def test_rgbd(devices: Any) -> None:
    camera = devices("(device fakeDepthCamera)")
    assert devices("(device RGBDSensor_nws_yarp) (name /eyes) (period 0.01)").attach(camera)
    client = devices(
        "(device RGBDSensorClient) (localImagePort /me/i) (localDepthPort /me/d) "
        "(localRpcPort /me/r) (remoteImagePort /eyes/rgbImage:o) "
        "(remoteDepthPort /eyes/depthImage:o) (remoteRpcPort /eyes/rpc:i)"
    )
    view = client.viewIRGBDSensor()
    colour, depth = yarp.ImageRgb(), yarp.ImageFloat()
    wait_until(lambda: view.getImages(colour, depth))
    assert (colour.width(), depth.height()) == (320, 240)
    assert depth.pixel(0, 0) == 3.0
    assert view.getDepthWidth() == 320 and view.getDepthClipPlanes() == (0.2, 10.0)


def test_joypad_microphone_speaker(devices: Any) -> None:
    for fake, server, name in (
        ("fakeJoypad", "JoypadControl_nws_yarp", "/pad"),
        ("fakeMicrophone", "audioRecorder_nws_yarp", "/mic"),
        ("fakeSpeaker", "AudioPlayerWrapper", "/speaker"),
    ):
        assert devices(f"(device {server}) (name {name})").attach(devices(f"(device {fake})"))
    assert devices("(device JoypadControl_nwc_yarp) (remote /pad)").isValid()
    assert devices("(device audioRecorder_nwc_yarp) (remote /mic)").isValid()
    port = yarp.RpcClient()
    assert port.open("/ask") and port.addOutput("/speaker/rpc:i")
    answer = yarp.Bottle()
    for words in ("start", "sw_audio_gain 0.5", "clear", "stop"):
        assert port.write(yarp.Bottle(words), answer) and answer.toString() == "[ok]", words
    assert port.write(yarp.Bottle("sw_audio_gain -1.0"), answer) and answer.toString() == "[fail]"
    port.close()
