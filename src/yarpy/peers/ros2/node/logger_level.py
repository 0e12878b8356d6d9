"""The services by which others see and change the level of a node's log: `enable_logger_service`.

Rules: names and types are those of rclpy and rclcpp. A node has one logger, whose name is the
node's, with dots. Level 0 of a logger in an answer says that it is not known; set to 0 it is INFO
again, which is what a node begins with.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Any, Final

from yarpy.log import readable
from yarpy.peers.ros2.exchange import Question

#: the services below the name of a node, and their types
SERVICES: Final = {
    "get_logger_levels": "rcl_interfaces/srv/GetLoggerLevels",
    "set_logger_levels": "rcl_interfaces/srv/SetLoggerLevels",
}
UNKNOWN: Final = 0
_LEVELS: Final = (10, 20, 30, 40, 50)  # DEBUG, INFO, WARN, ERROR, FATAL, as Python has them


class LoggerLevels:
    """Answers the questions for the level of a logger; `handlers` has one for each service."""

    def __init__(self, logger: logging.Logger) -> None:
        self._logger = logger
        self.handlers: dict[str, Callable[[Question], None]] = {
            "get_logger_levels": self._get,
            "set_logger_levels": self._set,
        }

    def _get(self, question: Question) -> None:
        own = self._logger
        levels = [
            {"name": name, "level": own.level if name == own.name else UNKNOWN}
            for name in question.request.names
        ]
        question.answer({"levels": levels})

    def _set(self, question: Question) -> None:
        results = [self._changed(one.name, one.level) for one in question.request.levels]
        question.answer({"results": results})

    def _changed(self, name: str, level: int) -> dict[str, Any]:
        own = self._logger
        why = ""
        if name != own.name:
            why = f"this node has no logger {readable(name[:200])}: its own is {own.name}"
        elif level != UNKNOWN and level not in _LEVELS:
            why = f"{level} is no level of a log: they are {', '.join(map(str, _LEVELS))}"
        else:
            own.setLevel(level or logging.INFO)
        return {"successful": not why, "reason": why}
