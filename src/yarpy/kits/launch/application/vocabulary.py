"""The words that files of applications may have.

Rules: pure. The list is that of yarpmanager 3.9; `EDITOR` are tags that only its drawing reads.
"""

from __future__ import annotations

from typing import Final

ROOT: Final = (
    *("name", "description", "version", "authors", "var", "dependencies"),
    *("module", "connection", "application", "arbitrator"),
)
MODULE: Final = (
    *("name", "parameters", "node", "prefix", "stdio", "workdir", "deployer", "environment"),
    *("display", "rank", "dependencies", "ensure", "portmap"),
)
CONNECTION: Final = ("from", "to", "output", "input", "protocol")
NESTED: Final = ("name", "prefix")
ARBITRATOR: Final = ("port", "rule")
EDITOR: Final = ("geometry",)
# Found in many files, and read by no version of yarpmanager.
USUAL: Final = {"tag": "programs are told apart by their names"}
