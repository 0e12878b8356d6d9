"""The limit of open files: `resource`, and the mark of tests that set it.

Rules: `resource` is None where the system has no such limit.
"""

from __future__ import annotations

import sys

import pytest

if sys.platform == "win32":
    resource = None
else:
    import resource

limited = pytest.mark.skipif(
    resource is None, reason="Windows sets a process no limit of open files"
)
