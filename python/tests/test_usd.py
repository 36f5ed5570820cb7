"""USD, checked with usd-core."""

import numpy as np
import pytest

pytest.importorskip("pxr")
from conftest import shot, tuft
from pxr import Gf, Sdf, Usd, UsdGeom, UsdShade, UsdSkel, UsdValidation, Vt
from stages import define_curves, new_stage

import hairspring as hs
from hairspring import usd


def test_units_axes_and_transforms_of_the_stage_are_converted(tmp_path):
    points, offsets = tuft(up=2)
    stage = new_stage(tmp_path / "a.usda", "Z", 0.01)
    UsdGeom.Xform.Define(stage, "/head").AddTranslateOp().Set(Gf.Vec3d(0, 0, 100))
    define_curves(stage, "/head/hair", points * 100, offsets, widths=[0.007], interpolation="constant")
    stage.Save()
    groom = hs.Groom.read(tmp_path / "a.usda")
    expected = points[:, [0, 2, 1]] * [1, 1, -1] + [0, 1, 0]
    np.testing.assert_allclose(groom.points, expected, atol=1e-5)
    np.testing.assert_allclose(groom.radii, 35e-6, rtol=1e-4)
    assert groom.group_names == ["/head/hair"]


@pytest.mark.parametrize("interpolation, count", [("constant", 1), ("uniform", 12), ("vertex", 120), ("varying", 120)])
def test_widths_are_read_in_every_interpolation(tmp_path, interpolation, count):
    points, offsets = tuft()
    stage = new_stage(tmp_path / "a.usda")
    widths = 2 * np.linspace(30e-6, 40e-6, count)
    define_curves(stage, "/hair", points, offsets, widths=widths, interpolation=interpolation)
    stage.Save()
    radii = hs.Groom.read(tmp_path / "a.usda").radii
    expected = {1: np.full(120, 30e-6), 12: np.repeat(widths / 2, 10), 120: widths / 2}[count]
    np.testing.assert_allclose(radii, expected, rtol=1e-5)


def test_factors_of_the_material_are_read(tmp_path):
    points, offsets = tuft()
    stage = new_stage(tmp_path / "a.usda")
    curves = define_curves(stage, "/hair", points, offsets)
    api = UsdGeom.PrimvarsAPI(curves.GetPrim())
    stiff = np.linspace(0.5, 2, 12).astype(np.float32)
    api.CreatePrimvar("stiffness", Sdf.ValueTypeNames.FloatArray, "uniform").Set(Vt.FloatArray.FromNumpy(stiff))
    api.CreatePrimvar("drag", Sdf.ValueTypeNames.Float, "constant").Set(3.0)
    api.CreatePrimvar("flatness", Sdf.ValueTypeNames.Float, "constant").Set(0.6)
    api.CreatePrimvar("tether", Sdf.ValueTypeNames.Float, "constant").Set(1.2)
    stage.Save()
    factors = hs.Groom.read(tmp_path / "a.usda").factors
    np.testing.assert_allclose(factors["stiffness"], stiff, rtol=1e-6)
    np.testing.assert_allclose(factors["drag"], 3.0)
    np.testing.assert_allclose(factors["damping"], 1.0)
    np.testing.assert_allclose([factors["flatness"], factors["tether"]], [[0.6] * 12, [1.2] * 12], rtol=1e-6)


def test_a_density_mask_thins_the_strands(tmp_path):
    points, offsets = tuft(strands=400)
    stage = new_stage(tmp_path / "a.usda")
    curves = define_curves(stage, "/hair", points, offsets)
    density = np.repeat([0.0, 0.25, 1.0, 1.0], 100).astype(np.float32)
    UsdGeom.PrimvarsAPI(curves.GetPrim()).CreatePrimvar("density", Sdf.ValueTypeNames.FloatArray, "uniform").Set(
        Vt.FloatArray.FromNumpy(density)
    )
    stage.Save()
    groom = hs.Groom.read(tmp_path / "a.usda")
    kept = len(groom.offsets) - 1
    assert 222 <= kept <= 228, kept
    expected = f"the attribute `density` of the curves leaves out {400 - kept} of 400 strands"
    assert any(expected in note for note in groom.notes), groom.notes
    np.testing.assert_allclose(groom.strand(kept - 1)[0], points[offsets[399]], atol=1e-6)


