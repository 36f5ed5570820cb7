"""Simulations from numpy arrays."""

import threading

import numpy as np
import pytest
from conftest import tuft

import hairspring as hs


def strands(count=5, points=16, length=0.15):
    """Straight strands that hang from a row of roots."""
    t = np.linspace(0, length, points)
    all_points = np.zeros((count, points, 3), np.float32)
    all_points[:, :, 0] = 0.01 * np.arange(count)[:, None]
    all_points[:, :, 1] = -t
    return hs.Groom(all_points.reshape(-1, 3), np.arange(count + 1) * points)


def test_hair_follows_its_roots():
    sim = hs.Simulation(strands())
    for frame in range(1, 61):
        report = sim.step(1 / 60, anchor=[0.1 * frame / 60, 0, 0])
    assert report["reset_strands"] == 0 and report["substeps"] >= 4
    roots = sim.points[sim.offsets[:-1]]
    np.testing.assert_allclose(roots[:, 0], 0.1 + 0.01 * np.arange(5), atol=1e-6)
    assert sim.time == pytest.approx(1.0)


def test_a_strand_hangs_at_the_angle_of_the_closed_form_in_an_acceleration():
    # Gravity of 1 g sideways and 1 g downward: a heavy, soft strand hangs at 45°.
    sim = hs.Simulation(
        strands(1, 24, 0.3),
        material=hs.Material(bend=0.0, drag=5.0),
        gravity=(9.81, -9.81, 0),
        solver=hs.Solver(sag_free=False),
    )
    for _ in range(1200):
        sim.step(1 / 60)
    x, y, _ = (sim.points[-1] - sim.points[2]).tolist()
    assert np.degrees(np.arctan2(x, -y)) == pytest.approx(45, abs=0.01)
    assert len(sim) == 1


def test_a_snapshot_restores_the_same_bits():
    sim = hs.Simulation(strands(), material=hs.Material("wavy"))
    for frame in range(10):
        sim.step(1 / 60, wind=(2, 0, 0))
    state = sim.snapshot()
    for frame in range(10):
        sim.step(1 / 60, wind=(2, 0, 0))
    first = sim.points
    sim.restore(state)
    for frame in range(10):
        sim.step(1 / 60, wind=(2, 0, 0))
    assert (sim.points == first).all()


def test_a_force_in_numpy_is_called_once_a_frame_and_moves_hair():
    sim = hs.Simulation(strands(), solver=hs.Solver(sag_free=False))
    calls = []

    def lift(points, velocities, time):
        calls.append((points.shape, velocities.shape, time))
        return np.tile(np.float32([1, 2 * 9.81, 0]), (len(points), 1))

    sim.add_force(lift)
    for _ in range(120):
        sim.step(1 / 60)
    assert len(calls) == 120 and calls[0][:2] == ((80, 3), (80, 3))
    # Twice gravity upward: the strands stand instead of hanging.
    assert sim.points[15, 1] > 0
    sim.clear_forces()
    for _ in range(240):
        sim.step(1 / 60)
    assert sim.points[15, 1] < 0 and len(calls) == 120


def test_a_force_may_return_drag_and_wind():
    sim = hs.Simulation(strands(1))
    target = np.tile(np.float32([0.5, 0, 0]), (16, 1))
    sim.add_force(lambda p, v, t: {"drag_velocity": target, "drag_rate": 30.0, "wind": target})
    for _ in range(30):
        sim.step(1 / 60)
    assert sim.points[-1, 0] > 0.02
    sim.clear_forces()
    sim.add_force(lambda p, v, t: {"acceleraton": target})
    with pytest.raises(hs.SettingError, match="acceleraton"):
        sim.step(1 / 60)


