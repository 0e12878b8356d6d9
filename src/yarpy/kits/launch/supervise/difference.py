"""The difference between two descriptions of an application.

Rules: pure. Where something stands in its file is no difference; programs are told apart by their
labels, connections by all that is said of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from yarpy.kits.launch.application.application import Application, Connection, Module
from yarpy.kits.launch.document.problem import NOWHERE


@dataclass(frozen=True, slots=True)
class Difference:
    """Labels of programs, and the connections of either side that the other has not."""

    new: tuple[str, ...] = ()
    gone: tuple[str, ...] = ()
    other: tuple[str, ...] = ()
    made: tuple[Connection, ...] = ()
    ended: tuple[Connection, ...] = ()

    def texts(self) -> Iterator[str]:
        """Yield what happens to each, for people."""
        for label in self.new:
            yield f"{label} is new"
        for label in self.gone:
            yield f"{label} is no longer in the file"
        for label in self.other:
            yield f"{label} is described otherwise, and was started again"
        for one in self.made:
            yield f"{one.label} is new"
        for one in self.ended:
            yield f"{one.label} is no longer in the file"


def difference(before: Application, after: Application) -> Difference:
    """Return what changes from one description to the next one."""
    old = {module.label: _bare(module) for module in before.modules}
    new = {module.label: _bare(module) for module in after.modules}
    links, others = (
        [replace(one, where=NOWHERE) for one in of.connections] for of in (before, after)
    )
    return Difference(
        new=tuple(label for label in new if label not in old),
        gone=tuple(label for label in old if label not in new),
        other=tuple(label for label in new if label in old and old[label] != new[label]),
        made=tuple(one for one in others if one not in links),
        ended=tuple(one for one in links if one not in others),
    )


def _bare(module: Module) -> Module:
    needs = [replace(need, where=NOWHERE) for need in module.needs]
    return replace(module, needs=needs, where=NOWHERE)
