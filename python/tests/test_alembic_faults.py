"""Alembic archives with faults, what is not read, and disks that are full."""

import shutil
from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip("alembic3d")
import imath
from alembic3d import Abc, AbcCoreAbstract, AbcGeom

from hairspring import alembic
from hairspring.alembic import write
from hairspring.description import Description, MovingGroom
from hairspring.formats import FormatError

CORNERS = np.float32([[0, 0, 0], [0.2, 0, 0], [0, 0.2, 0], [0, 0, 0.2]])
# Clockwise seen from outside, as Alembic has it.
FACES = [0, 1, 2, 0, 3, 1, 1, 3, 2, 0, 2, 3]


def vectors(points):
    return imath.V3fArrayFromBuffer(np.ascontiguousarray(points, np.float32))


def integers(values):
    return imath.IntArrayFromBuffer(np.ascontiguousarray(values, np.int32))


def curves(parent, name="hair", points=7, basis=AbcGeom.BasisType.kNoBasis, kind=AbcGeom.CurveType.kLinear):
    """Five strands."""
    own = [(0.02 * s, 0.02 * k, 0) for s in range(5) for k in range(points)]
    made = AbcGeom.OCurves(parent, name)
    sample = AbcGeom.OCurvesSchemaSample(vectors(own), integers([points] * 5), kind, AbcGeom.CurvePeriodicity.kNonPeriodic)
    sample.setBasis(basis)
    made.getSchema().set(sample)
    return made


def mesh(parent, samples, kind="PolyMesh", times=None):
    made = getattr(AbcGeom, f"O{kind}")(*[parent, "m"], *([] if times is None else [times]))
    for points in samples:
        sample = getattr(AbcGeom, f"O{kind}SchemaSample")
        made.getSchema().set(sample(vectors(points), integers(FACES), integers([3] * 4)))
    return made


def archive(path, fill):
    """Writes an archive, which is complete when nothing holds it."""
    made = Abc.OArchive(str(path))
    fill(made, made.getTop())
    return path


def uniform(made, step):
    return Abc.Argument(made.addTimeSampling(AbcCoreAbstract.TimeSampling(step, 0.0)))


def volume(read):
    a, b, c = (read.vertices[read.triangles[:, k]].astype(np.float64) for k in range(3))
    return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6


@pytest.mark.parametrize("scale", [(1, 1, 1), (-1, 1, 1)])
@pytest.mark.parametrize("kind", ["PolyMesh", "SubD"])
def test_meshes_of_both_kinds_are_read_and_never_inside_out(tmp_path, scale, kind):
    def fill(made, top):
        xform, sample = AbcGeom.OXform(top, "x"), AbcGeom.XformSample()
        sample.setScale(imath.V3d(*scale))
        xform.getSchema().set(sample)
        mesh(xform, [CORNERS], kind)

    read = alembic.read_mesh(archive(tmp_path / "a.abc", fill))
    assert len(read.triangles) == 4 and volume(read) == pytest.approx(0.2**3 / 6, rel=1e-4)


def test_another_number_of_points_is_refused(tmp_path):
    more = np.concatenate([CORNERS, CORNERS[:1]])
    path = archive(tmp_path / "a.abc", lambda made, top: mesh(top, [CORNERS, more, CORNERS], times=uniform(made, 1 / 24)))
    with pytest.raises(FormatError, match="/m has 5 points at 0.0416667 s and 4 in the first sample"):
        alembic.read_mesh(path)


def test_an_endless_motion_is_refused_and_close_samples_are_reduced(tmp_path):
    moved = [CORNERS + np.float32([0.01 * k, 0, 0]) for k in range(11)]
    path = archive(tmp_path / "a.abc", lambda made, top: mesh(top, moved, times=uniform(made, 1 / 2400)))
    read = alembic.read_mesh(path)
    assert read.rate == pytest.approx(240) and "samples of the meshes are closer than 1/240 s" in read.notes[0]

    def fill(made, top):
        mesh(top, moved[:3], times=uniform(made, 1 / 24))
        xform = AbcGeom.OXform(top, "x", uniform(made, 1e12))
        for shift in (0, 1):
            sample = AbcGeom.XformSample()
            sample.setTranslation(imath.V3d(shift, 0, 0))
            xform.getSchema().set(sample)
        mesh(xform, [CORNERS])

    with pytest.raises(FormatError, match="the limit is 100000"):
        alembic.read_mesh(archive(tmp_path / "b.abc", fill))


