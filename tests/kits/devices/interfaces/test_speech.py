"""Every member of the interface, over the network."""

from support.interface import check_every_member

from yarpy.kits.devices.interfaces.speech import SpeechSynthesizer, SpeechTranscription
from yarpy.nameserver.local import LocalNames


def test_speechsynthesizer(names: LocalNames) -> None:
    check_every_member(SpeechSynthesizer, names)


def test_speechtranscription(names: LocalNames) -> None:
    check_every_member(SpeechTranscription, names)