def test_colors_of_a_mesh_are_a_map(tmp_path):
    stage = new_stage(tmp_path / "body.usda")
    mesh = UsdGeom.Mesh.Define(stage, "/skin")
    mesh.CreatePointsAttr([(-1, 0, 1), (1, 0, 1), (1, 0, -1), (-1, 0, -1)])
    mesh.CreateFaceVertexCountsAttr([4])
    mesh.CreateFaceVertexIndicesAttr([0, 1, 2, 3])
    color = UsdGeom.PrimvarsAPI(mesh.GetPrim()).CreatePrimvar("displayColor", Sdf.ValueTypeNames.Color3fArray, "vertex")
    color.Set([(0, 0, 0), (1, 0, 0), (1, 0, 0), (0, 0, 0)])
    stage.Save()
    scene = tmp_path / "a.toml"
    scene.write_text(
        '[body]\nfile = "body.usda"\n[[groom]]\ngrow = { strands = 300 }\nguides = 10\n'
        '[groom.maps]\ndensity = { vertex_colors = true, channel = "red" }\n'
    )
    groom = hs.Scene.read(scene).grooms[0]
    roots = groom.points[groom.offsets[:-1]]
    assert 130 < len(roots) < 170 and (roots[:, 0] > 0).sum() > 2 * (roots[:, 0] < 0).sum()


def test_the_physics_material_is_written_and_read(tmp_path, program):
    scene = tmp_path / "a.toml"
    scene.write_text(
        '[builtin]\nstrands = 60\nguides = 20\nmaterial = "m"\n'
        "[material.m]\nbend = 2.5\nradius = 4e-5\ndensity = 1200\nfriction = 0.4\nfriction_kinetic = 0.5\n"
    )
    code, _, error = program("bake", scene, "-o", tmp_path / "hair.usda", "--frames", "1-2")
    assert code == 0, error
    stage = Usd.Stage.Open(str(tmp_path / "hair.usda"))
    prim = next(p for p in stage.Traverse() if p.IsA(UsdGeom.BasisCurves))
    bound, _ = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial("physics")
    material = bound.GetPrim()
    assert "PhysicsCurvesDeformableMaterialAPI" in material.GetMetadata("apiSchemas").GetAppliedItems()
    value = lambda name: material.GetAttribute(f"physics:{name}").Get()
    radius = 0.5 * value("thickness")
    expected = {
        "density": 1200,
        "staticFriction": 0.4,
        "dynamicFriction": 0.2,
        "stretchStiffness": 3.9e9,
        "bendStiffness": 2.5 * 3.9e9,
        "twistStiffness": 2.5 * 0.89e9,
        "curvesStretchStiffness": 3.9e9 * np.pi * radius**2,
        "curvesBendStiffness": 2.5 * 3.9e9 * np.pi / 4 * radius**4,
        "curvesTwistStiffness": 2.5 * 0.89e9 * np.pi / 2 * radius**4,
    }
    for name, number in expected.items():
        np.testing.assert_allclose(value(name), number, rtol=1e-5, err_msg=name)
    # The file's curves have these constants again, and what the file cannot give is said.
    groom = hs.Groom.read(tmp_path / "hair.usda")
    np.testing.assert_allclose(groom.factors["stiffness"][:60], 2.5, rtol=1e-4)
    text = " ".join(groom.notes)
    assert "2.5 times the stiffness of a human hair" in text and "density = 1200, friction = 0.4" in text