def test_hidden_curves_are_left_out_with_a_note(tmp_path):
    def fill(made, top):
        AbcGeom.CreateVisibilityProperty(curves(top, "hidden"), 0).setValue(0)
        curves(top, "shown")

    read = alembic.read_curves(archive(tmp_path / "a.abc", fill))
    assert read.group_names == ["/shown"] and read.notes == ["objects that are hidden are left out (/hidden)"]


@pytest.mark.parametrize("name", ["Hermite", "Power"])
def test_curves_of_other_bases_are_left_out_with_a_note(tmp_path, name):
    basis = getattr(AbcGeom.BasisType, f"k{name}Basis")

    def fill(made, top):
        curves(top, "other", basis=basis, kind=AbcGeom.CurveType.kCubic)
        curves(top, "hair")

    read = alembic.read_curves(archive(tmp_path / "a.abc", fill))
    assert len(read.offsets) == 6 and f"/other has curves of the {name} basis; left out" in read.notes[0]


def test_a_bezier_curve_of_another_number_of_points_is_refused(tmp_path):
    bezier = {"basis": AbcGeom.BasisType.kBezierBasis, "kind": AbcGeom.CurveType.kCubic}
    assert len(alembic.read_curves(archive(tmp_path / "a.abc", lambda made, top: curves(top, **bezier))).points) == 35
    with pytest.raises(FormatError, match="/hair has a Bézier curve of 6 points"):
        alembic.read_curves(archive(tmp_path / "b.abc", lambda made, top: curves(top, points=6, **bezier)))


def test_values_of_another_number_are_left_out_with_a_note(tmp_path):
    scope = AbcGeom.GeometryScope

    def fill(made, top):
        parameters = curves(top).getSchema().getArbGeomParams()
        for kind, name, values, where in (
            ("Float", "groom_width", imath.FloatArrayFromBuffer(np.full(7, 1e-4, np.float32)), scope.kVertexScope),
            ("Int32", "groom_group_id", integers([0, 1, 1]), scope.kUniformScope),
        ):
            added = getattr(AbcGeom, f"O{kind}GeomParam")(parameters, name, False, where, 1)
            added.set(getattr(AbcGeom, f"O{kind}GeomParamSample")(values, where))

    read = alembic.read_curves(archive(tmp_path / "a.abc", fill))
    assert read.radii is None
    assert read.notes == [
        "`groom_width` of /hair has 7 values, and vertex interpolation needs 35; left out, so that its strands have the radius of"
        " the others, or the default",
        "`groom_group_id` of /hair has 3 values for 5 strands; left out",
    ]


@pytest.mark.parametrize("content, sentence", [(b"x", "damaged or is not Alembic"), (b"\x89HDF\r\n\x1a\n" + bytes(100), "HDF5")])
def test_errors_have_no_text_of_the_library(tmp_path, content, sentence):
    (tmp_path / "a.abc").write_bytes(content)
    with pytest.raises(FormatError, match=sentence) as caught:
        alembic.read_curves(tmp_path / "a.abc")
    assert "core type" not in str(caught.value)


def begin(path):
    points = np.random.default_rng(1).random((20_000, 3)).astype(np.float32)
    offsets = np.arange(2_001, dtype=np.uint32) * 10
    groom = MovingGroom("g", points, offsets, np.full(20_000, 4e-5, np.float32), np.ones(2_000, bool))
    return alembic.CurvesWriter(path, Description(24, 1, 50, [groom])), points


