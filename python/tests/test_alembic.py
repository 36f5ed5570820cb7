"""Alembic, checked with alembic3d itself."""

import numpy as np
import pytest

pytest.importorskip("alembic3d")
from alembic3d import Abc, AbcGeom
from conftest import shot

import hairspring as hs
from hairspring import alembic
from hairspring.description import Description, MovingGroom


def test_a_bake_is_a_groom_cache_with_unreals_names(tmp_path, program):
    scene, path = shot(tmp_path), tmp_path / "hair.abc"
    code, _, error = program("bake", scene, "-o", tmp_path / "hair.####.hair", "--frames", "1-3", "--fps", "24")
    assert code == 0, error
    code, _, error = program("bake", scene, "-o", path, "--frames", "1-3", "--fps", "24")
    assert code == 0, error
    top = Abc.IArchive(str(path)).getTop()
    names = [child.getName() for child in top.children]
    assert names[:2] == ["Head_hair", "Head_hair_guides"]
    schema = AbcGeom.ICurves(top, "Head_hair").getSchema()
    assert schema.getNumSamples() == 3
    sampling = schema.getTimeSampling()
    np.testing.assert_allclose([sampling.getSampleTime(k) for k in range(3)], [1 / 24, 2 / 24, 3 / 24])
    for k in range(3):
        # A selector of a float selects by time.
        sample = schema.getValue(Abc.ISampleSelector(sampling.getSampleTime(k)))
        points = np.array(sample.getPositions())
        np.testing.assert_array_equal(points, hs.Groom.read(tmp_path / f"hair.000{k + 1}.hair", up="y").points[: len(points)])
    assert len(np.array(sample.getVelocities())) == len(points)
    found = {h.getName(): h.getMetaData().serialize() for h in schema.getArbGeomParams().propertyheaders}
    assert {"groom_version_major", "groom_version_minor", "groom_id", "groom_width"} <= set(found)
    assert "geoScope=con" in found["groom_version_major"] and "geoScope=uni" in found["groom_id"]
    guides = AbcGeom.ICurves(top, "Head_hair_guides").getSchema()
    assert "groom_guide" in {h.getName() for h in guides.getArbGeomParams().propertyheaders}
    assert len(np.asarray(guides.getValue(Abc.ISampleSelector()).getCurvesNumVertices())) == 30


