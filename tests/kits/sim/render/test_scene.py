"""The room, and the ball in it."""

import numpy as np
import pytest

from yarpy.kits.sim.render.scene import FAR, NEAR, SIDE, TABLE, Ball, block, room


def normal(surface):
    return np.cross(surface.u, surface.v)


def test_walls_face_into_the_room_and_close_it():
    middle = np.array((0.5, 0.1, 1.3))
    walls = room().background[:6]
    for wall in walls:
        assert np.dot(normal(wall), middle - wall.corner) > 0
    areas = sum(np.linalg.norm(normal(wall)) for wall in walls)
    deep, wide, high = 5.4, 4.4, 2.6
    assert areas == pytest.approx(2 * (deep * wide + deep * high + wide * high))


def test_faces_of_a_block_look_outwards():
    faces = block((1, 2, 3), (2, 4, 6), (0.5, 0.5, 0.5))
    middle = np.array((1.5, 3, 4.5))
    for face in faces:
        away = np.array(face.corner) + np.array(face.u) / 2 + np.array(face.v) / 2 - middle
        assert np.dot(normal(face), away) > 0
    assert len(faces) == 5


def test_textures_have_the_proportions_of_their_surfaces():
    scene = room()
    for surface in [*scene.background, *(face for solid in scene.solids for face in solid)]:
        wide, high = np.linalg.norm(surface.u), np.linalg.norm(surface.v)
        rows, columns = surface.texels.shape
        assert columns / rows == pytest.approx(wide / high, rel=0.15)


def test_things_stand_on_the_table_and_do_not_touch():
    scene = room()
    spans = []
    for solid in scene.solids:
        ends = np.array([np.array(f.corner) + a * np.array(f.u) + b * np.array(f.v)
                         for f in solid for a in (0, 1) for b in (0, 1)])  # fmt: skip
        low, high = ends.min(0), ends.max(0)
        assert low[2] == TABLE
        assert low[0] >= NEAR and high[0] <= FAR
        assert low[1] >= -SIDE and high[1] <= SIDE
        spans.append((low, high))
    ball = scene.balls[0]
    for time in np.linspace(0, ball.lap, 400):
        place = np.array(ball.place(time))
        for low, high in spans:
            nearest = np.clip(place, low, high)
            assert np.linalg.norm(place - nearest) > ball.radius


def test_ball():
    ball = Ball()
    heights = [ball.place(t)[2] for t in np.linspace(100, 101, 200)]
    assert min(heights) == pytest.approx(TABLE + ball.radius, abs=0.01)
    assert max(heights) == pytest.approx(TABLE + ball.radius + 9.81 * 0.5**2 / 8, abs=0.01)
    assert ball.place(3.0) == pytest.approx(ball.place(3.0 + ball.lap))
    assert ball.axis(1.0) != ball.axis(1.5)