def test_every_group_has_its_own_physics_material(tmp_path, program):
    points, offsets = tuft()
    stage = new_stage(tmp_path / "two.usda")
    define_curves(stage, "/soft", points, offsets)
    define_curves(stage, "/stiff", points + [0.1, 0, 0], offsets)
    stage.Save()
    (tmp_path / "a.toml").write_text(
        '[[groom]]\nfile = "two.usda"\nmaterial = ["soft", "stiff"]\nguides = "all"\n'
        "[material.soft]\nbend = 0.5\n[material.stiff]\nbend = 3.0\n"
    )
    stiffness = lambda bound: bound.GetPrim().GetAttribute("physics:bendStiffness").Get() / 3.9e9
    for over in ([], ["--over", tmp_path / "two.usda"]):
        path = tmp_path / f"sim{len(over)}.usda"
        code, _, error = program("bake", tmp_path / "a.toml", "-o", path, "--frames", "1-2", *over)
        assert code == 0, error
        baked = Usd.Stage.Open(str(path))
        if over:
            parts = [baked.GetPrimAtPath(name) for name in ("/soft", "/stiff")]
        else:
            prim = next(p for p in baked.Traverse() if p.IsA(UsdGeom.BasisCurves))
            (subset,) = UsdShade.MaterialBindingAPI(prim).GetMaterialBindSubsets()
            assert subset.GetElementTypeAttr().Get() == "segment"
            pairs = np.array(subset.GetIndicesAttr().Get()).reshape(-1, 2)
            assert [tuple(pair) for pair in pairs] == [(s, k) for s in range(12, 24) for k in range(9)]
            parts = [prim, subset.GetPrim()]
            assert UsdGeom.Subset.ValidateFamily(UsdGeom.Imageable(prim), "segment", "materialBind")[0]
        found = [UsdShade.MaterialBindingAPI(part).ComputeBoundMaterial("physics")[0] for part in parts]
        np.testing.assert_allclose([stiffness(bound) for bound in found], [0.5, 3.0], rtol=1e-5)
        if not over:
            notes = " ".join(hs.Groom.read(path).notes)
            assert "has other physics materials for 1 of its parts (stiff)" in notes, notes


def test_the_physics_material_of_a_stage_in_centimeters(tmp_path):
    points, offsets = tuft()
    stage = new_stage(tmp_path / "a.usda")
    UsdGeom.SetStageMetersPerUnit(stage, 0.01)
    curves = define_curves(stage, "/hair", 100 * points, offsets)
    curves.GetWidthsAttr().Clear()
    material = UsdShade.Material.Define(stage, "/m")
    material.GetPrim().AddAppliedSchema("PhysicsCurvesDeformableMaterialAPI")
    # A diameter of 80 µm and a third of the stiffness of hair, [kg/(cm s²)].
    for name, number in (("thickness", 0.008), ("bendStiffness", 1.3e9 * 0.01)):
        material.GetPrim().CreateAttribute(f"physics:{name}", Sdf.ValueTypeNames.Float).Set(number)
    UsdShade.MaterialBindingAPI.Apply(curves.GetPrim()).Bind(material, materialPurpose="physics")
    stage.Save()
    groom = hs.Groom.read(tmp_path / "a.usda")
    np.testing.assert_allclose(groom.radii, 4e-5, rtol=1e-4)
    np.testing.assert_allclose(groom.factors["stiffness"], 1 / 3, rtol=1e-4)


def line(control):
    """Control points on a line: every curve through them stays on it."""
    return np.stack([np.linspace(0, 0.09, control), np.zeros(control), np.zeros(control)], axis=1)