def test_an_exception_of_a_force_reaches_the_caller():
    sim = hs.Simulation(strands(1))
    sim.add_force(lambda p, v, t: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        sim.step(1 / 60)


def test_a_sphere_pushes_hair_and_passes_on_its_motion():
    sim = hs.Simulation(strands(1))
    ball = hs.Collider.sphere((-0.05, -0.1, 0), 0.02)
    for frame in range(60):
        ball.pose = (0.08 * frame / 60, 0, 0)
        sim.step(1 / 60, colliders=[ball])
    centre = np.float32([-0.05, -0.1, 0]) + np.float32(ball.pose[:3, 3])
    distance = np.linalg.norm(sim.points - centre, axis=1)
    assert distance.min() > 0.02 - 1e-3 and sim.points[:, 0].max() > 0.01


def test_a_collider_in_numpy_keeps_hair_out():
    calls = []

    def ball(points, time):
        calls.append(time)
        return np.linalg.norm(points - [0, -0.2, 0], axis=1) - 0.05

    sim = hs.Simulation(strands(1, 24, 0.3), gravity=(0, -9.81, 0.5))
    collider = hs.Collider.custom(ball, ((-0.08, -0.28, -0.08), (0.08, -0.12, 0.08)), cell=0.005)
    for _ in range(90):
        sim.step(1 / 60, colliders=[collider])
    inside = 0.05 - np.linalg.norm(sim.points - np.float32([0, -0.2, 0]), axis=1)
    assert inside.max() < 2e-3
    assert len(calls) == 90


def test_a_field_from_an_array_has_its_distances():
    axis = np.linspace(-0.1, 0.1, 21)
    z, y, x = np.meshgrid(axis, axis, axis, indexing="ij")
    field = hs.SignedDistanceField((-0.1, -0.1, -0.1), 0.01, np.sqrt(x**2 + y**2 + z**2) - 0.05)
    assert field.distances.shape == (21, 21, 21)
    np.testing.assert_allclose(field.distance([[0.05, 0, 0], [0.08, 0, 0]]), [0, 0.03], atol=1e-3)


def test_arrays_of_a_groom_share_its_memory_and_are_read_only():
    groom = strands()
    assert not groom.points.flags.writeable and not groom.points.flags.owndata
    with pytest.raises(ValueError):
        groom.points[0, 0] = 1
    points = groom.points
    del groom
    assert points.shape == (80, 3) and points[0, 1] == 0


def test_wrong_input_is_one_sentence():
    with pytest.raises(hs.SettingError, match="offsets"):
        hs.Groom(np.zeros((4, 3)), [0, 5])
    with pytest.raises(hs.SettingError, match=r"shape \[n, 3\]"):
        hs.Groom(np.zeros((4, 2)), [0, 4])
    with pytest.raises(hs.SettingError, match="not finite"):
        hs.Groom(np.full((4, 3), np.nan), [0, 4])
    with pytest.raises(hs.SettingError, match="bent.*bend"):
        hs.Material(bent=1)
    with pytest.raises(hs.SettingError, match="friction"):
        hs.Material(friction=2)
    with pytest.raises(hs.SettingError, match="short-fur"):
        hs.Material("wvy")
    with pytest.raises(hs.FileError, match="was not found"):
        hs.Groom.read("/nowhere.hair")
    sim = hs.Simulation(strands())
    with pytest.raises(hs.SettingError):
        sim.step(0.0)
    with pytest.raises(hs.SettingError, match="scales"):
        sim.step(1 / 60, anchor=np.diag([2, 2, 2, 1.0]))
    with pytest.raises(hs.SettingError):
        sim.step(1 / 60, roots=np.zeros((2, 3)))


def test_other_threads_run_during_a_step():
    sim = hs.Simulation(strands(2000, 32))
    ticks, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            ticks[0] += 1

    thread = threading.Thread(target=count)
    thread.start()
    before = ticks[0]
    for _ in range(10):
        sim.step(1 / 60)
    during = ticks[0] - before
    stop.set()
    thread.join()
    assert during > 0


def test_settings_are_those_of_scene_files():
    wavy = hs.Material("wavy", friction=0.1)
    assert (wavy.bend, wavy.friction) == (4.0, np.float32(0.1))
    assert wavy.replace(bend=2).bend == 2.0 and wavy == hs.Material("wavy", friction=0.1)
    assert "substeps" in hs.Solver().to_dict()
    with pytest.raises(AttributeError):
        wavy.nothing


def test_numbers_that_are_not_finite_are_refused():
    points, offsets = tuft()
    guides = np.zeros((12, 3), np.uint32)
    with pytest.raises(hs.SettingError, match="guide_weights"):
        hs.Groom(points, offsets, guides=guides, guide_weights=np.full((12, 3), np.nan, np.float32))
    with pytest.raises(hs.SettingError, match="`center` must be 3 finite numbers"):
        hs.Collider.sphere((np.nan, 0, 0), 0.1)
    stage = hs.Stage(hs.Scene.builtin(strands=50, guides=10))
    pose = np.eye(4)
    pose[0, 3] = np.inf
    for wrong in ((np.nan, 0, 0), pose):
        with pytest.raises(hs.SettingError, match="finite"):
            stage.move_body(wrong)
