"""INavigation2D: a robot that goes to places, and what it consists of.

Rules: those of `_mirror`. A robot knows areas and places by their names if its client was opened
with a server of maps.
"""

from __future__ import annotations

import math
from typing import Any

from yarp._constants import CONSTANTS
from yarp._map_place import Map2DArea, Map2DLocation
from yarp._mirror import Mirror, _made
from yarp._numbers import store

_STATUS = "navigation_status_"


class INavigation2DTargetActions(Mirror, of=("Navigation2D",)):
    """Where it goes."""


class INavigation2DControlActions(Mirror, of=("Navigation2D",)):
    """Pausing, going on, and where it is going."""


class INavigation2DVelocityActions(Mirror, of=("Navigation2D", "MobileBase")):
    """How fast it goes."""


class INavigation2DExtraActions(Mirror, of=("Navigation2D", "Localization2D", "Map2D")):
    """Where it is, among what has a name."""

    def gotoTargetByLocationName(self, name: str) -> bool:
        """Go to a place that the server of maps knows."""
        return self._tell(lambda: self._board.go_named(self._board.location(name), name))

    def storeCurrentPosition(self, name: str) -> bool:
        """Give the place where the robot is a name."""
        return self._tell(lambda: self._board.store_location(name, self._board.position()))

    def checkInsideArea(self, area: str | Map2DArea, *is_inside: Any) -> bool:
        """Return whether it is in an area; with a BVector, whether that was stored there."""

        def find() -> bool:
            there = area if isinstance(area, Map2DArea) else self._area(area)
            return there.checkLocationInsideArea(self._here())

        return self._answer(find, is_inside)

    def checkNearToLocation(self, loc: str | Map2DLocation, *more: Any) -> bool:
        """`(place or name, metres, degrees)`: return whether it is so near; with a BVector behind
        the place, whether that was stored there."""
        places = tuple(each for each in more if hasattr(each, "_store"))
        metres, degrees, *_ = (*(each for each in more if each not in places), math.inf)

        def find() -> bool:
            there = loc
            if not isinstance(there, Map2DLocation):
                there = _made(Map2DLocation, self._board.location(there))
            return self._here().is_near_to(there, metres, degrees)

        return self._answer(find, places)

    def findCurrentArea(self, area_name: Any, area: Map2DArea) -> bool:
        """Store the first area that it is in, and its name; False if it is in none."""

        def find() -> bool:
            here = self._here()
            for name in self._board.area_names():
                there = self._area(name)
                if there.checkLocationInsideArea(here):
                    store(area_name, [name])
                    area.__dict__.update(there.__dict__)
                    return True
            return False

        return self._tell(find)

    def _answer(self, find: Any, places: tuple[Any, ...]) -> bool:
        found: list[bool] = []
        done = self._tell(lambda: found.append(find()))
        if done and places:
            store(places[0], found)
            return True
        return done and found[0]

    def _here(self) -> Map2DLocation:
        here: Map2DLocation = _made(Map2DLocation, self._board.position())
        return here

    def _area(self, name: str) -> Map2DArea:
        there: Map2DArea = _made(Map2DArea, self._board.area(name))
        return there


class INavigation2D(
    INavigation2DExtraActions,
    INavigation2DTargetActions,
    INavigation2DControlActions,
    INavigation2DVelocityActions,
):
    """A robot that goes to places."""


def statusToString(status: int) -> str:
    """The name of a status: `navigation_status_idle` ...; that of an error for other numbers."""
    for name, code in CONSTANTS.items():
        if code == status and name.startswith(_STATUS):
            return name
    return f"{_STATUS}error"


def stringToStatus(s: str) -> int:
    """The status of such a name; that of an error for other words."""
    return CONSTANTS[s if s.startswith(_STATUS) and s in CONSTANTS else f"{_STATUS}error"]
