"""USD files with faults, and what is not read: errors and notes."""

import os

import numpy as np
import pytest

pytest.importorskip("pxr")
from conftest import tuft
from pxr import Gf, Sdf, Tf, Usd, UsdGeom, UsdSkel, Vt
from stages import CORNERS, FACES, a_mesh, define_curves, new_stage, volume

import hairspring as hs
from hairspring import usd
from hairspring.description import Description, MovingGroom
from hairspring.formats import FormatError


def a_groom_stage(path, up="Y", meters=1.0, **options):
    stage = new_stage(path, up, meters)
    points, offsets = tuft()
    return stage, define_curves(stage, "/hair", points, offsets, **options)


def read(stage):
    stage.Save()
    return usd.read_curves(stage.GetRootLayer().realPath)


def positions(points):
    return Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(points, np.float32))


def test_values_of_another_number_are_left_out_with_a_note(tmp_path):
    stage, curves = a_groom_stage(tmp_path / "a.usda", widths=[1e-4] * 7, interpolation="vertex")
    api, types = UsdGeom.PrimvarsAPI(curves.GetPrim()), Sdf.ValueTypeNames
    api.CreatePrimvar("stiffness", types.FloatArray, "uniform").Set([2.0] * 5)
    api.CreatePrimvar("groom_group_id", types.IntArray, "uniform").Set([0, 1])
    api.CreatePrimvar("groom_root_uv", types.FloatArray, "uniform").Set([0.5] * 12)
    api.CreatePrimvar("clumping", types.FloatArray, "uniform").Set([0.5] * 12)
    got = read(stage)
    assert got.radii is None and "stiffness" not in got.factors and got.root_uvs is None
    assert sorted(got.notes) == [
        "`groom_group_id` of /hair has 2 values for 12 strands; left out",
        "`groom_root_uv` of /hair does not have 2 numbers for each value; left out",
        "`stiffness` of /hair has 5 values, and uniform interpolation needs 12; left out",
        "`widths` of /hair has 7 values, and vertex interpolation needs 120; left out, so that its strands have the radius of the"
        " others, or the default",
        "primvars of curves that are not used: clumping",
    ]


def test_guides_that_do_not_exist_are_left_out_with_a_note(tmp_path):
    stage, curves = a_groom_stage(tmp_path / "a.usda")
    api = UsdGeom.PrimvarsAPI(curves.GetPrim())
    api.CreatePrimvar("groom_closest_guides", Sdf.ValueTypeNames.IntArray, "uniform").Set([99] * 12)
    api.CreatePrimvar("groom_guide_weights", Sdf.ValueTypeNames.FloatArray, "uniform").Set([1.0] * 12)
    got = read(stage)
    assert got.guides is None and any("strands that do not exist" in note for note in got.notes)


def test_guides_of_three_numbers_in_a_flat_primvar_are_read(tmp_path):
    stage, curves = a_groom_stage(tmp_path / "a.usda")
    api = UsdGeom.PrimvarsAPI(curves.GetPrim())
    api.CreatePrimvar("groom_closest_guides", Sdf.ValueTypeNames.IntArray, "uniform", 3).Set([1, 2, 3] * 12)
    api.CreatePrimvar("groom_guide_weights", Sdf.ValueTypeNames.FloatArray, "uniform", 3).Set([0.5, 0.25, 0.25] * 12)
    got = read(stage)
    assert (got.guides == [1, 2, 3]).all() and np.allclose(got.guide_weights, [0.5, 0.25, 0.25])


def test_hidden_prims_guides_and_proxies_are_named(tmp_path):
    stage, curves = a_groom_stage(tmp_path / "a.usda")
    points, offsets = tuft()
    for name in ("hidden", "guides"):
        define_curves(stage, f"/{name}", points, offsets)
    UsdGeom.Imageable.Get(stage, "/hidden").MakeInvisible()
    UsdGeom.Imageable.Get(stage, "/guides").CreatePurposeAttr("guide")
    got = read(stage)
    assert len(got.offsets) == len(offsets)
    assert got.notes == ["BasisCurves prims that are hidden, guides or proxies are left out (/hidden, /guides)"]
    UsdGeom.Imageable.Get(stage, "/hair").MakeInvisible()
    with pytest.raises(FormatError, match="no visible BasisCurves .*(/hair, /hidden, /guides)"):
        read(stage)