def test_a_full_disk_is_an_error_before_anything_is_written(tmp_path, monkeypatch):
    writer, points = begin(tmp_path / "a.abc")
    writer.frame(1, points, points)
    monkeypatch.setattr(shutil, "disk_usage", lambda path: SimpleNamespace(free=1_000_000))
    for act in (lambda: writer.frame(2, points, points), writer.finish):
        with pytest.raises(OSError, match="the disk is full: 1.0 MB are free"):
            act()
    assert list(tmp_path.iterdir()) == []


FAILING = """
import resource, sys
from pathlib import Path
sys.path.insert(0, {tests!r})
from test_alembic_faults import begin
resource.setrlimit(resource.RLIMIT_FSIZE, (1_000_000, 1_000_000))
writer, points = begin(Path({path!r}))
try:
    for frame in range(1, 51):
        writer.frame(frame, points + frame, points)
except OSError as error:
    print(error)
writer.discard()
"""


def test_a_write_that_fails_does_not_end_the_process(tmp_path):
    import subprocess
    import sys
    from pathlib import Path

    pytest.importorskip("resource")
    script = FAILING.format(tests=str(Path(__file__).parent), path=str(tmp_path / "a.abc"))
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == write.NOT_WRITTEN
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_is_missing_is_an_error(tmp_path):
    with pytest.raises(OSError, match="the file cannot be created"):
        begin(tmp_path / "none" / "a.abc")


def parameter(made, kind, name, values, scope=AbcGeom.GeometryScope.kUniformScope):
    added = getattr(AbcGeom, f"O{kind}GeomParam")(made.getSchema().getArbGeomParams(), name, False, scope, 1)
    added.set(getattr(AbcGeom, f"O{kind}GeomParamSample")(values, scope))


def filled(kind, values):
    array = kind(len(values))
    for k, value in enumerate(values):
        array[k] = value
    return array


def test_attributes_are_read_in_every_width_of_number_and_the_others_are_named(tmp_path):
    def fill(made, top):
        hair = curves(top)
        parameter(hair, "Uchar", "groom_guide", filled(imath.UnsignedCharArray, [1, 0, 0, 0, 0]))
        parameter(hair, "UInt16", "groom_group_id", filled(imath.UnsignedShortArray, [3] * 5))
        parameter(hair, "C4f", "groom_color", filled(imath.C4fArray, [imath.Color4f(0.1, 0.2, 0.3, 1)] * 5))
        parameter(hair, "V2d", "groom_root_uv", filled(imath.V2dArray, [imath.V2d(0.1, 0.2)] * 5))
        parameter(hair, "Int32", "stiffness", integers([2] * 5))
        parameter(hair, "Int32", "clumpness", integers([2] * 5))
        parameter(hair, "V3f", "damping", vectors([(1, 1, 1)] * 5))

    got = alembic.read_curves(archive(tmp_path / "a.abc", fill))
    assert (got.groups == 3).all() and (got.factors["stiffness"] == 2).all() and (got.guides[:, 0] == 0).all()
    np.testing.assert_allclose(got.colors[0], [0.1, 0.2, 0.3], rtol=1e-6)
    np.testing.assert_allclose(got.root_uvs[0], [0.1, 0.2], rtol=1e-6)
    assert got.notes == [
        "attributes of curves that are not used: clumpness",
        "attributes of curves whose type is not read: damping; write numbers of 32 bits",
    ]


def test_closest_guides_name_ids(tmp_path):
    def fill(made, top):
        hair = curves(top)
        parameter(hair, "Int32", "groom_id", integers([14, 13, 12, 11, 10]))
        parameter(hair, "V3i", "groom_closest_guides", imath.V3iArrayFromBuffer(np.full((5, 3), 13, np.int32)))
        parameter(hair, "V3f", "groom_guide_weights", vectors([(1, 0, 0)] * 5))

    assert (alembic.read_curves(archive(tmp_path / "a.abc", fill)).guides == 1).all()


