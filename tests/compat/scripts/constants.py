"""Constants: every number that the binding of C++ YARP 3.5 has."""

import yarp

NAMES = [
    name
    for name in dir(yarp)
    if name.startswith(("VOCAB_", "BOTTLE_TAG_", "FORMAT_", "YARP_FEATURE_", "MODE_", "MAS_"))
    and not name.startswith("VOCAB_PIDTYPE")
]
for name in NAMES:
    print(name, getattr(yarp, name))