def an_instancer(stage, path, prototypes, positions, indices):
    instancer = UsdGeom.PointInstancer.Define(stage, path)
    instancer.CreatePrototypesRel().SetTargets(prototypes)
    instancer.CreateProtoIndicesAttr(indices)
    instancer.CreatePositionsAttr(positions)
    return instancer


def test_other_curves_are_named(tmp_path):
    stage, _ = a_groom_stage(tmp_path / "a.usda")
    UsdGeom.NurbsCurves.Define(stage, "/nurbs")
    UsdGeom.HermiteCurves.Define(stage, "/hermite")
    notes = " ".join(read(stage).notes)
    for part in ("NurbsCurves prims are left out (/nurbs)", "HermiteCurves prims are left out (/hermite)"):
        assert part in notes
    with pytest.raises(FormatError, match="no visible meshes$"):
        usd.read_mesh(tmp_path / "a.usda")


def test_instancers_that_cannot_be_read_are_named(tmp_path):
    points, offsets = tuft()
    stage, _ = a_groom_stage(tmp_path / "a.usda")
    for name in ("short", "wrong", "outer"):
        define_curves(stage, f"/{name}/tuft", points, offsets)
    an_instancer(stage, "/short", ["/short/tuft"], [(0, 0, 0)], [0, 0])
    an_instancer(stage, "/wrong", ["/wrong/tuft"], [(0, 0, 0)], [7])
    an_instancer(stage, "/gone", ["/nowhere"], [(0, 0, 0)], [0])
    define_curves(stage, "/outer/inner/tuft", points, offsets)
    an_instancer(stage, "/outer/inner", ["/outer/inner/tuft"], [(0, 0, 0)], [0])
    an_instancer(stage, "/outer", ["/outer/tuft"], [(0, 0, 0), (1, 0, 0)], [0, 0])
    got = read(stage)
    # The plain curves, and the two instances of /outer/tuft.
    assert len(got.offsets) - 1 == 3 * 12
    assert sorted(got.notes) == [
        "/outer/inner is a PointInstancer in a prototype of another; left out, so place its instances directly",
        "the arrays of /short do not have one valid value for each instance; left out",
        "the arrays of /wrong do not have one valid value for each instance; left out",
    ]


def test_instanced_meshes_are_named(tmp_path):
    stage = new_stage(tmp_path / "a.usda")
    a_mesh(stage, CORNERS, *FACES)
    [mesh] = [prim for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh)]
    an_instancer(stage, "/many", [mesh.GetPath()], [(0, 0, 0), (1, 0, 0)], [0, 0])
    stage.Save()
    [note] = usd.read_mesh(tmp_path / "a.usda").notes
    assert "/many is a PointInstancer: its 2 instances are left out" in note


def test_surfaces_that_are_not_meshes_are_named(tmp_path):
    stage = new_stage(tmp_path / "a.usda")
    a_mesh(stage, CORNERS, *FACES)
    UsdGeom.Sphere.Define(stage, "/ball")
    stage.Save()
    assert usd.read_mesh(tmp_path / "a.usda").notes == ["Sphere prims are left out (/ball); convert them to meshes"]


def test_a_bezier_curve_of_another_number_of_points_is_refused(tmp_path):
    stage, _ = a_groom_stage(tmp_path / "a.usda", kind="cubic", basis="bezier")
    assert len(read(stage).offsets) == 13
    stage = new_stage(tmp_path / "b.usda")
    define_curves(stage, "/hair", np.zeros((10, 3)), [0, 5, 10], "cubic", "bezier")
    with pytest.raises(FormatError, match="/hair has a Bézier curve of 5 points"):
        read(stage)


@pytest.mark.parametrize("key, value, sentence", [("metersPerUnit", 0.0, "metersPerUnit = 0"), ("upAxis", "X", "upAxis = X")])
def test_a_stage_without_a_unit_or_axis_is_refused(tmp_path, key, value, sentence):
    stage, _ = a_groom_stage(tmp_path / "a.usda")
    stage.GetRootLayer().pseudoRoot.SetInfo(key, value)
    with pytest.raises(FormatError, match=sentence):
        read(stage)
    assert len(usd.read_curves(tmp_path / "a.usda", 1.0, "y").offsets) == 13


def test_errors_have_no_text_of_the_library(tmp_path, capfd):
    for name in ("a.usda", "a.usdc"):
        (tmp_path / name).write_bytes(b"PXR-USDC" + bytes(100))
        with pytest.raises(hs.FileError) as caught:
            hs.Groom.read(tmp_path / name)
        assert "the stage cannot be opened: the file is damaged or is not USD" in str(caught.value)
        assert "pxrInternal" not in str(caught.value) and "line" not in str(caught.value)
    assert capfd.readouterr().err == ""


