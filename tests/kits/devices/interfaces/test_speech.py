"""Every member of the interface, over the network."""

from struct import pack

from support.interface import check_every_member
from support.wait import HANG

from yarpy import RpcClient
from yarpy.data.yarp4 import FLOAT64_4
from yarpy.kits.devices import SimulatedSynthesizer, SimulatedTranscription
from yarpy.kits.devices.interfaces.speech import SpeechSynthesizer, SpeechTranscription
from yarpy.nameserver.local import LocalNames


def test_speechsynthesizer(names: LocalNames) -> None:
    check_every_member(SpeechSynthesizer, names)


def test_speechtranscription(names: LocalNames) -> None:
    check_every_member(SpeechTranscription, names)


def test_a_sound_of_yarp_4_does_not_look_like_one_of_yarp_3(names: LocalNames) -> None:
    """There are no fractions in it; the score of the answer is one, spelled as the asker does."""
    sound = SimulatedSynthesizer().synthesize("hi").to_bottle("4.0")
    with (
        SpeechTranscription.serve("/ear", SimulatedTranscription(), names=names),
        RpcClient("/ear/rpc", name="/nwc", names=names) as client,
    ):
        client.tell(["getRemoteProtocolVersion"], HANG)
        answer = client.ask(["transcribe", sound], HANG)
        assert answer is not None
        assert answer.to_bytes()[-12:] == pack("<id", FLOAT64_4, 1.0)
