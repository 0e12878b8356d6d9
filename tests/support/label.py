"""Names of parametrised tests that are the same in every run, as tests side by side need them."""

import re


def spelled(value: object) -> str:
    """`repr`, without addresses in memory."""
    return re.sub(r" at 0x[0-9a-f]+", "", repr(value))
