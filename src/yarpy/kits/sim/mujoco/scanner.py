"""Laser scanners of a MuJoCo model, for `yarpy.devices.LaserServer`.

Rules: a site whose name begins with `laser` or `lidar` is one. It looks around in the plane of the
site's x and y, from x on, to the left; it does not see the body that it is fixed to.
"""

from __future__ import annotations

from math import inf
from typing import Any, Final

from yarpy.kits.sim.mujoco.model import Model, mujoco

#: How names of sites begin that are scanners.
NAMES: Final = ("laser", "lidar")
STEP: Final = 1.0  # degrees
FARTHEST: Final = 30.0  # metres


class Scanner:
    """The scanner at a site, by its number."""

    angles: Final = (0.0, 360.0)
    distances: Final = (0.02, FARTHEST)
    step: Final = STEP

    def __init__(self, model: Model, site: int) -> None:
        import numpy as np

        self._model = model
        self._site = site
        self._body = int(model.model.site_bodyid[site])
        turned = np.radians(np.arange(0.0, 360.0, STEP))
        self._ways = np.stack([np.cos(turned), np.sin(turned), np.zeros_like(turned)])
        self.info = f"the laser scanner {model.name_of('site', site)} of {model.name}"

    def ranges(self) -> list[float]:
        """Metres, one for each step; infinite where nothing is."""
        import numpy as np

        cast, hit = mujoco().mj_ray, np.zeros(1, np.int32)
        found = []
        with self._model.present():
            model, data = self._model.model, self._model.data
            at = np.array(data.site_xpos[self._site])
            ways = (data.site_xmat[self._site].reshape(3, 3) @ self._ways).T
            for way in np.ascontiguousarray(ways):
                distance = float(cast(model, data, at, way, None, 1, self._body, hit))
                within = self.distances[0] <= distance <= self.distances[1]
                found.append(distance if within else inf)
        return found


def scanners(model: Model) -> dict[str, Any]:
    """Return the scanners of a model, by the names of their sites."""
    names = {model.name_of("site", number): number for number in range(model.model.nsite)}
    return {
        name: Scanner(model, number)
        for name, number in names.items()
        if name.lower().startswith(NAMES)
    }
