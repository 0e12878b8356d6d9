"""A pool of things a name server hands out: port numbers, temporary names, multicast groups.

Rules: pure. Values are text, because they are recycled in *string* order
and stored as text. A value is given back only by its owner, so a client that names somebody else's
number cannot free it. Running out is an AddressError, never the end of the server.
"""

from __future__ import annotations

from bisect import bisect_left, insort
from collections.abc import Callable, Iterable, Iterator

from yarpy.errors import AddressError

OnChange = Callable[[str], None]
Row = tuple[str, bool | None, str | None]  # value, in use, who had it last


class Pool:
    """Values `spell(first)` ... `spell(last)`, each lent to one owner at a time.

    `recycle`: freed values go out again before fresh ones (temporary names, groups); otherwise only
    when no fresh one is left (port numbers). `remember`: an owner that comes back gets the value it
    had, unless another was given it meanwhile.
    """

    def __init__(
        self,
        what: str,
        first: int,
        last: int,
        spell: Callable[[int], str] = str,
        *,
        recycle: bool = True,
        remember: bool = False,
    ) -> None:
        self.what = what
        self.last = last
        self.spell = spell
        self.recycle = recycle
        self.remember = remember
        self.counter = first - 1  # the last fresh value that went out
        self.on_change: OnChange | None = None
        self._used: dict[str, str | None] = {}  # value -> owner; None: nobody in particular
        self._lent: dict[str, str] = {}  # the reverse; a named owner has one value at a time
        self._free: list[str] = []  # sorted as text
        self._former: dict[str, str] = {}  # value -> the owner to whom it went last
        self._habit: dict[str, str] = {}  # the reverse of _former

    def take(self, owner: str | None, blocked: Callable[[str], bool] | None = None) -> str:
        """A value for `owner` (None: anybody may give it back), never one that is `blocked`.

        Raises AddressError when there is none left.
        """
        value = self._usual(owner, blocked)
        if value is None:
            ways = (self._recycled, self._fresh) if self.recycle else (self._fresh, self._recycled)
            value = ways[0](blocked)
            if value is None:
                value = ways[1](blocked)
        if value is None:
            raise AddressError(
                f"ran out of {self.what} ({len(self._used)} are in use); "
                "unregister what is dead, for example with `yarpy clean`"
            )
        self._used[value] = owner
        if owner is not None:
            self._lent[owner] = value
        if self.remember and owner is not None:
            former = self._former.get(value)
            if former is not None and self._habit.get(former) == value:
                del self._habit[former]
            self._former[value] = owner
            self._habit[owner] = value
        self._changed(value)
        return value

    def release(self, value: str, owner: str | None) -> bool:
        """Take `value` back if it was lent to `owner` or to nobody; returns whether it was."""
        if value not in self._used or self._used[value] not in (owner, None):
            return False
        holder = self._used.pop(value)
        if holder is not None and self._lent.get(holder) == value:
            del self._lent[holder]
        insort(self._free, value)
        self._changed(value)
        return True

    def lent(self, owner: str) -> str | None:
        """The value that `owner` has now."""
        return self._lent.get(owner)

    def rows(self, values: Iterable[str] | None = None) -> Iterator[Row]:
        """`(value, in use, remembered owner)` of `values` or all; in use is None: never lent."""
        if values is None:
            values = [*self._used, *self._free]
        for value in values:
            used = value in self._used
            known = used or self._is_free(value)
            yield value, used if known else None, self._former.get(value)

    def restore(self, counter: int, rows: Iterable[Row]) -> None:
        """The reverse of `rows`, for an empty pool: what a database remembers."""
        self.counter = max(self.counter, min(counter, self.last))
        for value, used, owner in rows:
            if used:
                self._used[value] = owner
                if owner is not None:
                    self._lent[owner] = value
            elif used is not None:
                self._free.append(value)
            if owner is not None and self.remember:
                self._former[value] = owner
                # Two values may carry one owner's name; the one that is not lent out serves it.
                if owner not in self._habit or not used:
                    self._habit[owner] = value
        self._free = sorted(set(self._free) - self._used.keys())

    def _usual(self, owner: str | None, blocked: Callable[[str], bool] | None) -> str | None:
        value = None if owner is None else self._habit.get(owner)
        if value is None or value in self._used or (blocked and blocked(value)):
            return None
        if self._is_free(value):
            del self._free[bisect_left(self._free, value)]
        return value

    def _fresh(self, blocked: Callable[[str], bool] | None) -> str | None:
        while self.counter < self.last:
            self.counter += 1
            value = self.spell(self.counter)
            if value in self._used or self._is_free(value):
                continue
            if blocked and blocked(value):
                insort(self._free, value)  # not lost: it may go out later
                self._changed(value)
                continue
            return value
        return None

    def _recycled(self, blocked: Callable[[str], bool] | None) -> str | None:
        for place, value in enumerate(self._free):
            if not (blocked and blocked(value)):
                del self._free[place]
                return value
        return None

    def _is_free(self, value: str) -> bool:
        place = bisect_left(self._free, value)
        return place < len(self._free) and self._free[place] == value

    def _changed(self, value: str) -> None:
        if self.on_change is not None:
            self.on_change(value)
