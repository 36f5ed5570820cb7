"""Layers over a stage (`bake --over`): the space, the prims and the time of the curves that they override."""

import numpy as np
import pytest

pytest.importorskip("pxr")
from conftest import tuft
from pxr import Gf, Sdf, Usd, UsdGeom
from stages import define_curves, new_stage

from hairspring import usd
from hairspring.description import Description, MovingGroom

STRANDS = 12


def groom_of(read):
    """What a bake of curves that were read gives to the writer."""
    strands = len(read.offsets) - 1
    radii = np.full(len(read.points), 4e-5, np.float32) if read.radii is None else read.radii
    return MovingGroom("g", read.points, read.offsets, radii, np.ones(strands, bool), read.groups, read.group_names)


def layer_over(path, base, frames=(1,), fps=24.0, shift=0.0):
    """Writes a layer over a stage, whose points move by `shift` [m] along X from their places in the file."""
    read = usd.read_curves(base)
    writer = usd.CurvesWriter(path, Description(fps, frames[0], len(frames), [groom_of(read)]), over=base)
    points = read.points + np.float32([shift, 0, 0])
    try:
        for frame in frames:
            writer.frame(frame, points, np.zeros_like(points))
    except BaseException:
        writer.discard()
        raise
    writer.finish()
    return Usd.Stage.Open(str(path)), points


def in_world(stage, path, time):
    curves = UsdGeom.BasisCurves(stage.GetPrimAtPath(path))
    matrix = np.array(curves.ComputeLocalToWorldTransform(time))
    return np.array(curves.GetPointsAttr().Get(time)) @ matrix[:3, :3] + matrix[3, :3]


def test_curves_below_a_parent_that_moves_are_where_the_simulation_has_them(tmp_path):
    base = new_stage(tmp_path / "a.usda")
    parent = UsdGeom.Xform.Define(base, "/rig").AddTranslateOp()
    for frame in (1, 20):
        parent.Set(Gf.Vec3d(0.02 * frame, 0, 0), frame)
    define_curves(base, "/rig/hair", *tuft())
    base.Save()
    stage, points = layer_over(tmp_path / "over.usda", tmp_path / "a.usda", frames=[1, 10, 20], shift=0.3)
    for frame in (1, 10, 20):
        np.testing.assert_allclose(in_world(stage, "/rig/hair", frame), points, atol=1e-6)


def test_static_curves_below_a_parent_that_moves_are_read_at_its_first_sample(tmp_path):
    base = new_stage(tmp_path / "a.usda")
    UsdGeom.Xform.Define(base, "/rig").AddTranslateOp().Set(Gf.Vec3d(5, 0, 0), 1)
    points, offsets = tuft()
    define_curves(base, "/rig/hair", points, offsets)
    base.Save()
    np.testing.assert_allclose(usd.read_curves(tmp_path / "a.usda").points, points + [5, 0, 0], atol=1e-6)


@pytest.mark.parametrize("ids", [([0] * 6 + [1] * 6, [7] * 12), ([1] * 12, [0] * 12), ([5] * 12, [5] * 12)])
def test_groups_of_the_file_do_not_choose_the_prims(tmp_path, ids):
    base, shifts = new_stage(tmp_path / "a.usda"), (0.0, 0.5)
    points, offsets = tuft()
    for name, own, shift in zip(("a", "b"), ids, shifts):
        curves = define_curves(base, f"/{name}", points + np.float32([shift, 0, 0]), offsets)
        UsdGeom.PrimvarsAPI(curves).CreatePrimvar("groom_group_id", Sdf.ValueTypeNames.IntArray, "uniform").Set(own)
    base.Save()
    stage, _ = layer_over(tmp_path / "over.usda", tmp_path / "a.usda", shift=0.1)
    for name, shift in zip(("a", "b"), shifts):
        np.testing.assert_allclose(in_world(stage, f"/{name}", 1), points + np.float32([shift + 0.1, 0, 0]), atol=1e-6)


