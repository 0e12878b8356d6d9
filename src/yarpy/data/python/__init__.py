"""Values of Python that YARP has no kinds for: arrays, dicts, dataclasses and the like."""