@pytest.mark.parametrize(
    "basis, wrap, first, last",
    [
        ("catmullRom", "nonperiodic", 0.01, 0.08),
        ("catmullRom", "pinned", 0.0, 0.09),
        ("bspline", "nonperiodic", 0.01, 0.08),
        ("bspline", "pinned", 0.0, 0.09),
        ("bezier", "nonperiodic", 0.0, 0.09),
    ],
)
def test_cubic_curves_begin_and_end_where_usd_says(tmp_path, basis, wrap, first, last):
    stage = new_stage(tmp_path / "a.usda")
    define_curves(stage, "/hair", line(10), [0, 10], "cubic", basis, wrap)
    stage.Save()
    x = hs.Groom.read(tmp_path / "a.usda").points[:, 0]
    assert x[0] == pytest.approx(first, abs=1e-6) and x[-1] == pytest.approx(last, abs=1e-6)
    assert (np.diff(x) > 0).all()


def test_instances_are_read(tmp_path):
    points, offsets = tuft()
    stage = new_stage(tmp_path / "a.usda")
    stage.CreateClassPrim("/_brow")
    define_curves(stage, "/_brow/hair", points, offsets)
    for k in range(2):
        prim = UsdGeom.Xform.Define(stage, f"/brow{k}")
        prim.AddTranslateOp().Set(Gf.Vec3d(0.1 * k, 0, 0))
        prim.GetPrim().GetReferences().AddInternalReference("/_brow")
        prim.GetPrim().SetInstanceable(True)
    stage.Save()
    groom = hs.Groom.read(tmp_path / "a.usda")
    assert len(groom) == 24
    np.testing.assert_allclose(groom.points[120:] - groom.points[:120], np.tile([0.1, 0, 0], (120, 1)), atol=1e-6)


def test_instances_of_an_instancer_are_read(tmp_path):
    points, offsets = tuft()
    stage = new_stage(tmp_path / "a.usda")
    instancer = UsdGeom.PointInstancer.Define(stage, "/scatter")
    instancer.AddTranslateOp().Set(Gf.Vec3d(0, 0, 5))
    stage.CreateClassPrim("/_kinds")
    curves = define_curves(stage, "/_kinds/long/hair", points, offsets, widths=[2e-4], interpolation="constant")
    UsdGeom.Xformable(curves).AddTranslateOp().Set(Gf.Vec3d(0.01, 0, 0))
    define_curves(stage, "/scatter/short", 0.5 * points, offsets)
    instancer.CreatePrototypesRel().SetTargets(["/_kinds/long", "/scatter/short"])
    instancer.CreateProtoIndicesAttr([0, 1, 0, 0])
    instancer.CreatePositionsAttr([(0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0)])
    # The third is turned by 90 degrees about Y, and twice as large.
    instancer.CreateOrientationsAttr([Gf.Quath(1)] * 2 + [Gf.Quath(0.5**0.5, 0, 0.5**0.5, 0)] + [Gf.Quath(1)])
    instancer.CreateScalesAttr([(1, 1, 1)] * 2 + [(2, 2, 2)] + [(1, 1, 1)])
    instancer.CreateIdsAttr([10, 11, 12, 13])
    instancer.InvisId(13, Usd.TimeCode.Default())
    stage.Save()
    groom = hs.Groom.read(tmp_path / "a.usda")
    x, y, z = points.T
    first = np.stack([x + 0.01, y, z + 5], axis=1)
    third = np.stack([2 * z + 2, 2 * y, 5 - 2 * (x + 0.01)], axis=1)
    short = 0.5 * points + [1, 0, 5]
    np.testing.assert_allclose(groom.points, np.concatenate([first, third, short]), atol=2e-3)
    np.testing.assert_allclose(groom.radii[:240], np.repeat([1e-4, 2e-4], 120), rtol=1e-2)


def test_what_is_left_out_is_said(tmp_path):
    points, offsets = tuft()
    stage = new_stage(tmp_path / "a.usda")
    define_curves(stage, "/hair", points, offsets)
    define_curves(stage, "/ring", points, offsets, wrap="periodic")
    stage.Save()
    groom = hs.Groom.read(tmp_path / "a.usda")
    assert len(groom) == 12 and any("/ring has closed curves" in note for note in groom.notes)
    (tmp_path / "broken.usda").write_text("#usda 1.0\n(")
    with pytest.raises(hs.FileError, match="broken.usda"):
        hs.Groom.read(tmp_path / "broken.usda")
    empty = new_stage(tmp_path / "empty.usda")
    empty.Save()
    with pytest.raises(hs.FileError, match="no visible BasisCurves"):
        hs.Groom.read(tmp_path / "empty.usda")


