"""Pictures of the room, against a caster of single rays that knows none of the tricks."""

from functools import cache

import numpy as np
import pytest

from yarpy.kits.sim.head import BASELINE, Pose, eye_pose
from yarpy.kits.sim.render.renderer import Renderer
from yarpy.kits.sim.render.scene import Scene, room

scene = cache(room)  # not before a test wants it: workers that run none would paint it, too
POSES = [
    (0, 0, 0, 0, 0, 0),
    (-25, 0, 0, -10, 0, 0),
    (-15, 45, 0, 0, 0, 0),
    (10, -30, 50, 5, 40, 10),
    (-35, 60, -55, -30, -50, 50),
    (30, 0, 0, 30, 0, 0),
]


@cache
def still() -> Scene:
    """The room without its ball."""
    return Scene(scene().background, scene().solids, ())


@pytest.fixture(scope="module")
def renderer() -> Renderer:
    return Renderer(scene(), 160, 120)


def cast(scene: Scene, pose: Pose, width: int, height: int) -> np.ndarray:
    """The nearest surface along each ray: (height, width, 3)."""
    focal = 0.8 * width
    y, x = np.indices((height, width), dtype=float)
    rays = np.stack([x - (width - 1) / 2, y - (height - 1) / 2, np.full_like(x, focal)], -1)
    rays = rays @ np.array(pose.rotation).T
    eye = np.array(pose.position)
    nearest = np.full((height, width), np.inf)
    seen = np.zeros((height, width), "u4")
    for surface in [*scene.background, *(face for solid in scene.solids for face in solid)]:
        u, v, corner = (np.array(part, float) for part in (surface.u, surface.v, surface.corner))
        normal = np.cross(u, v)
        with np.errstate(all="ignore"):
            distance = (corner - eye) @ normal / (rays @ normal)
            place = eye + rays * distance[..., None] - corner
        a, b = place @ u / (u @ u), place @ v / (v @ v)
        facing = (eye - corner) @ normal > 0
        hit = facing & (distance > 0) & (distance < nearest)
        hit &= (a >= 0) & (a < 1) & (b >= 0) & (b < 1)
        rows, columns = surface.texels.shape
        nearest[hit] = distance[hit]
        seen[hit] = surface.texels[(b[hit] * rows).astype(int), (a[hit] * columns).astype(int)]
    return seen.view("u1").reshape(height, width, 4)[..., :3]


def red_ball(pixels: np.ndarray) -> tuple[float, float]:
    """The middle of what differs from the picture without the ball."""
    rows, columns = np.nonzero(pixels.any(-1))
    return float(columns.mean()), float(rows.mean())


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("angles", POSES, ids=str)
def test_every_pixel(angles, side):
    pose = eye_pose(angles, side)
    ours = Renderer(still(), 160, 120).render(pose, 0.0)
    assert ours.shape == (120, 160, 3) and ours.dtype == np.uint8
    other = cast(still(), pose, 160, 120)
    assert (ours != other).any(-1).mean() < 0.01, "but for rounding at edges of texels"
    assert ours.any(-1).all(), "no pixel is left out"


def test_the_same_again(renderer: Renderer):
    pose = eye_pose(POSES[1], "left")
    first = renderer.render(pose, 12.5)
    kept = first.copy()
    renderer.render(eye_pose(POSES[3], "left"), 13.0)
    assert (renderer.render(pose, 12.5) == kept).all()
    assert (first == kept).all(), "each picture has memory of its own"
    assert (renderer.render(pose, 12.5) == kept).all(), "also if the camera did not move"


def test_ball_moves_and_boxes_hide_it(renderer: Renderer):
    pose = eye_pose((-18, 0, 0, 0, 0, 0), "left")
    ball = scene().balls[0]
    bare = Renderer(still(), 160, 120)
    background = bare.render(pose, 0.0)
    sizes = []
    for time in np.arange(0, ball.lap, 0.1):
        changed = (renderer.render(pose, time) != background).any(-1)
        sizes.append(int(changed.sum()))
        x, y, _ = renderer.lens.point(pose, ball.place(time))
        if changed[round(y), round(x)]:
            continue
        assert time == pytest.approx(ball.lap / 2, abs=1.0), "hidden only behind the box"
    assert min(sizes) < 0.5 * max(sizes)


def test_parallax(renderer: Renderer):
    """Each eye sees the ball where geometry says."""
    place = scene().balls[0].place(0.06)
    seen = []
    for side in ("left", "right"):
        pose = eye_pose((-18, 0, 0, 0, 0, 0), side)
        picture = renderer.render(pose, 0.06)
        other = Renderer(still(), 160, 120).render(pose, 0.06)
        changed = (picture != other).any(-1)
        x, y, depth = renderer.lens.point(pose, place)
        around = changed[round(y) - 12 : round(y) + 6, round(x) - 20 : round(x) + 20]
        columns = np.nonzero(around)[1]
        assert columns.mean() - 20 == pytest.approx(0, abs=1.5)
        seen.append(x)
    assert seen[0] - seen[1] == pytest.approx(renderer.lens.focal * BASELINE / depth)


def test_turning_the_head_moves_the_picture(renderer: Renderer):
    ahead = renderer.render(eye_pose((0, 0, 0, 0, 0, 0), "left"), 0.0).astype(float)
    turned = renderer.render(eye_pose((0, 0, 5, 0, 0, 0), "left"), 0.0).astype(float)
    shift = round(np.tan(np.radians(5)) * renderer.lens.focal)  # to the left: the room moves right
    moved = abs(ahead[:40, 20 : 140 - shift] - turned[:40, 20 + shift : 140]).mean()
    assert moved < 0.4 * abs(ahead[:40, 20:140] - turned[:40, 20:140]).mean()


def test_odd_sizes():
    for width, height in ((17, 33), (321, 239)):
        pixels = Renderer(scene(), width, height).render(eye_pose(POSES[0], "left"), 1.0)
        assert pixels.shape == (height, width, 3)
