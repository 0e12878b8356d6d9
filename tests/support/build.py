"""Whether the core under test is the compiled one (`make compiled`).

Rules: the same tests for both, but for those that change a constant of a module: compiled code has
its value built in.
"""

import pytest

from yarpy.wire import stream

COMPILED = not (stream.__file__ or "").endswith(".py")

changes_a_constant = pytest.mark.skipif(COMPILED, reason="compiled code has its constants built in")
replaces_a_method = pytest.mark.skipif(COMPILED, reason="compiled objects keep their own methods")

if __name__ == "__main__":
    raise SystemExit(None if COMPILED else f"not compiled: {stream.__file__}")