def test_a_bake_has_the_points_of_the_simulation_and_passes_the_checker(tmp_path, program):
    scene = shot(tmp_path)
    code, _, error = program("bake", scene, "-o", tmp_path / "hair.####.hair", "--frames", "1-4")
    assert code == 0, error
    code, _, error = program("bake", scene, "-o", tmp_path / "hair.usdc", "--frames", "1001-1004", "--start", "1001")
    assert code == 0, error
    assert not (tmp_path / "hair.usdc.frames").exists()
    stage = Usd.Stage.Open(str(tmp_path / "hair.usdc"))
    # What the program `usdchecker` runs.
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    assert len(validators) > 10
    found = UsdValidation.ValidationContext(validators).Validate(stage)
    assert [f"{e.GetName()}: {e.GetMessage()}" for e in found] == []
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode(), stage.GetTimeCodesPerSecond()) == (1001, 1004, 30)
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1 and UsdGeom.GetStageUpAxis(stage) == "Y"
    curves = UsdGeom.BasisCurves(stage.GetPrimAtPath("/Hair/Head_hair"))
    assert curves.GetPointsAttr().GetTimeSamples() == [1001, 1002, 1003, 1004]
    points = [np.array(curves.GetPointsAttr().Get(1001 + k)) for k in range(4)]
    for k in range(4):
        np.testing.assert_array_equal(points[k], hs.Groom.read(tmp_path / f"hair.000{k + 1}.hair", up="y").points[: len(points[k])])
    velocity = np.array(curves.GetVelocitiesAttr().Get(1002))
    np.testing.assert_allclose(velocity, (points[2] - points[0]) * 15, atol=1e-5)
    low, high = curves.GetExtentAttr().Get(1003)
    assert (points[2].min(axis=0) >= low).all() and (points[2].max(axis=0) <= high).all()
    widths = np.array(curves.GetWidthsAttr().Get())
    assert curves.GetWidthsInterpolation() == "vertex" and len(widths) == len(points[0])


def test_the_names_of_the_schemas_are_in_the_file(tmp_path, program):
    code, _, error = program("bake", shot(tmp_path), "-o", tmp_path / "hair.usda", "--frames", "1-2")
    assert code == 0, error
    stage = Usd.Stage.Open(str(tmp_path / "hair.usda"))
    prim = stage.GetPrimAtPath("/Hair/Head_hair")
    assert "PhysicsCurvesDeformableSimAPI" in prim.GetMetadata("apiSchemas").GetAddedOrExplicitItems()
    rest = np.array(prim.GetAttribute("physics:restShapePoints").Get())
    assert len(rest) == len(UsdGeom.BasisCurves(prim).GetPointsAttr().Get(1))
    primvars = {p.GetPrimvarName(): p for p in UsdGeom.PrimvarsAPI(prim).GetPrimvars()}
    assert {"groom_id", "groom_guide"} <= set(primvars)
    guides = np.array(primvars["groom_guide"].Get())
    assert guides.sum() == 30 and len(guides) == 200
    assert all(primvars[name].GetInterpolation() == "uniform" for name in ("groom_id", "groom_guide"))


def test_only_guides_and_samples_between_frames(tmp_path, program):
    path = tmp_path / "guides.usdc"
    code, _, error = program("bake", shot(tmp_path), "-o", path, "--frames", "1-3", "--samples", "2", "--only-guides")
    assert code == 0, error
    stage = Usd.Stage.Open(str(path))
    curves = UsdGeom.BasisCurves(stage.GetPrimAtPath("/Hair/Head_hair"))
    assert curves.GetPointsAttr().GetTimeSamples() == [1, 1.5, 2, 2.5, 3]
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (1, 3)
    assert len(curves.GetCurveVertexCountsAttr().Get()) == 30


