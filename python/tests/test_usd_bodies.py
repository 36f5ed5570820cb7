"""Meshes and cameras of USD, written with usd-core."""

import numpy as np
import pytest

pytest.importorskip("pxr")
from pxr import Gf, UsdGeom, Vt
from stages import CORNERS, FACES, a_mesh, new_stage, volume

import hairspring as hs
from hairspring import usd


def test_topology_that_changes_is_refused(tmp_path):
    stage = new_stage(tmp_path / "a.usda")
    mesh = UsdGeom.Mesh.Define(stage, "/m")
    for t, n in ((1, 3), (2, 4)):
        mesh.CreatePointsAttr().Set([Gf.Vec3f(i, i * i, 0) for i in range(n)], t)
        mesh.CreateFaceVertexCountsAttr().Set([n], t)
        mesh.CreateFaceVertexIndicesAttr().Set(list(range(n)), t)
    stage.Save()
    with pytest.raises(hs.FileError, match="topology of /m changes"):
        hs.Body.read(tmp_path / "a.usda")


@pytest.mark.parametrize("codes, spacing", [(1.0, 1 / 24), (24.0, 0.5), (24.0, 1.0)])
def test_every_sample_of_a_mesh_counts(tmp_path, codes, spacing):
    stage = new_stage(tmp_path / "m.usda")
    stage.SetTimeCodesPerSecond(codes)
    mesh = a_mesh(stage, CORNERS, *FACES)
    for k in range(25):
        mesh.GetPointsAttr().Set(Vt.Vec3fArray.FromNumpy((CORNERS + [0.01 * k, 0, 0]).astype(np.float32)), k * spacing)
    stage.Save()
    read = usd.read_mesh(tmp_path / "m.usda")
    assert read.rate == pytest.approx(codes / spacing, rel=1e-4) and read.frames.shape == (25, 4, 3)
    np.testing.assert_allclose(read.frames[:, 0, 0], 0.01 * np.arange(25), atol=1e-5)


def test_another_number_of_points_or_an_endless_motion_is_refused(tmp_path):
    for name, times, points, sentence in (
        ("points", (1, 2), CORNERS[:3], "has 3 points at time 2 and 4 in the first sample"),
        ("time", (0, 1e13), CORNERS, "the limit is 100000"),
    ):
        stage = new_stage(tmp_path / f"{name}.usda")
        mesh = a_mesh(stage, CORNERS, *FACES)
        mesh.GetPointsAttr().Set(Vt.Vec3fArray.FromNumpy(CORNERS.astype(np.float32)), times[0])
        mesh.GetPointsAttr().Set(Vt.Vec3fArray.FromNumpy(points.astype(np.float32)), times[1])
        stage.Save()
        with pytest.raises(hs.FileError, match=sentence):
            hs.Body.read(tmp_path / f"{name}.usda")


@pytest.mark.parametrize("scale", [(1, 1, 1), (-1, 1, 1), (-1, -1, -1)])
def test_a_mirrored_mesh_is_not_inside_out(tmp_path, scale):
    stage = new_stage(tmp_path / "m.usda")
    mesh = a_mesh(stage, CORNERS, *FACES)
    mesh.AddScaleOp().Set(Gf.Vec3f(*scale))
    stage.Save()
    assert volume(usd.read_mesh(tmp_path / "m.usda")) == pytest.approx(0.2**3 / 6, rel=1e-4)


def test_concave_polygons_get_triangles_inside_them(tmp_path):
    corners = np.array([[0, 0, 0], [3, 0, 0], [3, 1, 0], [1, 1, 0], [1, 3, 0], [0, 3, 0]])
    for turn in range(6):
        stage = new_stage(tmp_path / f"m{turn}.usda")
        a_mesh(stage, corners, [6], np.roll(np.arange(6), turn).tolist())
        stage.Save()
        read = usd.read_mesh(tmp_path / f"m{turn}.usda")
        a, b, c = (read.vertices[read.triangles[:, k]] for k in range(3))
        areas = np.cross(b - a, c - a)[:, 2] / 2
        assert (areas > 0).all() and areas.sum() == pytest.approx(5)


def test_cameras_are_read(tmp_path):
    stage = new_stage(tmp_path / "a.usda", "Z", 0.01)
    camera = UsdGeom.Camera.Define(stage, "/cam")
    camera.AddTranslateOp().Set(Gf.Vec3d(0, -200, 150))
    camera.AddRotateXOp().Set(90.0)
    stage.Save()
    [sample] = usd.read_cameras(tmp_path / "a.usda")["/cam"]
    np.testing.assert_allclose(sample["position"], [0, 1.5, 2], atol=1e-6)
    np.testing.assert_allclose(sample["target"] - sample["position"], [0, 0, -1], atol=1e-6)
    assert 10 < sample["fov"] < 60
