"""Cameras of a MuJoCo model, for `yarpy.devices.FrameGrabberServer`.

Rules: an OpenGL context belongs to one thread, so all cameras of a model share a painter with its
own thread. Shadows are coarser than MuJoCo's default: without a graphics card they would take nine
tenths of the time.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from concurrent.futures import Future
from math import atan, degrees, radians, tan
from queue import SimpleQueue
from typing import Any, ClassVar, Final, TypeVar

from yarpy.data.sig.image import Image
from yarpy.errors import UnknownPlugin
from yarpy.kits.sim.mujoco.model import Model, mujoco

SHADOWS: Final = 1024  # pixels of a shadow map
SAMPLES: Final = 2  # samples per pixel, against jagged edges
FREE: Final = -1  # the view that MuJoCo offers for every model
TIMEOUT: Final = 30.0  # seconds for a picture; a driver may hang

_ADVICE: Final = (
    "pictures of a MuJoCo model need OpenGL: on Debian apt-get install libegl1 libgl1-mesa-dri, "
    "or with MUJOCO_GL=osmesa libosmesa6"
)


T = TypeVar("T")


class Painter:
    """Draws `width` times `height` pixels of a model. Raises UnknownPlugin if nothing can draw."""

    _spoiled: ClassVar[str] = ""  # why nothing can draw in this process

    def __init__(self, model: Model, width: int, height: int) -> None:
        self._model = model
        self._work: SimpleQueue[Callable[[], object] | None] = SimpleQueue()
        threading.Thread(target=self._run, name="yarpy mujoco painter", daemon=True).start()
        self.size = width, height
        quality, screen = model.model.vis.quality, model.model.vis.global_
        quality.offsamples = min(quality.offsamples, SAMPLES)
        quality.shadowsize = min(quality.shadowsize, SHADOWS)
        screen.offwidth = max(screen.offwidth, width)
        screen.offheight = max(screen.offheight, height)
        try:
            if Painter._spoiled:
                raise RuntimeError(Painter._spoiled)
            self._renderer: Any = self._do(self._open)
        except Exception as error:
            # Once MuJoCo has failed, another attempt would hang forever, and Python with it.
            Painter._spoiled = Painter._spoiled or str(error) or type(error).__name__
            self._work.put(None)
            how = os.environ.get("MUJOCO_GL", "")
            raise UnknownPlugin(f"{_ADVICE} (MUJOCO_GL={how}: {error})") from error

    def paint(self, camera: int) -> tuple[Image, float]:
        """Return the picture that a camera sees, and its time."""
        return self._do(lambda: self._paint(camera))

    def close(self) -> None:
        """Release the OpenGL context."""
        self._do(self._renderer.close)
        self._work.put(None)

    def _run(self) -> None:
        while (action := self._work.get()) is not None:
            action()

    def _do(self, action: Callable[[], T]) -> T:
        """Run a function in the thread that draws."""
        result: Future[T] = Future()

        def act() -> None:
            try:
                result.set_result(action())
            except Exception as error:
                result.set_exception(error)

        self._work.put(act)
        return result.result(TIMEOUT)

    def _open(self) -> Any:
        width, height = self.size
        renderer = mujoco().Renderer(self._model.model, height, width)
        with self._model.present():
            renderer.update_scene(self._model.data)
        renderer.render()  # so that errors appear now
        return renderer

    def _paint(self, camera: int) -> tuple[Image, float]:
        with self._model.present():
            self._renderer.update_scene(self._model.data, camera)
            time = self._model.time
        return Image(self._renderer.render()), time


class Camera:
    """One camera of a model, by its number; `FREE` is a view of the whole."""

    def __init__(self, painter: Painter, model: Any, number: int) -> None:
        self._painter = painter
        self._number = number
        self._time = 0.0
        self._vertical = float(model.vis.global_.fovy if number < 0 else model.cam_fovy[number])

    def image(self) -> Image:
        """Return the picture that the camera sees now."""
        image, self._time = self._painter.paint(self._number)
        return image

    def timestamp(self) -> float:
        """The moment that the last image shows."""
        return self._time

    @property
    def field_of_view(self) -> tuple[float, float]:
        """Horizontal and vertical, degrees."""
        width, height = self._painter.size
        across = 2 * atan(tan(radians(self._vertical) / 2) * width / height)
        return degrees(across), self._vertical
