"""Scenes, stages and files."""

import numpy as np
import pytest

import hairspring as hs

SCENE = """
[builtin]
strands = 300
guides = 40

[wind]
velocity = [1.0, 0.0, 0.0]
"""


def test_a_scene_plays():
    stage = hs.Stage(hs.Scene.from_toml(SCENE))
    # The brows are further grooms.
    assert len(stage.grooms[0]) == 300 and len(set(stage.guides())) == 40
    rest = stage.points()
    for _ in range(5):
        times = stage.step(fps=30)
    assert set(times) == {"body", "simulate", "follow"}
    moved = stage.points()
    assert moved.shape == rest.shape and np.abs(moved - rest).max() > 1e-3
    out = np.empty_like(moved)
    stage.write_points(out)
    assert (out == moved).all()
    assert stage.body_vertices.shape[1] == 3 and len(stage.guides()) == 300
    stage.reset()
    assert (stage.points() == rest).all() and stage.time == 0


def test_frame_rates_are_exact():
    stage = hs.Stage(hs.Scene.builtin("straight", strands=50, guides=10))
    for _ in range(24):
        stage.step(fps=23.976)
    assert stage.time == 24 * 1001 / 24000


def test_a_force_acts_on_the_guides_of_a_stage():
    still = hs.Scene.from_toml("[builtin]\nstrands = 200\nguides = 30\nmotion = false\n")
    stage, blown = hs.Stage(still), hs.Stage(still)
    blown.add_force(lambda p, v, t: np.tile(np.float32([20, 0, 0]), (len(p), 1)))
    for _ in range(30):
        stage.step(30)
        blown.step(30)
    assert (blown.points() - stage.points())[:, 0].mean() > 0.005


def test_a_groom_is_written_and_read(tmp_path):
    groom = hs.Scene.builtin("curly", strands=20, guides=5).grooms[0]
    path = tmp_path / "curly.hair"
    lost = groom.write(path)
    assert all(isinstance(note, str) for note in lost)
    read = hs.Groom.read(path)
    np.testing.assert_allclose(read.points, groom.points, atol=1e-6)
    assert (read.offsets == groom.offsets).all()


def test_a_scene_of_arrays_grows_on_its_body():
    n = 12
    theta, phi = np.meshgrid(np.linspace(0, np.pi, n), np.linspace(0, 2 * np.pi, 2 * n), indexing="ij")
    ball = 0.1 * np.stack([np.sin(theta) * np.cos(phi), np.cos(theta), np.sin(theta) * np.sin(phi)], -1).reshape(-1, 3)
    quads = [
        [i * 2 * n + j, i * 2 * n + j + 1, (i + 1) * 2 * n + j + 1, (i + 1) * 2 * n + j]
        for i in range(n - 1)
        for j in range(2 * n - 1)
    ]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    body = hs.Body(ball, triangles)
    root = np.float32([0, 0.1, 0])
    points = root + np.linspace(0, 0.1, 12)[:, None] * np.float32([0, 1, 0])
    scene = hs.Scene([hs.Groom(points, [0, 12])], body=body, materials=[hs.Material("straight")], guides="all")
    stage = hs.Stage(scene)
    stage.move_body([0.0, 0.2, 0.0])
    for _ in range(10):
        stage.step(30)
    np.testing.assert_allclose(stage.points()[0], root + [0, 0.2, 0], atol=1e-5)


def test_errors_of_scenes_name_the_line():
    with pytest.raises(hs.FileError, match="line 2"):
        hs.Scene.from_toml("[solver]\nsubstep = 4\n")
    with pytest.raises(hs.SettingError, match="styles are"):
        hs.Scene.builtin("mohawk")
