"""Changes: what the agent may set at a port, as plain values; and what the network is like now.

Rules: pure. A change names the port that is asked, the peer, what is set (`key`) and both values,
so that it can be undone by anyone who reads it: it is also a line of the journal.

    key        value                               asked is
    packets    a DSCP class or number              either end
    threads    (policy, priority)                  either end
    timing     (deadline, rate), 0 for none        the receiver
    limit      Mbit/s, or None                     the sender; peer: itself, for all that it writes
    carrier    a carrier string                    the sender
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Literal, TypeAlias, get_args

Key: TypeAlias = Literal["packets", "threads", "timing", "limit", "carrier"]
KEYS = get_args(Key)


@dataclass(frozen=True, slots=True)
class Change:
    """At `port`, for its connection with `peer`: `key` from `before` to `value`."""

    port: str
    peer: str
    key: Key
    value: Any
    before: Any

    @property
    def what(self) -> tuple[str, str, str]:
        """The key of the setting: changes of the same setting have the same key."""
        return self.port, self.peer, self.key

    @property
    def undone(self) -> Change:
        """The change that takes it back."""
        return replace(self, value=self.before, before=self.value)

    def as_dict(self) -> dict[str, Any]:
        """For the journal and `--json`."""
        return {
            "port": self.port,
            "peer": self.peer,
            "key": self.key,
            "value": self.value,
            "before": self.before,
        }

    @classmethod
    def from_dict(cls, told: Any) -> Change:
        """Raises ValueError for what is none."""
        if not isinstance(told, dict) or told.get("key") not in KEYS:
            raise ValueError("this is no change")
        names = [told.get(key) for key in ("port", "peer")]
        if not all(isinstance(name, str) and name.startswith("/") for name in names):
            raise ValueError("a change names two ports")
        value, before = (_plain(told.get(key)) for key in ("value", "before"))
        return cls(str(names[0]), str(names[1]), told["key"], value, before)


def _plain(value: Any) -> Any:
    """JSON knows no tuples."""
    return tuple(value) if isinstance(value, list) else value


@dataclass(frozen=True, slots=True)
class Step:
    """Changes that belong together, and why, in one line."""

    why: str
    changes: tuple[Change, ...] = ()
