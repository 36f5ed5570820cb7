"""Readers of Alembic archives."""

from __future__ import annotations

from pathlib import Path
from typing import Iterator

import numpy as np
from alembic3d import Abc, AbcGeom

from ..formats import FACTORS, MAX_POSITIONS, MAX_RATE, MAX_SAMPLES, Curves, FormatError, MovingMesh, as_lengths_and_points
from ..formats import AbsentError, guides_from_flags
from ..shapes import DEFAULT_RADIUS, check_counts, distinct, expand, fitted, naming, of_strands, on_curve, spacing, triangulate
from ..shapes import unplayed, varying_count
from .guides import guides_of, repeats, strands_of_ids

BASES = {"kBezierBasis": "bezier", "kBsplineBasis": "bspline", "kCatmullromBasis": "catmullRom"}
SCOPES = {
    "kConstantScope": "constant",
    "kUniformScope": "uniform",
    "kVaryingScope": "varying",
    "kVertexScope": "vertex",
    "kFacevaryingScope": "faceVarying",
}
Z_UP = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])


def open_archive(path: Path):
    """Opens an archive."""
    try:
        return Abc.IArchive(str(path))
    except RuntimeError as error:
        if "HDF5" in str(error):
            raise FormatError("the archive is of the older kind HDF5; convert it with `abcconvert -toOgawa`") from None
        raise FormatError("the archive cannot be opened: the file is damaged or is not Alembic; export it again") from None


def objects(parent, kind, matrix=None) -> Iterator[tuple]:
    """All objects of a type below `parent`, each with the list of transforms above it."""
    above = matrix or []
    for child in parent.children:
        header = child.getHeader()
        if kind.matches(header):
            yield kind(parent, child.getName()), above
        if AbcGeom.IXform.matches(header):
            yield from objects(child, kind, [*above, AbcGeom.IXform(parent, child.getName()).getSchema()])
        else:
            yield from objects(child, kind, above)


def visible(parent, kind, notes: list[str]) -> Iterator[tuple]:
    """Like `objects`, without hidden objects and those without samples, which notes name."""
    hidden, empty = [], []
    for found, above in objects(parent, kind):
        if AbcGeom.IsAncestorInvisible(found, Abc.ISampleSelector()):
            hidden.append(found.getFullName())
        elif found.getSchema().getNumSamples() == 0:
            empty.append(found.getFullName())
        else:
            yield found, above
    for names, why in ((hidden, "hidden"), (empty, "without samples")):
        if names:
            notes.append(f"objects that are {why} are left out ({naming(names)})")


def because(notes: list[str]) -> str:
    """What notes say about the cause of an error, in brackets."""
    return f" ({'; '.join(notes)})" if notes else ""


def world(above: list, selector) -> np.ndarray:
    """The matrix [4, 4] of nested transforms at a time; for row vectors."""
    total = np.eye(4)
    for schema in reversed(above):
        if schema.getNumSamples() == 0:
            continue
        sample = schema.getValue(selector)
        m = sample.getMatrix()
        total = total @ np.array([[m[i][j] for j in range(4)] for i in range(4)])
        if not sample.getInheritsXforms():
            break
    return total


def place(points, matrix: np.ndarray, to: np.ndarray) -> np.ndarray:
    """Points in world space, in meters and Y up."""
    points = np.asarray(points, np.float64).reshape(-1, 3)
    return (points @ matrix[:3, :3] + matrix[3, :3]) @ to


def attribute(schema, kinds: tuple, *names: str):
    """The values of the first of these attributes, and its interpolation."""
    parameters = schema.getArbGeomParams()
    known = headers(schema)
    for name in names:
        for kind in kinds:
            if name in known and kind.matches(known[name]):
                return parameter_values(kind(parameters, name))
    return None, ""


def headers(schema) -> dict:
    """The attributes of an object by their names."""
    parameters = schema.getArbGeomParams()
    return {header.getName(): header for header in parameters.propertyheaders} if parameters.valid() else {}