def random_groom(seed=1):
    rng = np.random.default_rng(seed)
    counts = rng.integers(4, 9, 50)
    offsets = np.concatenate([[0], np.cumsum(counts)]).astype(np.uint32)
    points = (0.1 * rng.random((offsets[-1], 3))).astype(np.float32)
    guide = np.arange(50) % 5 == 0
    return MovingGroom(
        "my hair",
        points,
        offsets,
        np.linspace(30e-6, 40e-6, len(points)).astype(np.float32),
        guide,
        groups=np.arange(50) // 25,
        root_uvs=rng.random((50, 2)).astype(np.float32),
        colors=rng.random((len(points), 3)).astype(np.float32),
        guides=np.tile(np.arange(50)[:, None] // 5 * 5, (1, 3)),
        guide_weights=np.tile(np.float32([1, 0, 0]), (50, 1)),
    )


@pytest.mark.parametrize("suffix", ["abc", "usdc", "usda"])
def test_every_attribute_survives_a_round_trip(tmp_path, suffix):
    if suffix != "abc":
        pytest.importorskip("pxr")
        from hairspring import usd as module
    else:
        module = alembic
    groom = random_groom()
    path = tmp_path / f"a.{suffix}"
    writer = module.CurvesWriter(path, Description(24, 1, 1, [groom], "test"))
    writer.frame(1, groom.points, np.zeros_like(groom.points))
    writer.finish()
    read = hs.Groom.read(path, scale=1.0)
    np.testing.assert_allclose(read.points, groom.points, atol=1e-7)
    assert (read.offsets == groom.offsets).all() and (read.groups == groom.groups).all()
    np.testing.assert_allclose(read.radii, groom.radii, rtol=1e-5)
    np.testing.assert_allclose(read.root_uvs, groom.root_uvs, atol=1e-6)
    np.testing.assert_allclose(read.colors, groom.colors, atol=1e-6)
    guides, weights = read.guides
    assert (guides == groom.guides).all() and (weights == groom.guide_weights).all()


@pytest.mark.parametrize("suffix", ["abc", "usdc"])
def test_each_groom_keeps_its_own_guides(tmp_path, suffix):
    if suffix != "abc":
        pytest.importorskip("pxr")
        from hairspring import usd as module
    else:
        module = alembic
    # In the same place, so that the nearest guide may be that of another groom. The last is simulated entirely.
    grooms = [random_groom(seed) for seed in (1, 2, 3)]
    for k, groom in enumerate(grooms):
        groom.name, groom.groups, groom.guides, groom.guide_weights = f"groom {k}", None, None, None
        groom.guide = np.arange(50) % (k + 4) == 0 if k < 2 else np.ones(50, bool)
    path = tmp_path / f"a.{suffix}"
    writer = module.CurvesWriter(path, Description(24, 1, 1, grooms, "test"))
    points = np.concatenate([groom.points for groom in grooms])
    writer.frame(1, points, np.zeros_like(points))
    writer.finish()
    read = hs.Groom.read(path, scale=1.0)
    assert len(read.offsets) == 151
    guides, weights = read.guides
    followed = guides[:, 0]
    assert (weights[:, 0] == 1).all() and (np.arange(150) // 50 == followed // 50).all()
    simulated = np.concatenate([groom.guide for groom in grooms])
    np.testing.assert_array_equal(np.unique(followed), np.flatnonzero(simulated))
    assert (followed[simulated] == np.flatnonzero(simulated)).all()


def test_ids_are_unique_in_the_file_and_closest_guides_name_them(tmp_path):
    grooms, path = [random_groom(1), random_groom(2)], tmp_path / "a.abc"
    writer = alembic.CurvesWriter(path, Description(24, 1, 1, grooms, "test"))
    points = np.concatenate([groom.points for groom in grooms])
    writer.frame(1, points, np.zeros_like(points))
    writer.finish()
    top = Abc.IArchive(str(path)).getTop()

    def values(name, kind, attribute):
        parameters = AbcGeom.ICurves(top, name).getSchema().getArbGeomParams()
        return np.asarray(kind(parameters, attribute).getExpandedValue().getVals())

    for name, first in (("my_hair", 0), ("my_hair_2", 50)):
        ids = values(name, AbcGeom.IInt32GeomParam, "groom_id")
        np.testing.assert_array_equal(ids, first + np.arange(50))
        guides = values(f"{name}_guides", AbcGeom.IInt32GeomParam, "groom_id")
        np.testing.assert_array_equal(guides, first + np.arange(0, 50, 5))
        assert set(values(name, AbcGeom.IV3iGeomParam, "groom_closest_guides").ravel()) == set(guides)
    guides, _ = hs.Groom.read(path, scale=1.0).guides
    np.testing.assert_array_equal(guides, np.concatenate([grooms[0].guides, 50 + grooms[1].guides]))


def test_samples_between_frames_have_their_times(tmp_path, program):
    path = tmp_path / "hair.abc"
    options = ["--frames", "10-12", "--start", "10", "--samples", "2", "--fps", "24"]
    code, _, error = program("bake", shot(tmp_path), "-o", path, *options)
    assert code == 0, error
    schema = AbcGeom.ICurves(Abc.IArchive(str(path)).getTop(), "Head_hair").getSchema()
    sampling = schema.getTimeSampling()
    times = [sampling.getSampleTime(k) for k in range(schema.getNumSamples())]
    np.testing.assert_allclose(np.array(times) * 24, [10, 10.5, 11, 11.5, 12])


@pytest.mark.parametrize("suffix", ["abc", "usda"])
def test_curves_that_move_are_read_at_their_first_sample_with_a_note(tmp_path, program, suffix):
    if suffix == "usda":
        pytest.importorskip("pxr")
    for frames, said in [("1-3", 1), ("1", 0)]:
        path = tmp_path / f"frames-{frames}.{suffix}"
        code, _, error = program("bake", shot(tmp_path), "-o", path, "--frames", frames, "--fps", "24")
        assert code == 0, error
        notes = [note for note in hs.Groom.read(path).notes if "time samples, which are not played" in note]
        assert len(notes) == said, notes


# The attributes of Unreal's groom schema 1.5, with their scope in Alembic and their interpolation in USD.
UNREAL = {
    "groom_group_id": "uni",
    "groom_root_uv": "uni",
    "groom_color": "vtx",
    "groom_closest_guides": "uni",
    "groom_guide_weights": "uni",
    "groom_id": "uni",
    "groom_width": "vtx",
}


def test_every_attribute_of_unreals_schema_has_its_name_and_scope_in_alembic(tmp_path):
    groom, path = random_groom(), tmp_path / "a.abc"
    writer = alembic.CurvesWriter(path, Description(24, 1, 1, [groom], "test"))
    writer.frame(1, groom.points, np.zeros_like(groom.points))
    writer.finish()
    top = Abc.IArchive(str(path)).getTop()
    own = {"groom_version_major": "con", "groom_version_minor": "con"}
    for name, expected in (("my_hair", UNREAL | own), ("my_hair_guides", {"groom_guide": "con", "groom_id": "uni", "groom_width": "vtx"} | own)):
        names = [child.getName() for child in top.children]
        assert name in names, names
        headers = AbcGeom.ICurves(top, name).getSchema().getArbGeomParams().propertyheaders
        scopes = {h.getName(): h.getMetaData().serialize().split("geoScope=")[1].split(";")[0] for h in headers}
        assert {key: scopes.get(key) for key in expected} == expected


def test_every_attribute_of_unreals_schema_has_its_name_and_interpolation_in_usd(tmp_path):
    pytest.importorskip("pxr")
    from pxr import Usd, UsdGeom

    from hairspring import usd

    groom, path = random_groom(), tmp_path / "a.usda"
    writer = usd.CurvesWriter(path, Description(24, 1, 1, [groom], "test"))
    writer.frame(1, groom.points, np.zeros_like(groom.points))
    writer.finish()
    stage = Usd.Stage.Open(str(path))
    prim = next(p for p in stage.Traverse() if p.IsA(UsdGeom.BasisCurves))
    found = {p.GetPrimvarName(): p.GetInterpolation() for p in UsdGeom.PrimvarsAPI(prim).GetAuthoredPrimvars()}
    # USD has attributes of its own for color and width.
    names = set(UNREAL) - {"groom_color", "groom_width"} | {"groom_guide"}
    assert {name: found.get(name) for name in names} == dict.fromkeys(names, "uniform")
    assert found["displayColor"] == "vertex" and UsdGeom.Curves(prim).GetWidthsInterpolation() == "vertex"
    # The proposal of the Alliance for OpenUSD for curves that deform has these names.
    assert "PhysicsCurvesDeformableSimAPI" in prim.GetMetadata("apiSchemas").GetAddedOrExplicitItems()
    assert prim.GetAttribute("physics:restShapePoints").HasAuthoredValue()


def test_a_file_without_a_unit_is_guessed_and_said(tmp_path):
    groom = random_groom()
    groom.points = groom.points * 300
    groom.radii = groom.radii * 100
    writer = alembic.CurvesWriter(tmp_path / "cm.abc", Description(24, 1, 1, [groom]))
    writer.frame(1, groom.points, np.zeros_like(groom.points))
    writer.finish()
    read = hs.Groom.read(tmp_path / "cm.abc")
    assert any("centimeters" in note for note in read.notes)
    assert np.ptp(read.points, axis=0).max() < 0.5


def test_a_mesh_that_moves_is_a_vertex_cache(tmp_path, program):
    import imath

    path = tmp_path / "body.abc"
    archive = Abc.OArchive(str(path))
    from alembic3d import AbcCoreAbstract as core

    sampling = Abc.Argument(archive.addTimeSampling(core.TimeSampling(1 / 24, 0.0)))
    mesh = AbcGeom.OPolyMesh(archive.getTop(), "ball", sampling)
    grid = np.array([(x, y, z) for x in (-0.1, 0.1) for y in (0, 0.2) for z in (-0.1, 0.1)], np.float32)
    # Clockwise seen from outside, as Alembic has it.
    faces = [[2, 3, 1, 0], [5, 7, 6, 4], [1, 5, 4, 0], [6, 7, 3, 2], [4, 6, 2, 0], [3, 7, 5, 1]]
    for k in range(12):
        moved = grid + np.float32([0.01 * k, 0, 0])
        sample = AbcGeom.OPolyMeshSchemaSample(
            imath.V3fArrayFromBuffer(moved),
            imath.IntArrayFromBuffer(np.int32(faces).reshape(-1)),
            imath.IntArrayFromBuffer(np.full(6, 4, np.int32)),
        )
        mesh.getSchema().set(sample)
    del mesh, sampling, sample, archive
    read = alembic.read_mesh(path)
    assert read.frames.shape == (12, 8, 3) and read.rate == pytest.approx(24)
    # Faces point outward, as everywhere else.
    a, b, c = (read.vertices[read.triangles[:, k]] for k in range(3))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
    assert volume == pytest.approx(0.2 * 0.2 * 0.2, rel=1e-4)
    points = np.float32([[0, 0.2 + 0.01 * i, 0] for i in range(10)])
    hs.Groom(points, [0, 10]).write(tmp_path / "hair.data")
    (tmp_path / "shot.toml").write_text(
        '[body]\nfile = "body.abc"\nscale = 1.0\n[[groom]]\nfile = "hair.data"\nscale = 1.0\n'
    )
    code, _, error = program("bake", tmp_path / "shot.toml", "-o", tmp_path / "out.####.hair", "--fps", "24")
    assert code == 0, error
    last = hs.Groom.read(tmp_path / "out.0012.hair", up="y").points
    np.testing.assert_allclose(last[0], [0.11, 0.2, 0], atol=1e-5)
    assert not (tmp_path / "out.0013.hair").exists()