def test_a_missing_file_is_named_once(tmp_path, capfd):
    stage, _ = a_groom_stage(tmp_path / "a.usda")
    stage.GetRootLayer().subLayerPaths.append("./none.usda")
    for name in ("/one", "/two"):
        stage.DefinePrim(name).GetReferences().AddReference("./gone.usda")
    stage.Save()
    capfd.readouterr()
    notes = usd.read_curves(tmp_path / "a.usda").notes
    assert usd.used_files(tmp_path / "a.usda") == [str(tmp_path / "a.usda")]
    assert capfd.readouterr().err == ""
    assert len(notes) == 2 and sum("gone.usda, which a.usda uses, is missing" in note for note in notes) == 1
    assert sum("none.usda, which a.usda uses, is missing" in note for note in notes) == 1


def test_the_files_of_a_stage_are_all_named(tmp_path):
    under, _ = a_groom_stage(tmp_path / "under.usda")
    under.Save()
    other, _ = a_groom_stage(tmp_path / "other.usda")
    other.Save()
    stage = new_stage(tmp_path / "a.usda")
    stage.GetRootLayer().subLayerPaths.append("under.usda")
    stage.DefinePrim("/other").GetReferences().AddReference("other.usda", "/hair")
    stage.Save()
    assert [os.path.basename(file) for file in usd.used_files(tmp_path / "a.usda")] == ["a.usda", "other.usda", "under.usda"]


def test_a_motion_without_speed_or_with_close_samples(tmp_path):
    for codes, name in ((0.0, "still"), (24.0, "close")):
        stage = new_stage(tmp_path / f"{name}.usda")
        stage.SetTimeCodesPerSecond(codes)
        mesh = a_mesh(stage, CORNERS, *FACES)
        for k in range(51):
            mesh.GetPointsAttr().Set(positions(CORNERS + [0.01 * k, 0, 0]), 0.02 * k)
        stage.Save()
    with pytest.raises(FormatError, match="timeCodesPerSecond = 0"):
        usd.read_mesh(tmp_path / "still.usda")
    got = usd.read_mesh(tmp_path / "close.usda")
    assert got.rate == pytest.approx(240) and got.frames.shape == (11, 4, 3)
    assert got.notes[0] == "samples of the meshes are closer than 1/240 s; their motion is sampled at 240 Hz"
    np.testing.assert_allclose(got.frames[:, 0, 0], np.linspace(0, 0.5, 11), atol=1e-6)


def test_the_rate_of_many_rounded_samples_is_exact(tmp_path):
    stage = new_stage(tmp_path / "a.usda")
    stage.SetTimeCodesPerSecond(1)
    mesh = a_mesh(stage, CORNERS, *FACES)
    for k in range(2001):
        mesh.GetPointsAttr().Set(positions(CORNERS + [0.01 * k, 0, 0]), round(k / 24, 6))
    stage.Save()
    got = usd.read_mesh(tmp_path / "a.usda")
    assert got.rate == pytest.approx(24, rel=1e-6) and len(got.frames) == 2001


@pytest.mark.parametrize("fault", ["negative", "empty"])
def test_a_faulty_mesh_is_refused(tmp_path, fault):
    stage = new_stage(tmp_path / "a.usda")
    counts, indices = FACES
    mesh = a_mesh(stage, CORNERS, counts, [-1, *indices[1:]] if fault == "negative" else indices)
    if fault == "empty":
        mesh.GetPointsAttr().Set(positions(CORNERS), 1)
        mesh.GetPointsAttr().Set(Vt.Vec3fArray(), 2)
    stage.Save()
    with pytest.raises(FormatError, match="name vertices that do not exist" if fault == "negative" else "has 0 points at time 2"):
        usd.read_mesh(tmp_path / "a.usda")


@pytest.mark.parametrize("mirrored", [False, True])
def test_a_left_handed_mesh_is_not_inside_out(tmp_path, mirrored):
    stage = new_stage(tmp_path / "m.usda")
    mesh = a_mesh(stage, CORNERS, FACES[0], FACES[1][::-1])
    mesh.CreateOrientationAttr("leftHanded")
    if mirrored:
        mesh.AddScaleOp().Set(Gf.Vec3f(1, -1, 1))
    stage.Save()
    assert volume(usd.read_mesh(tmp_path / "m.usda")) == pytest.approx(0.2**3 / 6, rel=1e-4)