def unused(found: list[tuple], notes: list[str]) -> None:
    """Adds notes about attributes of curves that are not read: unknown ones, and known ones of another type."""
    unknown, of_another_type = set(), set()
    for curves, _ in found:
        for name, header in headers(curves.getSchema()).items():
            kinds = KINDS.get(name)
            if kinds is None and name not in IGNORED:
                unknown.add(name)
            elif kinds and not any(kind.matches(header) for kind in kinds):
                of_another_type.add(name)
    if unknown:
        notes.append(f"attributes of curves that are not used: {naming(sorted(unknown))}")
    if of_another_type:
        notes.append(f"attributes of curves whose type is not read: {naming(sorted(of_another_type))}; write numbers of 32 bits")


def parameter_values(parameter):
    """The first values of a geometry parameter, and its interpolation."""
    if not parameter.valid() or parameter.getNumSamples() == 0:
        return None, ""
    values = np.asarray(parameter.getExpandedValue().getVals())
    return np.atleast_1d(values), SCOPES.get(str(parameter.getScope()).split(".")[-1], "constant")


FLOATS = (AbcGeom.IFloatGeomParam, AbcGeom.IDoubleGeomParam, AbcGeom.IInt32GeomParam, AbcGeom.IInt16GeomParam)
INTEGERS = (
    *(AbcGeom.IInt32GeomParam, AbcGeom.IInt16GeomParam, AbcGeom.IUInt32GeomParam, AbcGeom.IInt64GeomParam),
    *(AbcGeom.IUInt16GeomParam, AbcGeom.IUcharGeomParam, AbcGeom.ICharGeomParam, AbcGeom.IFloatGeomParam),
)
TRIPLES = (AbcGeom.IV3iGeomParam, AbcGeom.IV3fGeomParam, AbcGeom.IInt32GeomParam, AbcGeom.IFloatGeomParam)
PAIRS = (AbcGeom.IV2fGeomParam, AbcGeom.IP2fGeomParam, AbcGeom.IV2dGeomParam, AbcGeom.IFloatGeomParam)
COLORS = (AbcGeom.IC3fGeomParam, AbcGeom.IV3fGeomParam, AbcGeom.IC4fGeomParam, AbcGeom.IV3dGeomParam)
WEIGHTS = (AbcGeom.IV3fGeomParam, AbcGeom.IFloatGeomParam)

KINDS = {
    "groom_width": FLOATS,
    **dict.fromkeys(("groom_color", "Cd", "displayColor"), COLORS),
    **dict.fromkeys(("groom_root_uv", "surface_uv_coordinate", "st"), PAIRS),
    **dict.fromkeys(("groom_group_id", "groom_id", "groom_guide"), INTEGERS),
    "groom_closest_guides": TRIPLES,
    "groom_guide_weights": WEIGHTS,
    **dict.fromkeys(FACTORS, FLOATS),
}
"""The types in which each attribute is read."""

IGNORED = ("groom_version_major", "groom_version_minor", "groom_group_name", "width", "N", "uv")
"""Attributes that have nothing to do with the simulation, or are read as properties of the curves."""


def read_curves(path: Path, scale: float | None = None, up: str | None = None) -> Curves:
    """Reads all curves of an archive as one groom, at their first sample.

    Each object becomes a group, unless `groom_group_id` gives the groups. The attributes of Unreal's groom schema are read:
    `groom_width`, `groom_color`, `groom_root_uv`, `groom_id`, `groom_guide`, `groom_closest_guides`, `groom_guide_weights`.
    Objects of guides (`groom_guide` = 1) whose `groom_id` are those of other strands mark these as guides.
    """
    archive = open_archive(path)
    to = (Z_UP.T if (up or "y").lower() == "z" else np.eye(3)) * (1.0 if scale is None else scale)
    notes: list[str] = []
    found = list(visible(archive.getTop(), AbcGeom.ICurves, notes))
    unused(found, notes)
    notes += unplayed(times_of(found))
    parts = [read_object(curves.getFullName(), curves.getSchema(), above, to, notes) for curves, above in found]
    read = [part for part in parts if part]
    if not read:
        raise AbsentError("the archive has no curves" + because(notes))
    return join(read, notes)


