"""Messages of Foxglove, against the bytes that its own library writes."""

from yarpy.kits.record.form import protobuf
from yarpy.kits.record.form.protobuf import Field, descriptor_set, encode, timestamp


def test_the_bytes_of_foxglove(monkeypatch) -> None:
    image = {"timestamp": timestamp(1_000_000_005), "data": b"abc", "format": "jpeg"}
    found = encode("foxglove.CompressedImage", {**image, "frame_id": "x"})
    assert found.hex() == "0a040801100512036162631a046a706567220178"
    joints = (Field("name", 1, "string"), Field("position", 2, "double"), Field("n", 3, "fixed32"))
    states = (Field("timestamp", 1, protobuf.TIMESTAMP), Field("joints", 2, "Joint", True))
    monkeypatch.setitem(protobuf.TYPES, "Joint", joints)
    monkeypatch.setitem(protobuf.TYPES, "States", states)
    joint = {"name": "neck", "position": 0.5}
    found = encode("States", {"timestamp": timestamp(1_500_000_000), "joints": [joint]})
    assert found.hex() == "0a0808011080cab5ee01120f0a046e65636b11000000000000e03f"
    assert encode("Joint", {"n": 7}).hex() == "1d07000000"
    assert encode("States", {}) == b""


def test_a_description() -> None:
    """What google.protobuf makes of it was looked at by hand; here are the names in it."""
    found = descriptor_set("foxglove.CompressedImage")
    for name in (b"google/protobuf/timestamp.proto", b".google.protobuf.Timestamp", b"frame_id"):
        assert name in found
    assert found.index(b"timestamp.proto") < found.index(b"CompressedImage.proto")
