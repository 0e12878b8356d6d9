"""Every member of the interface, over the network."""

from support.interface import check_every_member

from yarpy.kits.devices.interfaces.audio import AudioPlayer, AudioRecorder
from yarpy.nameserver.local import LocalNames


def test_audioplayer(names: LocalNames) -> None:
    check_every_member(AudioPlayer, names)


def test_audiorecorder(names: LocalNames) -> None:
    check_every_member(AudioRecorder, names)
