"""Constants: every number that the binding of C++ YARP 3.5 has."""

import yarp

# Those that came with later versions.
NEWER = (
    *("BOTTLE_TAG_VOCAB64", "VOCAB_CM_VELOCITY_DIRECT", "VOCAB_IJOINTFAULT", "VOCAB_INAVIGATION"),
    *("VOCAB_ITRANSFORM", "VOCAB_JF_", "VOCAB_NAV_", "VOCAB_PIDCONTROL_", "VOCAB_PIDTYPE"),
    *("VOCAB_POSITIONCONTROL_INTERFACE", "VOCAB_POSITIONDIRECTCONTROL_INTERFACE"),
    *("VOCAB_TORQUECONTROL_INTERFACE", "VOCAB_TRANSFORM_", "VOCAB_VELOCITYCONTROL_INTERFACE"),
    "VOCAB_VELOCITY_MOVES",
)
NAMES = [
    name
    for name in dir(yarp)
    if name.startswith(("VOCAB_", "BOTTLE_TAG_", "FORMAT_", "YARP_FEATURE_", "MODE_", "MAS_"))
    and not name.startswith(NEWER)
    and name != "VOCAB_VELOCITY_MOVE"
]
for name in NAMES:
    print(name, getattr(yarp, name))