def test_attributes_of_other_points_are_blocked(tmp_path):
    base = new_stage(tmp_path / "a.usda")
    points, offsets = tuft()
    curves = define_curves(base, "/hair", points, offsets, kind="cubic", basis="bspline")
    api, types = UsdGeom.PrimvarsAPI(curves), Sdf.ValueTypeNames
    api.CreatePrimvar("widths", types.FloatArray, "vertex").Set([1e-4] * len(points))
    api.CreatePrimvar("displayColor", types.Color3fArray, "vertex").Set([(1, 0, 0)] * len(points))
    base.Save()
    stage, moved = layer_over(tmp_path / "over.usda", tmp_path / "a.usda")
    hair = UsdGeom.BasisCurves(stage.GetPrimAtPath("/hair"))
    api = UsdGeom.PrimvarsAPI(hair)
    assert len(hair.GetPointsAttr().Get(1)) == len(moved) != len(points)
    assert not api.GetPrimvar("widths").HasValue() and not api.GetPrimvar("displayColor").HasValue()
    assert len(hair.GetWidthsAttr().Get(1)) == len(moved)


def test_other_frames_than_those_of_the_stage_are_refused(tmp_path):
    base = new_stage(tmp_path / "a.usda")
    base.SetTimeCodesPerSecond(24)
    base.SetStartTimeCode(1001)
    base.SetEndTimeCode(1020)
    define_curves(base, "/hair", *tuft())
    base.Save()
    with pytest.raises(ValueError, match="bake with --fps 24"):
        layer_over(tmp_path / "o.usda", tmp_path / "a.usda", frames=[1001], fps=30)
    with pytest.raises(ValueError, match="--start 1001 --frames 1001-1020"):
        layer_over(tmp_path / "o.usda", tmp_path / "a.usda", frames=[1])
    layer_over(tmp_path / "o.usda", tmp_path / "a.usda", frames=[1001])
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.usda", "o.usda"]


def test_a_copied_prim_and_a_prim_of_no_size_are_refused(tmp_path):
    base = new_stage(tmp_path / "a.usda")
    instancer = UsdGeom.PointInstancer.Define(base, "/all")
    define_curves(base, "/all/hair", *tuft())
    instancer.CreatePrototypesRel().SetTargets(["/all/hair"])
    instancer.CreateProtoIndicesAttr([0, 0])
    instancer.CreatePositionsAttr([(0, 0, 0), (1, 0, 0)])
    base.Save()
    with pytest.raises(ValueError, match="a PointInstancer copies them"):
        layer_over(tmp_path / "o.usda", tmp_path / "a.usda")
    base = new_stage(tmp_path / "b.usda")
    UsdGeom.Xform.Define(base, "/rig").AddScaleOp().Set(Gf.Vec3f(0, 0, 0))
    define_curves(base, "/rig/hair", *tuft())
    base.Save()
    with pytest.raises(ValueError, match="/rig/hair is scaled to 0"):
        layer_over(tmp_path / "o.usda", tmp_path / "b.usda")


def test_hair_of_another_size_is_refused(tmp_path):
    base = new_stage(tmp_path / "a.usda")
    define_curves(base, "/hair", *tuft())
    base.Save()
    groom = groom_of(usd.read_curves(tmp_path / "a.usda", scale=0.01))
    with pytest.raises(ValueError, match="the groom is 0.01 times as large as its curves /hair"):
        usd.CurvesWriter(tmp_path / "o.usda", Description(24, 1, 1, [groom]), over=tmp_path / "a.usda")


def test_a_material_keeps_the_names_of_the_stage(tmp_path):
    base = new_stage(tmp_path / "a.usda")
    define_curves(base, "/hair", *tuft())
    UsdGeom.Xform.Define(base, "/hair_physics")
    base.Save()
    read = usd.read_curves(tmp_path / "a.usda")
    groom = groom_of(read)
    groom.materials = [{"radius": 4e-5, "bend": 1.0, "twist": 1.0, "density": 1300.0, "friction": 0.3, "friction_kinetic": 1.0}]
    groom.materials[0] |= {"young": 3.9e9, "shear": 0.89e9}
    writer = usd.CurvesWriter(tmp_path / "o.usda", Description(24, 1, 1, [groom]), over=tmp_path / "a.usda")
    writer.frame(1, read.points, np.zeros_like(read.points))
    writer.finish()
    stage = Usd.Stage.Open(str(tmp_path / "o.usda"))
    assert stage.GetPrimAtPath("/hair_physics").GetTypeName() == "Xform" and stage.GetPrimAtPath("/hair_physics_2")