def skinned_asset(path):
    """A column on two joints of which the upper one turns, with hair on its top, in centimeters, Z up."""
    stage = new_stage(path, "Z", 0.01)
    stage.SetTimeCodesPerSecond(24)
    root = UsdSkel.Root.Define(stage, "/char")
    skeleton = UsdSkel.Skeleton.Define(stage, "/char/skel")
    joints = ["hip", "hip/head"]
    bind = [Gf.Matrix4d(1), Gf.Matrix4d(1).SetTranslate(Gf.Vec3d(0, 0, 20))]
    rest = [Gf.Matrix4d(1), Gf.Matrix4d(1).SetTranslate(Gf.Vec3d(0, 0, 20))]
    skeleton.CreateJointsAttr(joints)
    skeleton.CreateBindTransformsAttr(bind)
    skeleton.CreateRestTransformsAttr(rest)
    animation = UsdSkel.Animation.Define(stage, "/char/skel/anim")
    animation.CreateJointsAttr(joints)
    animation.CreateScalesAttr([Gf.Vec3h(1)] * 2)
    for frame in range(1, 25):
        turn = Gf.Rotation(Gf.Vec3d(1, 0, 0), 2.0 * (frame - 1)).GetQuat()
        animation.CreateRotationsAttr().Set([Gf.Quatf(1), Gf.Quatf(turn)], frame)
        animation.CreateTranslationsAttr().Set([Gf.Vec3f(0), Gf.Vec3f(0, 0, 20)], frame)
    UsdSkel.BindingAPI.Apply(skeleton.GetPrim()).CreateAnimationSourceRel().SetTargets(["/char/skel/anim"])
    mesh = UsdGeom.Mesh.Define(stage, "/char/body")
    corners = [(x, y, z) for z in (0, 20, 40) for x, y in ((-5, -5), (5, -5), (5, 5), (-5, 5))]
    faces = [[0, 3, 2, 1], [8, 9, 10, 11]]
    faces += [[4 * l + a, 4 * l + (a + 1) % 4, 4 * l + 4 + (a + 1) % 4, 4 * l + 4 + a] for l in range(2) for a in range(4)]
    mesh.CreatePointsAttr([Gf.Vec3f(*c) for c in corners])
    mesh.CreateFaceVertexCountsAttr([4] * len(faces))
    mesh.CreateFaceVertexIndicesAttr([i for face in faces for i in face])
    binding = UsdSkel.BindingAPI.Apply(mesh.GetPrim())
    binding.CreateSkeletonRel().SetTargets(["/char/skel"])
    binding.CreateJointIndicesPrimvar(False, 1).Set([0] * 4 + [1] * 8)
    binding.CreateJointWeightsPrimvar(False, 1).Set([1.0] * 12)
    points, offsets = tuft(up=2)
    define_curves(stage, "/char/hair", points * 100 + [0, 0, 40], offsets, widths=[0.007], interpolation="constant")
    stage.SetDefaultPrim(root.GetPrim())
    stage.Save()


def test_hair_follows_a_body_that_a_skeleton_deforms(tmp_path, program):
    skinned_asset(tmp_path / "char.usda")
    mesh = usd.read_mesh(tmp_path / "char.usda")
    assert mesh.frames.shape == (24, 12, 3) and mesh.rate == 24
    assert len(mesh.triangles) == 20
    # The top turns by 46° about the stage's X axis at a height of 20 cm.
    angle = np.radians(46)
    top = mesh.frames[-1, 8:].mean(axis=0)
    np.testing.assert_allclose(top, [0, 0.2 + 0.2 * np.cos(angle), 0.2 * np.sin(angle)], atol=1e-5)
    path = tmp_path / "hair.usdc"
    code, _, error = program("bake", tmp_path / "char.usda", "-o", path, "--fps", "24", "--guides", "all")
    assert code == 0, error
    assert "24 frames at 24 Hz move the body's vertices" in error
    stage = Usd.Stage.Open(str(path))
    curves = UsdGeom.BasisCurves(stage.GetPrimAtPath("/Hair/groom"))
    assert len(curves.GetPointsAttr().GetTimeSamples()) == 24
    roots = np.array(curves.GetPointsAttr().Get(24))[::10]
    np.testing.assert_allclose(roots.mean(axis=0), top, atol=1e-4)


