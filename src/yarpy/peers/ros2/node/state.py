"""The states of a managed node, and what leads from one to another.

Rules: pure. Numbers and labels are those of `lifecycle_msgs`, the machine that of rcl_lifecycle.
"""

from __future__ import annotations

from enum import IntEnum
from typing import Final, NamedTuple


class State(IntEnum):
    """The first five are primary: a node stays in them. In the others something is under way."""

    UNKNOWN = 0
    UNCONFIGURED = 1
    INACTIVE = 2
    ACTIVE = 3
    FINALIZED = 4
    CONFIGURING = 10
    CLEANINGUP = 11
    SHUTTINGDOWN = 12
    ACTIVATING = 13
    DEACTIVATING = 14
    ERRORPROCESSING = 15

    @property
    def label(self) -> str:
        """As `ros2 lifecycle` shows it."""
        return self.name.lower()


class Outcome(IntEnum):
    """Of what a node does on its way; added to the number of the way."""

    SUCCESS = 0
    FAILURE = 1
    ERROR = 2


class Transition(NamedTuple):
    """Leads from `start` to `goal`."""

    id: int
    label: str
    start: State
    goal: State


#: what may be asked for: number, label, from where, through which state
ASKED: Final = (
    Transition(1, "configure", State.UNCONFIGURED, State.CONFIGURING),
    Transition(2, "cleanup", State.INACTIVE, State.CLEANINGUP),
    Transition(3, "activate", State.INACTIVE, State.ACTIVATING),
    Transition(4, "deactivate", State.ACTIVE, State.DEACTIVATING),
    Transition(5, "shutdown", State.UNCONFIGURED, State.SHUTTINGDOWN),
    Transition(6, "shutdown", State.INACTIVE, State.SHUTTINGDOWN),
    Transition(7, "shutdown", State.ACTIVE, State.SHUTTINGDOWN),
)

#: through which state: the number of its success, and where success, failure and errors lead
_ENDS: Final = {
    State.CONFIGURING: (10, State.INACTIVE, State.UNCONFIGURED, State.ERRORPROCESSING),
    State.CLEANINGUP: (20, State.UNCONFIGURED, State.INACTIVE, State.ERRORPROCESSING),
    State.ACTIVATING: (30, State.ACTIVE, State.INACTIVE, State.ERRORPROCESSING),
    State.DEACTIVATING: (40, State.INACTIVE, State.ACTIVE, State.ERRORPROCESSING),
    State.SHUTTINGDOWN: (50, State.FINALIZED, State.FINALIZED, State.ERRORPROCESSING),
    State.ERRORPROCESSING: (60, State.UNCONFIGURED, State.FINALIZED, State.FINALIZED),
}


def end_of(state: State, outcome: Outcome) -> Transition:
    """Return what leads out of a state in which something was under way."""
    first, *goals = _ENDS[state]
    label = f"transition_{outcome.name.lower()}"
    return Transition(first + outcome, label, state, goals[outcome])


#: all, as `get_transition_graph` tells them
GRAPH: Final = (*ASKED, *(end_of(state, outcome) for state in _ENDS for outcome in Outcome))


def available(state: State) -> list[Transition]:
    """Return what may be asked for in a state."""
    return [item for item in ASKED if item.start == state]


def find(state: State, id_: int, label: str = "") -> Transition | None:
    """Return what is asked for in a state, by its label if there is one, else by its number; None
    for what leads nowhere from there."""
    for item in available(state):
        if (item.label == label) if label else (item.id == id_):
            return item
    return None