def read_object(name: str, schema, above: list, to: np.ndarray, notes: list[str]) -> dict | None:
    """Reads one object of curves."""
    first = Abc.ISampleSelector()
    sample = schema.getValue(first)
    counts = np.asarray(sample.getCurvesNumVertices()).astype(np.int64)
    if len(counts) == 0:
        notes.append(f"{name} has no curves; left out")
        return None
    if str(sample.getWrap()).endswith("kPeriodic"):
        notes.append(f"{name} has closed curves; left out")
        return None
    matrix = world(above, first)
    control = place(sample.getPositions(), matrix, to)
    if counts.min() < 0:
        raise FormatError(f"{name} has a curve of {counts.min()} points; export it again")
    if counts.sum() != len(control):
        raise FormatError(f"{name} has {len(control)} points, and its counts name {counts.sum()}")
    kind = "cubic" if str(sample.getType()).endswith("kCubic") else "linear"
    if str(sample.getType()).endswith("kVariableOrder"):
        notes.append(f"{name} has curves of variable order; their control points are read as strands")
    basis_name = str(sample.getBasis()).split(".")[-1]
    basis = BASES.get(basis_name, "")
    if kind == "cubic" and basis_name in ("kHermiteBasis", "kPowerBasis"):
        notes.append(f"{name} has curves of the {basis_name[1:-5]} basis; left out: export them as B-splines or Bézier curves")
        return None
    if kind == "cubic" and not basis:
        kind = "linear"
    knots = np.asarray(sample.getKnots() or [])
    if basis == "bspline" and len(knots) > 3 and knots[0] == knots[3]:
        notes.append(f"{name} has knots, which are not used: its B-splines are read as uniform, and begin inside of their first points")
    check_counts(name, counts, kind, basis)
    length = float(np.cbrt(abs(np.linalg.det(matrix[:3, :3] @ to))))
    each = np.array([[varying_count(int(n), kind, basis, "nonperiodic") for n in counts], counts])
    n = len(counts)

    def fit(size: int, kinds: tuple, *names: str, instead: str = "left out") -> tuple[np.ndarray | None, str]:
        values, scope = attribute(schema, kinds, *names)
        if values is not None and size > 1 and values.ndim == 1 and values.size % size == 0:
            values = values.reshape(-1, size)
        return fitted(values, scope, each, f"`{names[0]}` of {name}", notes, size, instead)

    def spread(kinds: tuple, attribute_name: str) -> np.ndarray | None:
        return of_strands(attribute(schema, kinds, attribute_name)[0], n, f"`{attribute_name}` of {name}", notes)

    def whole(attribute_name: str) -> np.ndarray | None:
        values = spread(INTEGERS, attribute_name)
        if values is not None and not np.isfinite(values).all():
            notes.append(f"`{attribute_name}` of {name} is not finite; left out")
            return None
        return None if values is None else values.astype(np.int64)

    def triples(kinds: tuple, attribute_name: str) -> np.ndarray | None:
        values = attribute(schema, kinds, attribute_name)[0]
        if values is None or values.size == 3 * n:
            return None if values is None else values.reshape(n, 3)
        notes.append(f"`{attribute_name}` of {name} does not have three numbers for each strand; left out")
        return None

    width, width_scope = fit(1, FLOATS, "groom_width", instead=DEFAULT_RADIUS)
    if width is None and schema.getWidthsParam().valid():
        width, width_scope = parameter_values(schema.getWidthsParam())
        width, width_scope = fitted(width, width_scope, each, f"`width` of {name}", notes, instead=DEFAULT_RADIUS)
    color, color_scope = fit(3, COLORS, "groom_color", "Cd", "displayColor")
    color = None if color is None else color[:, :3]
    uv, uv_scope = fit(2, PAIRS, "groom_root_uv", "surface_uv_coordinate", "st")
    strands, radii, colors, uvs, start = [], [], [], [], 0
    for s, count in enumerate(counts):
        points = on_curve(control[start : start + count], kind, basis, "nonperiodic")
        start += int(count)
        strands.append(points)
        along = None if width is None else expand(width, width_scope, s, each, len(points))
        radii.append(np.full(len(points), np.nan) if along is None else 0.5 * length * along)
        along = None if color is None else expand(color, color_scope, s, each, len(points))
        colors.append(np.full((len(points), 3), np.nan) if along is None else along)
        root = None if uv is None else expand(uv, uv_scope, s, each, max(len(points), 1))
        uvs.append(np.full(2, np.nan) if root is None else root[0][:2])
    return {
        "name": name,
        "strands": strands,
        "radii": radii,
        "colors": colors,
        "uvs": uvs,
        "group": whole("groom_group_id"),
        "ids": whole("groom_id"),
        "guide": whole("groom_guide"),
        "closest": triples(TRIPLES, "groom_closest_guides"),
        "weights": triples(WEIGHTS, "groom_guide_weights"),
        "factors": {factor: spread(FLOATS, factor) for factor in FACTORS},
    }


