"""Common to the plug-ins whose values the original sends as pickles.

    [tag, pickle, buffer ..., ours]      the original reads the pickle, and leaves the rest of the
                                         buffers; here the last one is read, and never the pickle

Rules: a pickle is made for the original, and nothing here loads one.
"""

from __future__ import annotations

import pickle
from base64 import b64decode, b64encode
from typing import Any

from yarpy.errors import DecodeError


def pickled(tag: str, value: Any, ours: bytes) -> tuple[bool, dict[str, Any]]:
    """The tagged value: for the original, and in the form that is read here."""
    text = pickle.dumps(value, protocol=5).decode("latin1")
    return True, {"__wrapyfi__": (tag, text, b64encode(ours).decode())}


def ours_of(tag: str, content: list[Any], mark: bytes) -> bytes:
    """The form that begins with a mark. DecodeError where there is none but a pickle."""
    if len(content) > 2 and isinstance(content[-1], str):
        data = b64decode(content[-1], validate=True)
        if data.startswith(mark):
            return data
    raise DecodeError(
        f"a {tag} that comes as a pickle alone, which runs code of its sender when it is read: "
        "send it as numpy arrays, or from a program with yarpy-wrapyfi"
    )
