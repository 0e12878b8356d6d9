"""The stages: which tests `--stage` takes, a set of folders and files each."""

from __future__ import annotations

from pathlib import Path
from typing import Final

TESTS: Final = Path(__file__).parents[1]
STAGES: Final = {
    # bytes and values, no sockets: seconds
    "pure": {
        *("wire", "data", "idl", "carriers", "config", "test_architecture.py", "test_contact.py"),
        *("test_errors.py", "test_registry.py", "test_route.py"),
    },
    # ports, links, names and monitors of one process: a minute
    "links": {
        *("transports", "link", "monitors", "names", "nameserver", "port", "network", "testing"),
        *("aio", "test_qos.py", "test_real_time.py"),
    },
}


def stage_of(path: Path) -> str:
    """Return the stage that a test file belongs to, "" for what is in none."""
    top = path.relative_to(TESTS).parts[0]
    return next((stage for stage, names in STAGES.items() if top in names), "")
