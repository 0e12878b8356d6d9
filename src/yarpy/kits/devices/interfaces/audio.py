"""AudioRecorder, AudioPlayer: a microphone and a loudspeaker.

Rules: a recorder sends what was recorded since it was last asked; nothing while it is stopped. A
player is asked in plain words (`start`, `stop`, `clear`, `sw_audio_gain 0.5`), so C++ has no client
of it.

Source: IAudioGrabberSound, IAudioRender and AudioPlayerWrapper of YARP 3.9 to 4.0.
"""

from __future__ import annotations

import yarpy
from yarpy.kits.devices.interfaces.media import AudioSize, AudioStatus, SoundOf
from yarpy.kits.devices.network.model import Interface, call, published, taken
from yarpy.kits.thrift.kind import Nested, size_t


class AudioRecorder(Interface):
    """A microphone."""

    NWS, NWC = "audioRecorder_nws_yarp", "audioRecorder_nwc_yarp"
    FAKE = "fakeMicrophone"
    VIEW = "IAudioGrabberSound"

    @call("startRecording_RPC", cpp="startRecording")
    def start(self) -> None:
        """Begin to record."""

    @call("stopRecording_RPC", cpp="stopRecording")
    def stop(self) -> None:
        """Record no more."""

    @call("isRecording_RPC", cpp="isRecording")
    def recording(self) -> bool:
        """Return whether it records."""
        raise NotImplementedError

    @published("audio:o")
    @call("getSound_RPC", cpp="getSound")
    def sound(self, least: size_t = 0, most: size_t = 11250, timeout: float = 1.0) -> SoundOf:
        """Return what was recorded, at most `most` samples; wait for `least` so many seconds."""
        raise NotImplementedError

    @call("resetRecordingAudioBuffer_RPC", cpp="resetRecordingAudioBuffer")
    def clear(self) -> None:
        """Forget what was recorded."""

    @call("setSWGain_RPC", cpp="setSWGain")
    def amplify(self, gain: float) -> None:
        """Multiply the samples by this."""

    @call("setHWGain_RPC", cpp="setHWGain")
    def amplify_input(self, gain: float) -> None:
        """Change the gain of the hardware."""

    @call("getRecordingAudioBufferCurrentSize_RPC", cpp="getRecordingAudioBufferCurrentSize")
    def buffer_size(self) -> Nested[AudioSize]:
        """Return how much was recorded."""
        raise NotImplementedError

    @call("getRecordingAudioBufferMaxSize_RPC", cpp="getRecordingAudioBufferMaxSize")
    def buffer_limit(self) -> Nested[AudioSize]:
        """Return how much can be kept."""
        raise NotImplementedError

    @published("status:o")
    def status(self) -> Nested[AudioStatus]:
        """Return whether it records, and how much is kept."""
        raise NotImplementedError


class AudioPlayer(Interface):
    """A loudspeaker."""

    NWS = "AudioPlayerWrapper"
    FAKE = "fakeSpeaker"
    VIEW = "IAudioRender"
    RPC = "rpc:i"

    @taken("audio:i", yarpy.Sound)
    def play(self, sound: yarpy.Sound) -> None:
        """Play a sound after those that came before."""

    @call("start", cpp="startPlayback")
    def start(self) -> None:
        """Begin to play."""

    @call("stop", cpp="stopPlayback")
    def stop(self) -> None:
        """Play no more."""

    @call("clear", cpp="resetPlaybackAudioBuffer")
    def clear(self) -> None:
        """Forget what is not played yet."""

    @call("sw_audio_gain", cpp="setSWGain", whole=True)
    def amplify(self, gain: float) -> None:
        """Multiply the samples by this."""

    @call("hw_audio_gain", cpp="setHWGain", whole=True)
    def amplify_output(self, gain: float) -> None:
        """Change the gain of the hardware."""

    @published("status:o")
    def status(self) -> Nested[AudioStatus]:
        """Return whether it plays, and how much is to be played."""
        raise NotImplementedError
