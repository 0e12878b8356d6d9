from yarpy.kits.devices.frame_grabber.interface import FEATURES


def test_features_have_their_numbers():
    assert [FEATURES.index(name) for name in ("brightness", "white_balance", "gain", "focus")] == [
        0,
        3,
        8,
        10,
    ]
    assert FEATURES.index("frame_rate") == 15 and FEATURES[-1] == "mirror" and len(FEATURES) == 23