def test_a_skeleton_in_instances_deforms_the_body_too(tmp_path):
    skinned_asset(tmp_path / "char.usda")
    for name, file in (("inner", "char.usda"), ("outer", "inner.usda")):
        inner = Usd.Stage.CreateNew(str(tmp_path / f"{name}.usda"))
        UsdGeom.SetStageUpAxis(inner, "Z")
        UsdGeom.SetStageMetersPerUnit(inner, 0.01)
        top = UsdGeom.Xform.Define(inner, f"/{name}")
        inner.SetDefaultPrim(top.GetPrim())
        below = inner.DefinePrim(f"/{name}/one")
        below.GetReferences().AddReference(file)
        below.SetInstanceable(True)
        inner.Save()
    direct, nested = usd.read_mesh(tmp_path / "char.usda"), usd.read_mesh(tmp_path / "outer.usda")
    assert nested.frames is not None, nested.notes
    np.testing.assert_allclose(nested.frames, direct.frames, atol=1e-6)


def test_weights_that_do_not_fit_are_noted(tmp_path):
    skinned_asset(tmp_path / "char.usda")
    stage = Usd.Stage.Open(str(tmp_path / "char.usda"))
    UsdSkel.BindingAPI(stage.GetPrimAtPath("/char/body")).GetJointIndicesPrimvar().Set([0] * 4 + [99] * 8)
    stage.Save()
    notes = usd.read_mesh(tmp_path / "char.usda").notes
    assert any("the joint indices or weights of /char/body do not fit" in note for note in notes), notes


def test_a_layer_over_the_asset_moves_its_own_curves(tmp_path, program):
    skinned_asset(tmp_path / "char.usda")
    path = tmp_path / "sim.usda"
    code, _, error = program(
        "bake", tmp_path / "char.usda", "-o", path, "--fps", "24", "--guides", "all", "--over", tmp_path / "char.usda"
    )
    assert code == 0, error
    stage = Usd.Stage.Open(str(path))
    assert stage.GetRootLayer().subLayerPaths[0] == "char.usda"
    assert UsdGeom.GetStageMetersPerUnit(stage) == 0.01 and UsdGeom.GetStageUpAxis(stage) == "Z"
    curves = UsdGeom.BasisCurves(stage.GetPrimAtPath("/char/hair"))
    points, offsets = tuft(up=2)
    np.testing.assert_allclose(np.array(curves.GetPointsAttr().Get(1)), points * 100 + [0, 0, 40], atol=1e-3)
    roots = np.array(curves.GetPointsAttr().Get(24))[::10].mean(axis=0)
    angle = np.radians(46)
    np.testing.assert_allclose(roots, [0, -20 * np.sin(angle), 20 + 20 * np.cos(angle)], atol=0.02)
    assert stage.GetPrimAtPath("/char/body").IsA(UsdGeom.Mesh)


def test_an_interrupted_or_failed_write_leaves_no_file(tmp_path):
    from hairspring.description import Description, MovingGroom

    points, offsets = tuft()
    groom = MovingGroom("g", points, offsets, np.full(120, 4e-5, np.float32), np.ones(12, bool))
    writer = usd.CurvesWriter(tmp_path / "a.usdc", Description(24, 1, 2, [groom]))
    writer.frame(1, points, np.zeros_like(points))
    writer.discard()
    assert list(tmp_path.iterdir()) == []
