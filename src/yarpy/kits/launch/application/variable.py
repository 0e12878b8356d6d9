"""Variables in texts of applications: `${name}` and `$ENV{NAME}`.

Rules: pure. Those of the environment come first, then the others, again and again until none is
left; what is not defined is empty, and said. A text that grows beyond a limit is refused.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Final

from yarpy.errors import DecodeError
from yarpy.limit import APPLICATION_DEPTH, APPLICATION_TEXT

_ENVIRONMENT: Final = re.compile(r"\$ENV\{([^{}$]*)\}")
_VARIABLE: Final = re.compile(r"\$\{([^{}$]*)\}")


def expand(
    text: str, variables: Mapping[str, str], environment: Mapping[str, str]
) -> tuple[str, list[str]]:
    """Return the text with its variables replaced, and the names that are not defined. A dollar
    that begins none is left, and is among the names. Raises DecodeError if it grows too long."""
    missing: list[str] = []
    if "$" not in text:
        return text, missing

    def value(known: Mapping[str, str], name: str, spelled: str) -> str:
        if name not in known:
            missing.append(spelled)
        return known.get(name, "")

    text = _ENVIRONMENT.sub(lambda found: value(environment, found[1], found[0]), text)
    for _ in range(APPLICATION_DEPTH):
        used = _VARIABLE.findall(text)
        if not used:
            break
        if len(text) + sum(len(variables.get(name, "")) for name in used) > APPLICATION_TEXT:
            raise DecodeError(f"with its variables, this is longer than {APPLICATION_TEXT} letters")
        text = _VARIABLE.sub(lambda found: value(variables, found[1], found[0]), text)
    if "$" in text:
        missing.append("$")
    return text, missing
