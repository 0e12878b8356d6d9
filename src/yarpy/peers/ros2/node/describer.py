"""The description of the types of a node, for others who do not know them: every node since Iron
serves `get_type_description`.

Rules: only types that the node itself uses are described, by name and hash.
"""

from __future__ import annotations

from typing import Any, Final

from yarpy.peers.ros.message.library import Service
from yarpy.peers.ros2.exchange import Question
from yarpy.peers.ros2.message.hash import described_message, described_service, full_name
from yarpy.peers.ros2.message.library import hash_of

TYPE: Final = "type_description_interfaces/srv/GetTypeDescription"


class Describer:
    """Answers `get_type_description` of one node."""

    def __init__(self) -> None:
        self._kinds: dict[tuple[str, str], Any] = {}

    def know(self, kind: Any) -> None:
        """The node uses a type: a class of messages, or a service."""
        name = full_name(kind.name, "srv") if isinstance(kind, Service) else full_name(kind._type)
        self._kinds[name, hash_of(kind)] = kind

    def answer(self, question: Question) -> None:
        """Answer a question for a type; without a hash any of its name will do."""
        asked = question.request
        for (name, hash_), kind in [*self._kinds.items()]:
            if name == asked.type_name and asked.type_hash in ("", hash_):
                question.answer({"successful": True, "type_description": _described(kind)})
                return
        why = f"this node has no type {asked.type_name[:200]} with the hash {asked.type_hash[:80]}"
        question.answer({"successful": False, "failure_reason": why})


def _described(kind: Any) -> dict[str, Any]:
    if isinstance(kind, Service):
        whole, others = described_service(kind.definition)
    else:
        whole, others = described_message(kind._definition)
    others.sort(key=lambda item: str(item["type_name"]))
    return {"type_description": whole, "referenced_type_descriptions": others}
