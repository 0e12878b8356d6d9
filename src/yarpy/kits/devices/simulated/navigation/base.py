"""A base that drives as it is told, and knows where it is: fakeOdometry2D, fakeLocalizer and
fakeNavigation in one.

    base = SimulatedBase()
    base.go(Place("kitchen", 1.0, 2.0, 90.0))
    base.position()                                       on the way there, then there

Rules: it lives by the clock that it is given. It drives and turns straight to where it is sent, at
`SPEED` and `TURN`, whatever stands in between. Thread-safe.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from typing import Final

import yarpy
from yarpy import clock
from yarpy.kits.devices.interfaces.place import Odometry, Path, Place
from yarpy.kits.devices.refusal import Refused

#: m/s and deg/s.
SPEED: Final = 0.5
TURN: Final = 60.0


class SimulatedBase:
    """A base, at the origin of the map `map_id` first."""

    def __init__(self, map_id: str = "map", clock: Callable[[], float] = clock.monotonic) -> None:
        self._clock = clock
        self._lock = threading.RLock()  # each method counts on the time that another has advanced
        self._at = clock()
        self._map = map_id
        self._x = self._y = self._theta = 0.0
        self._origin = (0.0, 0.0, 0.0)
        self._command = (0.0, 0.0, 0.0)
        self._until = -math.inf
        self._status = "idle"
        self._way: list[Place] = []
        self._name = ""
        self._localized = True

    # -- IOdometry2D, INavigation2DVelocityActions ---------------------------------------------

    def odometry(self) -> Odometry:
        """Return how it has moved since `reset_odometry`."""
        with self._lock:
            self._advance()
            x0, y0, theta0 = self._origin
            angle = math.radians(theta0)
            dx, dy = self._x - x0, self._y - y0
            x = dx * math.cos(angle) + dy * math.sin(angle)
            y = dy * math.cos(angle) - dx * math.sin(angle)
            theta = math.remainder(self._theta - theta0, 360.0)
            ahead, left, turn = self._command if self._at < self._until else (0.0, 0.0, 0.0)
            angle = math.radians(theta)
            u = ahead * math.cos(angle) - left * math.sin(angle)
            v = ahead * math.sin(angle) + left * math.cos(angle)
            return Odometry(x, y, theta, ahead, left, turn, u, v, turn)

    def reset_odometry(self) -> None:
        """Count from here."""
        with self._lock:
            self._advance()
            self._origin = (self._x, self._y, self._theta)

    def apply_velocity(self, x: float, y: float, theta: float, timeout: float = 0.1) -> None:
        """Drive; the way to a place ends."""
        with self._lock:
            self._advance()
            self._way, self._status = [], "idle"
            self._command, self._until = (x, y, theta), self._at + max(timeout, 0.0)

    def last_velocity(self) -> tuple[float, float, float]:
        """Return the last command."""
        return self._command

    # -- ILocalization2D -----------------------------------------------------------------------

    def start_localization(self) -> None:
        """Know where it is."""
        self._localized = True

    def stop_localization(self) -> None:
        """Know it no longer."""
        self._localized = False

    def position(self) -> Place:
        """Return where it is."""
        with self._lock:
            self._advance()
            if not self._localized:
                raise Refused("the localization was stopped")
            return Place(self._map, self._x, self._y, self._theta)

    def position_with_covariance(self) -> tuple[Place, yarpy.Matrix]:
        """Return where it is: it is sure."""
        return self.position(), yarpy.Matrix([[0.0] * 3] * 3)

    def estimates(self) -> list[Place]:
        """Return where it is."""
        return [self.position()]

    def localization_status(self) -> str:
        """Return whether it knows where it is: `locy` or `locn`."""
        return "locy" if self._localized else "locn"

    def locate(self, place: Place) -> None:
        """Be there."""
        with self._lock:
            self._advance()
            self._map = place.map_id
            self._x, self._y, self._theta = place.x, place.y, place.theta

    def locate_with_covariance(self, place: Place, covariance: yarpy.Matrix) -> None:
        """Be there."""
        self.locate(place)

    # -- INavigation2D -------------------------------------------------------------------------

    def go(self, place: Place) -> None:
        """Go to a place."""
        self._begin([place], "")

    def go_named(self, place: Place, name: str) -> None:
        """Go to a place that has a name."""
        self._begin([place], name)

    def go_by(self, x: float, y: float) -> None:
        """Go so many metres ahead and to the left."""
        self.go_and_turn_by(x, y, 0.0)

    def go_and_turn_by(self, x: float, y: float, theta: float) -> None:
        """Go so many metres, and turn by so many degrees."""
        with self._lock:
            here = self._here()
            angle = math.radians(here.theta)
            here.x += x * math.cos(angle) - y * math.sin(angle)
            here.y += x * math.sin(angle) + y * math.cos(angle)
            here.theta += theta
            self._begin([here], "")

    def follow(self, path: Path) -> None:
        """Go along a path."""
        if not path.waypoints:
            raise Refused("a path without places")
        self._begin([*path.waypoints], "")

    def stop(self) -> None:
        """Go no further."""
        with self._lock:
            self._advance()
            self._way, self._status = [], "idle"
            self._until = -math.inf

    def suspend(self, seconds: float = math.inf) -> None:
        """Pause until `resume`."""
        with self._lock:
            self._advance()
            if self._status == "movg":
                self._status = "paus"

    def resume(self) -> None:
        """Go on."""
        with self._lock:
            self._advance()
            if self._status == "paus":
                self._status = "movg"

    def plan_again(self) -> None:
        """The straight way is the only one."""

    def status(self) -> str:
        """Return what it is doing: `idle`, `movg`, `paus` or `rech`."""
        with self._lock:
            self._advance()
            return self._status

    def target(self) -> Place:
        """Return where it goes."""
        if not self._way:
            raise Refused("it goes nowhere")
        return self._way[-1]

    def target_from_here(self) -> tuple[float, float, float]:
        """Return where it goes, seen from here."""
        with self._lock:
            here, there = self._here(), self.target()
            angle = math.radians(here.theta)
            dx, dy = there.x - here.x, there.y - here.y
            ahead = dx * math.cos(angle) + dy * math.sin(angle)
            left = dy * math.cos(angle) - dx * math.sin(angle)
            return ahead, left, math.remainder(there.theta - here.theta, 360.0)

    def target_name(self) -> str:
        """Return the name of where it goes."""
        return self._name

    def waypoints(self, which: str) -> Path:
        """Return the places on the way."""
        return Path([*self._way])

    def waypoint(self) -> Place:
        """Return the next of them."""
        if not self._way:
            raise Refused("it goes nowhere")
        return self._way[0]

    # -- within --------------------------------------------------------------------------------

    def _here(self) -> Place:
        self._advance()
        return Place(self._map, self._x, self._y, self._theta)

    def _begin(self, way: list[Place], name: str) -> None:
        with self._lock:
            self._advance()
            if any(place.map_id not in ("", self._map) for place in way):
                raise Refused(f"it is in the map {self._map!r}")
            self._way, self._name, self._status = way, name, "movg"
            self._until = -math.inf

    def _advance(self) -> None:
        """Let the time pass that has passed."""
        now = self._clock()
        seconds, self._at = max(now - self._at, 0.0), now
        driven = min(seconds, self._until - (now - seconds))
        if driven > 0:
            ahead, left, turn = (each * driven for each in self._command)
            angle = math.radians(self._theta + turn / 2)
            self._x += ahead * math.cos(angle) - left * math.sin(angle)
            self._y += ahead * math.sin(angle) + left * math.cos(angle)
            self._theta = math.remainder(self._theta + turn, 360.0)
        while self._status == "movg" and seconds > 0:
            seconds = self._approach(self._way[0], seconds)
            if seconds > 0 or self._is_at(self._way[0]):
                if len(self._way) == 1:
                    self._status = "rech"
                else:
                    del self._way[0]

    def _approach(self, place: Place, seconds: float) -> float:
        """Go towards a place for so many seconds; return how many are left there."""
        dx, dy = place.x - self._x, place.y - self._y
        turn = math.remainder(place.theta - self._theta, 360.0)
        needed = max(math.hypot(dx, dy) / SPEED, abs(turn) / TURN)
        share = 1.0 if needed <= seconds else seconds / needed
        self._x += dx * share
        self._y += dy * share
        self._theta = math.remainder(self._theta + turn * share, 360.0)
        return max(seconds - needed, 0.0)

    def _is_at(self, place: Place) -> bool:
        return (self._x, self._y) == (place.x, place.y)
