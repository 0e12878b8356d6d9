"""An answer by HTTP that refuses. Its connection is closed with it: left to the collector, which
may look at its parts in any order, it would complain during a later test.
"""

from __future__ import annotations

import urllib.error
from collections.abc import Iterator
from contextlib import closing, contextmanager

import pytest


@contextmanager
def http_error(code: int) -> Iterator[None]:
    """Expect what is in here to end with that code."""
    with pytest.raises(urllib.error.HTTPError) as caught:
        yield
    with closing(caught.value):
        assert caught.value.code == code