def join(read: list[dict], notes: list[str]) -> Curves:
    """Joins the objects. Objects that repeat strands as guides only mark them."""
    drawn = [r for r in read if r["guide"] is None or not r["guide"].all()]
    marks: list[int] = []
    if drawn:
        known = strands_of_ids(drawn)
        for r in [r for r in read if not any(r is d for d in drawn)]:
            repeated = repeats(r, known)
            if repeated is None:
                drawn.append(r)
            else:
                marks += repeated
    else:
        drawn = read
    strands = [s for r in drawn for s in r["strands"]]
    points, offsets = as_lengths_and_points(strands)
    curves = Curves(points, offsets, group_names=[r["name"] for r in drawn], notes=notes)
    radii = np.concatenate([x for r in drawn for x in r["radii"]])
    if np.isfinite(radii).any():
        curves.radii = np.where(np.isfinite(radii), radii, np.nanmedian(radii)).astype(np.float32)
    colors = np.concatenate([x for r in drawn for x in r["colors"]])
    if np.isfinite(colors).all():
        curves.colors = np.clip(colors, 0, 1).astype(np.float32)
    uvs = np.array([x for r in drawn for x in r["uvs"]])
    if np.isfinite(uvs).all():
        curves.root_uvs = uvs.astype(np.float32)
    groups = np.concatenate(
        [np.full(len(r["strands"]), k) if r["group"] is None else r["group"] for k, r in enumerate(drawn)]
    )
    if 0 <= groups.min() and groups.max() <= 65535:
        curves.groups = groups.astype(np.uint32)
    else:
        notes.append("groom_group_id is not from 0 to 65535; left out")
    flags = np.concatenate(
        [
            np.zeros(len(r["strands"]), bool) if r["guide"] is None else np.asarray(r["guide"]).astype(bool)
            for r in drawn
        ]
    )
    for name in FACTORS:
        each = [r["factors"][name] for r in drawn]
        if any(a is not None for a in each):
            filled = [np.ones(len(r["strands"])) if a is None else a for r, a in zip(drawn, each)]
            curves.factors[name] = np.maximum(np.concatenate(filled), 0).astype(np.float32)
    flags[marks] = True
    closest, weights = guides_of(drawn, notes)
    if closest is not None:
        curves.guides, curves.guide_weights = closest, weights
    if curves.guides is None and flags.any():
        objects = np.repeat(np.arange(len(drawn)), [len(r["strands"]) for r in drawn])
        found = guides_from_flags(flags, points[offsets[:-1]], objects)
        if found:
            curves.guides, curves.guide_weights = found
    return curves


def times_of(found: list[tuple]) -> set[float]:
    """The times [s] of the samples of any of these objects, and of the transforms above them; none of what has one sample."""
    times: set[float] = set()
    for item, above in found:
        for schema in [item.getSchema(), *above]:
            sampling, count = schema.getTimeSampling(), schema.getNumSamples()
            if count > 1:
                times.update(sampling.getSampleTime(k) for k in range(count))
    return times