class FullLayer:
    """A layer that the disk has no room for."""

    def Save(self):
        raise Tf.ErrorException()


@pytest.mark.parametrize("suffix", ["usda", "usdc"])
def test_a_full_disk_is_an_error_with_a_sentence(tmp_path, suffix):
    points, offsets = tuft()
    groom = MovingGroom("g", points, offsets, np.full(120, 4e-5, np.float32), np.ones(12, bool))
    writer = usd.CurvesWriter(tmp_path / f"a.{suffix}", Description(24, 1, 1, [groom]))
    writer.frame(1, points, np.zeros_like(points))
    writer.layer = FullLayer()
    with pytest.raises(OSError, match="the disk may be full"):
        writer.finish()
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(OSError, match="cannot be created"):
        usd.CurvesWriter("/proc/none/a.usdc", Description(24, 1, 1, [groom]))


def test_the_first_sample_of_the_visibility_counts(tmp_path):
    stage, curves = a_groom_stage(tmp_path / "a.usda")
    curves.CreateVisibilityAttr().Set("invisible", 1)
    with pytest.raises(FormatError, match="hidden, guides or proxies are left out"):
        read(stage)


def test_two_guides_for_each_strand_keep_their_weights(tmp_path):
    stage, curves = a_groom_stage(tmp_path / "a.usda")
    api, types = UsdGeom.PrimvarsAPI(curves.GetPrim()), Sdf.ValueTypeNames
    api.CreatePrimvar("groom_closest_guides", types.Int2Array, "uniform").Set([(0, 5)] * 12)
    api.CreatePrimvar("groom_guide_weights", types.Float2Array, "uniform").Set([(0.7, 0.3)] * 12)
    got = read(stage)
    assert (got.guides[:, :2] == [0, 5]).all()
    np.testing.assert_allclose(got.guide_weights, [[0.7, 0.3, 0]] * 12, rtol=1e-6)


@pytest.mark.parametrize("weight", [np.nan, -1.0, 0.0])
def test_guide_weights_that_cannot_be_used_are_left_out_with_a_note(tmp_path, weight):
    stage, curves = a_groom_stage(tmp_path / "a.usda")
    api, types = UsdGeom.PrimvarsAPI(curves.GetPrim()), Sdf.ValueTypeNames
    api.CreatePrimvar("groom_closest_guides", types.IntArray, "uniform").Set([0] * 12)
    api.CreatePrimvar("groom_guide_weights", types.FloatArray, "uniform").Set([weight] * 12)
    got = read(stage)
    assert got.guides is None and any("groom_guide_weights" in note for note in got.notes)


def test_text_in_place_of_numbers_is_one_sentence(tmp_path):
    stage, curves = a_groom_stage(tmp_path / "a.usda")
    api, types = UsdGeom.PrimvarsAPI(curves.GetPrim()), Sdf.ValueTypeNames
    api.CreatePrimvar("stiffness", types.StringArray, "uniform").Set(["a"] * 12)
    with pytest.raises(FormatError, match="the primvar `stiffness` of /hair holds string"):
        read(stage)


def test_hair_on_a_skeleton_is_noted(tmp_path):
    stage, curves = a_groom_stage(tmp_path / "a.usda")
    UsdSkel.BindingAPI.Apply(curves.GetPrim())
    assert any("bound to a skeleton" in note for note in read(stage).notes)


def test_values_of_a_mesh_of_another_number_are_noted(tmp_path):
    stage = new_stage(tmp_path / "a.usda")
    mesh = a_mesh(stage, CORNERS, *FACES)
    api, types = UsdGeom.PrimvarsAPI(mesh), Sdf.ValueTypeNames
    api.CreatePrimvar("st", types.TexCoord2fArray, "vertex").Set([(0, 0)] * 3)
    api.CreatePrimvar("displayColor", types.Color3fArray, "constant").Set([(1, 0, 0)])
    stage.Save()
    got = usd.read_mesh(tmp_path / "a.usda")
    assert got.uvs is None and got.notes == ["`st` of /m does not have 2 numbers for each vertex; left out"]


def test_constant_primvars_of_parents_count(tmp_path):
    stage = new_stage(tmp_path / "a.usda")
    parent = UsdGeom.Xform.Define(stage, "/rig")
    UsdGeom.PrimvarsAPI(parent).CreatePrimvar("stiffness", Sdf.ValueTypeNames.FloatArray, "constant").Set([3.0])
    define_curves(stage, "/rig/hair", *tuft())
    assert (read(stage).factors["stiffness"] == 3).all()