def test_guides_in_an_object_of_their_own_guide_the_others(tmp_path):
    def fill(made, top):
        guides, hair = curves(top, "guides"), curves(top)
        parameter(guides, "Int16", "groom_guide", filled(imath.ShortArray, [1]), AbcGeom.GeometryScope.kConstantScope)
        parameter(guides, "Int32", "groom_id", integers([100, 101, 102, 103, 104]))
        parameter(hair, "V3i", "groom_closest_guides", imath.V3iArrayFromBuffer(np.full((5, 3), 102, np.int32)))
        parameter(hair, "V3f", "groom_guide_weights", vectors([(0.5, 0.5, 0)] * 5))

    got = alembic.read_curves(archive(tmp_path / "a.abc", fill))
    names = [got.group_names[g] for g in got.groups]
    guide = names.index("/guides") + 2
    assert (got.guides[np.array(names) == "/hair"] == guide).all()
    own = np.flatnonzero(np.array(names) == "/guides")
    assert (got.guides[own, 0] == own).all() and (got.guide_weights[own, 0] == 1).all()


def test_guides_mark_strands_of_the_same_id_and_root(tmp_path):
    """Ids that begin again in each object, as files of version 0.1.0 have them."""

    def fill(made, top):
        for name, height in (("low", 0.0), ("high", 1.0)):
            for suffix, ids in (("", [0, 1, 2, 3, 4]), ("_guides", [1, 3])):
                if name == "low" or not suffix:
                    points = np.array([(0.01 * i, height + 0.01 * k, 0) for i in ids for k in range(4)])
                    hair = AbcGeom.OCurves(top, name + suffix)
                    linear, open_ends = AbcGeom.CurveType.kLinear, AbcGeom.CurvePeriodicity.kNonPeriodic
                    sample = AbcGeom.OCurvesSchemaSample(vectors(points), integers([4] * len(ids)), linear, open_ends)
                    hair.getSchema().set(sample)
                    parameter(hair, "Int32", "groom_id", integers(ids))
                    if suffix:
                        constant = AbcGeom.GeometryScope.kConstantScope
                        parameter(hair, "Int16", "groom_guide", filled(imath.ShortArray, [1]), constant)

    got = alembic.read_curves(archive(tmp_path / "a.abc", fill), scale=1.0)
    assert len(got.offsets) == 11
    assert set(got.guides[:, 0]) == {1, 3}, "guides of `low` only"


def test_guides_that_cannot_be_used_are_left_out_with_a_note(tmp_path):
    for name, ids, weights, words in (
        ("a", 99, (1, 0, 0), "strands that do not exist"),
        ("b", 1, (np.nan, 0, 0), "not finite, below 0 or all 0"),
        ("c", 1, (0, 0, 0), "not finite, below 0 or all 0"),
    ):

        def fill(made, top):
            hair = curves(top)
            parameter(hair, "V3i", "groom_closest_guides", imath.V3iArrayFromBuffer(np.full((5, 3), ids, np.int32)))
            parameter(hair, "V3f", "groom_guide_weights", vectors([weights] * 5))

        got = alembic.read_curves(archive(tmp_path / f"{name}.abc", fill))
        assert got.guides is None and any(words in note for note in got.notes), (name, got.notes)


def test_curves_without_strands_or_of_negative_length_are_named(tmp_path):
    def fill(made, top, counts):
        made = AbcGeom.OCurves(top, "hair")
        points = np.zeros((max(sum(counts), 0), 3))
        linear, open_ends = AbcGeom.CurveType.kLinear, AbcGeom.CurvePeriodicity.kNonPeriodic
        made.getSchema().set(AbcGeom.OCurvesSchemaSample(vectors(points), integers(counts), linear, open_ends))
        return made

    with pytest.raises(FormatError, match="/hair has no curves; left out"):
        alembic.read_curves(archive(tmp_path / "a.abc", lambda made, top: fill(made, top, [])))
    with pytest.raises(FormatError, match="a curve of -3 points"):
        alembic.read_curves(archive(tmp_path / "b.abc", lambda made, top: fill(made, top, [-3, 10])))