def sample_times(meshes: list[tuple], notes: list[str]) -> tuple[np.ndarray, float]:
    """The times [s] at which any of `meshes` moves, equally spaced, and their rate [Hz]; one time if nothing moves.

    They are as close as the closest two samples, but not closer than 1/240 s; a note says if samples are closer."""
    ordered = distinct(times_of(meshes))
    if len(ordered) < 2:
        return np.zeros(1), 24.0
    closest, span = spacing(ordered), float(ordered[-1] - ordered[0])
    if closest < 0.99 / MAX_RATE:
        notes.append(f"samples of the meshes are closer than 1/{MAX_RATE:g} s; their motion is sampled at {MAX_RATE:g} Hz")
    step = max(closest, 1 / MAX_RATE)
    if abs(span / step - round(span / step)) < 0.01:
        # Times are rounded.
        step = span / round(span / step)
    count = int(np.ceil(span / step - 1e-6)) + 1
    if count > MAX_SAMPLES:
        raise FormatError(f"the samples of the meshes span {count} frames; the limit is {MAX_SAMPLES}, so shorten the motion")
    return ordered[0] + step * np.arange(count), 1 / step


def read_mesh(path: Path, scale: float | None = None, up: str | None = None) -> MovingMesh:
    """Reads all polygon and subdivision meshes of an archive as one body, with the motion of their vertices.

    Subdivision meshes are read as polygons between their control points."""
    archive = open_archive(path)
    to = (Z_UP.T if (up or "y").lower() == "z" else np.eye(3)) * (1.0 if scale is None else scale)
    notes: list[str] = []
    meshes = [found for kind in (AbcGeom.IPolyMesh, AbcGeom.ISubD) for found in visible(archive.getTop(), kind, notes)]
    patches = [patch.getFullName() for patch, _ in objects(archive.getTop(), AbcGeom.INuPatch)]
    if patches:
        notes.append(f"NURBS patches are left out ({naming(patches)}); convert them to meshes")
    if not meshes:
        raise AbsentError("the archive has no polygon meshes" + because(notes))
    at, rate = sample_times(meshes, notes)
    triangles, parts, total = [], [], 0
    sizes = []
    for mesh, above in meshes:
        schema = mesh.getSchema()
        if "Heterogen" in str(schema.getTopologyVariance()):
            raise FormatError(f"the topology of {mesh.getFullName()} changes over time; export a mesh of constant topology")
        sample = schema.getValue(Abc.ISampleSelector())
        counts = np.asarray(sample.getFaceCounts()).astype(np.int64)
        indices = np.asarray(sample.getFaceIndices()).astype(np.int64)
        count = len(sample.getPositions())
        if not len(counts) or not count:
            raise FormatError(f"{mesh.getFullName()} has no faces or no points")
        if counts.min() < 0 or counts.sum() != len(indices) or (len(indices) and not 0 <= indices.min() <= indices.max() < count):
            raise FormatError(f"the faces of {mesh.getFullName()} name vertices that do not exist")
        own = triangulate(counts, indices, np.array(sample.getPositions(), np.float64).reshape(-1, 3))
        # Alembic's faces are clockwise seen from outside, unless the transform mirrors them.
        if np.linalg.det(world(above, Abc.ISampleSelector())[:3, :3]) > 0:
            own = own[:, ::-1]
        triangles.append(own + total)
        parts.append((mesh.getFullName(), len(own)))
        sizes.append(count)
        total += count
    if len(at) * total > MAX_POSITIONS:
        raise FormatError(f"the motion holds more than {MAX_POSITIONS} positions; shorten it")
    frames = np.empty((len(at), total, 3), np.float32)
    for f, t in enumerate(at):
        selector, first = Abc.ISampleSelector(float(t)), 0
        for (mesh, above), size in zip(meshes, sizes):
            points = place(mesh.getSchema().getValue(selector).getPositions(), world(above, selector), to)
            if len(points) != size:
                raise FormatError(
                    f"{mesh.getFullName()} has {len(points)} points at {t:g} s and {size} in the first sample;"
                    " export a mesh of constant topology"
                )
            frames[f, first : first + size] = points
            first += size
    moves = len(at) > 1 and not np.allclose(frames, frames[:1], atol=1e-7)
    notes += [f"{len(at)} frames at {rate:g} Hz move the body's vertices"] if moves else []
    joined = np.concatenate(triangles).astype(np.uint32)
    return MovingMesh(frames[0].copy(), joined, None, parts, frames if moves else None, rate, notes)
