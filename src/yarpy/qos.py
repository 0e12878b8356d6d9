"""Quality of service of one connection: its thread's scheduling and its packets' priority.

Rules: values are checked here, applied to a thread or socket by whoever owns it. Packet priorities
follow YARP's classes (LOW AF11, NORM 0, HIGH AF42, CRIT VA); the TOS byte is DSCP << 2.

    >>> tos_of("HIGH"), tos_of("AF12"), tos_of(10)
    (144, 48, 40)
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from yarpy.errors import LocalProtocolError
from yarpy.platform import scheduling

DSCP: Final[dict[str, int]] = {
    **{f"CS{n}": 8 * n for n in range(8)},
    **{f"AF{n}{m}": 8 * n + 2 * m for n in range(1, 5) for m in range(1, 4)},
    "VA": 44,
    "EF": 46,
}
LEVELS: Final[dict[str, int]] = {"LOW": 10, "NORM": 0, "HIGH": 36, "CRIT": 44}
LONGEST: Final = 86400.0  # seconds of a deadline
FASTEST: Final = 1e6  # messages per second
POLICIES: Final[dict[str, int]] = {"SCHED_OTHER": 0, "SCHED_FIFO": 1, "SCHED_RR": 2}


@dataclass(frozen=True, slots=True)
class Sched:
    """Scheduling of a thread: policy 0 (OTHER), 1 (FIFO), 2 (RR), priority 0, or 1..99."""

    policy: int = -1
    priority: int = -1


@dataclass(frozen=True, slots=True)
class Qos:
    """The quality of service of a connection, asked for or granted: its thread's scheduling, its
    packets' priority, and when its messages should come.

    `policy` is SCHED_OTHER, SCHED_FIFO or SCHED_RR, `priority` 1..99 for the last two, `packets` a
    level (LOW, NORM, HIGH, CRIT), a DSCP class (AF42) or a DSCP number. `deadline` is how many
    seconds a message may take from its stamp to its arrival, `rate` how many should come in a
    second, `late` what becomes of those that are late: "drop" or "keep". What is None is left as it
    is; a deadline or a rate of 0 ends it. Raises ValueError.

        >>> Qos("fifo", 30, "HIGH")
        Qos(policy='SCHED_FIFO', priority=30, packets='AF42')
        >>> Qos(deadline=0.02, rate=50)
        Qos(deadline=0.02, rate=50)
    """

    policy: str | None = None
    priority: int | None = None
    packets: str | int | None = None
    deadline: float | None = None
    rate: float | None = None
    late: str | None = None

    def __post_init__(self) -> None:
        if self.policy is not None:
            number = policy_of(self.policy)
            object.__setattr__(self, "policy", policy_name(number))
            check(Sched(number, -1 if self.priority is None else self.priority))
        if self.packets is not None:
            object.__setattr__(self, "packets", packets_name(tos_of(self.packets)))
        for key, most in (("deadline", LONGEST), ("rate", FASTEST)):
            value = getattr(self, key)
            if value is not None and not (isinstance(value, int | float) and 0 <= value <= most):
                raise ValueError(f"a {key} is a number from 0 to {most:g}, not {value!r:.40}")
        if self.late not in (None, "drop", "keep"):
            raise ValueError(f'what is late is "drop" or "keep", not {self.late!r:.40}')

    def __repr__(self) -> str:
        timing = ("deadline", "rate", "late")
        shown = [key for key in timing if getattr(self, key) is not None]
        if not shown or (self.policy, self.priority, self.packets) != (None, None, None):
            shown = ["policy", "priority", "packets", *shown]
        return f"Qos({', '.join(f'{key}={getattr(self, key)!r}' for key in shown)})"

    @property
    def timed(self) -> bool:
        """Return whether it says when messages should come."""
        return not (self.deadline is None and self.rate is None and self.late is None)

    @classmethod
    def of(cls, sched: Sched, tos: int) -> Qos:
        """The same from numbers; -1 is None."""
        return cls(
            None if sched.policy < 0 else policy_name(sched.policy),
            None if sched.priority < 0 else sched.priority,
            None if tos < 0 else packets_name(tos),
        )

    @property
    def sched(self) -> Sched:
        """The scheduling as numbers."""
        return Sched(
            -1 if self.policy is None else policy_of(self.policy),
            -1 if self.priority is None else self.priority,
        )

    @property
    def tos(self) -> int:
        """The TOS byte, -1 for none."""
        return -1 if self.packets is None else tos_of(self.packets)


NOTHING_ASKED: Final = Qos()


def policy_name(policy: int) -> str:
    """SCHED_FIFO and the like for the number of a policy."""
    return next((name for name, one in POLICIES.items() if one == policy), str(policy))


def packets_name(tos: int) -> str | int:
    """The DSCP class of a TOS byte, or its DSCP number if that has no name."""
    return next((name for name, dscp in DSCP.items() if dscp == tos >> 2), tos >> 2)


def check(sched: Sched) -> None:
    """Raises ValueError if no kernel takes this."""
    if sched.policy not in (-1, *POLICIES.values()):
        raise ValueError(f"{sched.policy} is no scheduling policy: use {', '.join(POLICIES)}")
    if sched.policy > 0 and sched.priority != -1 and not 1 <= sched.priority <= 99:
        raise ValueError(f"{policy_name(sched.policy)} takes a priority of 1 to 99")
    if sched.policy == 0 and sched.priority > 0:
        raise ValueError("SCHED_OTHER takes no priority but 0; use SCHED_FIFO or SCHED_RR")


def tos_of(value: str | int) -> int:
    """The TOS byte of a level, a DSCP class name or a DSCP number. Raises ValueError."""
    if isinstance(value, int):
        if 0 <= value < 64:
            return value << 2
        raise ValueError(f"a DSCP number lies between 0 and 63, not {value}")
    found = LEVELS.get(value.upper()[:4], DSCP.get(value.upper()))
    if found is None:
        raise ValueError(
            f'"{value}" is no packet priority: use {", ".join(LEVELS)}, or a DSCP class like AF42'
        )
    return found << 2


def policy_of(value: str | int) -> int:
    """The number of a scheduling policy, given as a number or as SCHED_FIFO and the like."""
    if isinstance(value, int):
        return value
    name = value.upper()
    found = POLICIES.get(name, POLICIES.get(f"SCHED_{name}"))
    if found is None:
        raise ValueError(f'"{value}" is no scheduling policy: use {", ".join(POLICIES)}')
    return found


def schedule(thread: int, sched: Sched) -> None:
    """Give the kernel thread with id `thread` (0: the caller) this scheduling.

    Raises LocalProtocolError when the kernel refuses, or has no such thing.
    """
    policy = max(sched.policy, 0)
    priority = max(sched.priority, 0) if policy else 0
    try:
        scheduling.schedule(thread, policy, priority)
    except NotImplementedError as error:
        raise LocalProtocolError(
            "this system does not let a program set thread priorities"
        ) from error
    except PermissionError as error:
        raise LocalProtocolError(
            f"the system refuses real-time scheduling: {scheduling.RIGHTS}"
        ) from error
    except OSError as error:
        raise LocalProtocolError(
            f"policy {policy} does not take priority {priority}: 1..99 for FIFO and RR, 0 for OTHER"
        ) from error


def scheduled(thread: int) -> Sched:
    """Return the scheduling that the kernel really gives a thread; -1 where it does not say."""
    try:
        return Sched(*scheduling.scheduled(thread))
    except OSError:
        return Sched()
