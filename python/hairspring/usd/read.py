"""Readers of USD stages."""

from __future__ import annotations

import re
from contextlib import contextmanager
from pathlib import Path
from typing import Iterator

import numpy as np
from pxr import Gf, Tf, Usd, UsdGeom, UsdSkel, UsdUtils

from . import material
from ..formats import FACTORS, MAX_POSITIONS, MAX_RATE, MAX_SAMPLES, Curves, FormatError, MovingMesh, as_lengths_and_points
from ..formats import AbsentError, guides_from_flags
from ..shapes import DEFAULT_RADIUS, check_counts, distinct, expand, fitted, naming, of_strands, on_curve, spacing, triangulate
from ..shapes import varying_count

AXIS = {"Y": np.eye(3), "Z": np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])}
"""Rotation of a stage's axes to Y up."""

KNOWN_PRIMVARS = frozenset(
    (
        *("widths", "normals", "displayColor", "displayOpacity", "st", "uv", "surface_uv_coordinate", "groom_root_uv"),
        *("groom_id", "groom_guide", "groom_group_id", "groom_closest_guides", "groom_guide_weights", *FACTORS),
    )
)
"""Primvars of curves that are read, or that have nothing to do with the simulation."""

SURFACES = (UsdGeom.NurbsPatch, UsdGeom.Sphere, UsdGeom.Cube, UsdGeom.Cylinder, UsdGeom.Cone, UsdGeom.Capsule, UsdGeom.Plane)
"""Types of surfaces that are not read."""


@contextmanager
def quiet() -> Iterator[None]:
    """Keeps the warnings of USD off standard error; readers report what matters as notes."""
    delegate = UsdUtils.CoalescingDiagnosticDelegate()
    try:
        yield
    finally:
        delegate.TakeUncoalescedDiagnostics()
        del delegate


def open_stage(path: Path) -> Usd.Stage:
    """Opens a stage."""
    wrong = FormatError("the stage cannot be opened: the file is damaged or is not USD; check it with `usdchecker`")
    try:
        with quiet():
            stage = Usd.Stage.Open(str(path))
    except Tf.ErrorException:
        raise wrong from None
    if not stage:
        raise wrong
    return stage


def used_files(path: str | Path) -> list[str]:
    """Returns the layers and other files that a stage consists of. What is missing is left out."""
    with quiet():
        layers, assets, _ = UsdUtils.ComputeAllDependencies(str(path))
    found = [layer.realPath for layer in layers] + list(assets)
    # A file in an archive has brackets after the name of the archive.
    return sorted({file for file in found if Path(file).is_file()})


def faults(stage: Usd.Stage) -> list[str]:
    """Notes about what the stage names and cannot be composed, such as missing files: each once."""
    notes = []
    for error in stage.GetCompositionErrors():
        text = str(error).strip().splitlines()[0]
        missing = re.match(r"Could not (?:open asset|load sublayer) @([^@]*)@", text)
        by = re.search(r"(?:introduced by|of layer) @([^@]*)@", text)
        if missing:
            user = f", which {Path(by[1]).name} uses," if by else ""
            notes.append(f"{missing[1]}{user} is missing or cannot be read; what it holds is left out")
        else:
            notes.append(f"the stage has a fault of composition, and what it names is left out: {text.replace('@', '')}")
    return list(dict.fromkeys(notes))


def space(stage: Usd.Stage, scale: float | None, up: str | None) -> np.ndarray:
    """Matrix [3, 3] from the stage's unit and axes to meters, Y up; for row vectors."""
    meters = scale if scale is not None else UsdGeom.GetStageMetersPerUnit(stage)
    if not (np.isfinite(meters) and meters > 0):
        raise FormatError(f"the stage has metersPerUnit = {meters:g}; set it to more than 0, or give `scale`")
    axis = (up or str(UsdGeom.GetStageUpAxis(stage))).upper()
    if axis not in AXIS:
        raise FormatError(f"the stage has upAxis = {axis}; set it to Y or Z, or give `up`")
    return AXIS[axis].T * meters


def prims(stage: Usd.Stage, kind) -> list[Usd.Prim]:
    """All prims of a type that are drawn, those of instances included."""
    found = []
    for prim in Usd.PrimRange.Stage(stage, Usd.TraverseInstanceProxies()):
        if not prim.IsA(kind):
            continue
        image = UsdGeom.Imageable(prim)
        purpose = image.ComputePurpose()
        if purpose in ("default", "render") and image.ComputeVisibility() != "invisible":
            found.append(prim)
    return found


def left_out(stage: Usd.Stage, kind, others: tuple, into: str) -> list[str]:
    """Notes about visible prims of the types `others`, which are not read, and instancers of prims of the type `kind`."""
    notes = []
    for other in others:
        names = [str(prim.GetPath()) for prim in prims(stage, other)]
        if names:
            notes.append(f"{other.__name__} prims are left out ({naming(names)}); convert them to {into}")
    for prim in prims(stage, UsdGeom.PointInstancer):
        instancer = UsdGeom.PointInstancer(prim)
        prototypes = [stage.GetPrimAtPath(target) for target in instancer.GetPrototypesRel().GetForwardedTargets()]
        below = [p for root in prototypes if root for p in Usd.PrimRange(root, Usd.PrimAllPrimsPredicate)]
        if any(p.IsA(kind) for p in below):
            count = len(instancer.GetProtoIndicesAttr().Get(Usd.TimeCode.EarliestTime()) or [])
            notes.append(
                f"{prim.GetPath()} is a PointInstancer: its {count} instances are left out, and only prototypes that are"
                f" visible by themselves are read; export the instances as {into}"
            )
    return notes


def unused_primvars(found: list[Usd.Prim]) -> list[str]:
    """A note about primvars of curves that are not read. Those with a namespace belong to renderers."""
    authored = (own for prim in found for own in UsdGeom.PrimvarsAPI(prim).GetPrimvarsWithAuthoredValues())
    every = {str(own.GetPrimvarName()) for own in authored}
    names = sorted(name for name in every - KNOWN_PRIMVARS if ":" not in name)
    return [f"primvars of curves that are not used: {naming(names)}"] if names else []


def first_time(attributes: list[Usd.Attribute]) -> Usd.TimeCode:
    """The first time sample of any attribute; the default time without any."""
    times = [t for a in attributes if a for t in a.GetTimeSamples()[:1]]
    return Usd.TimeCode(min(times)) if times else Usd.TimeCode.Default()


def world(prim: Usd.Prim, time: Usd.TimeCode, to: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Linear part and translation of a prim's transform, to meters and Y up; for row vectors."""
    m = np.array(UsdGeom.Imageable(prim).ComputeLocalToWorldTransform(time))
    return m[:3, :3] @ to, m[3, :3] @ to


def primvar(prim: Usd.Prim, *names: str):
    """The first of these primvars that has a value, and its interpolation."""
    api = UsdGeom.PrimvarsAPI(prim)
    for name in names:
        found = api.GetPrimvar(name)
        if found and found.HasValue():
            value = found.ComputeFlattened(first_time([found.GetAttr()]))
            if value is not None:
                return np.atleast_1d(np.array(value)), str(found.GetInterpolation())
    return None, ""


def read_curves(path: Path, scale: float | None = None, up: str | None = None) -> Curves:
    """Reads all BasisCurves of a stage as one groom, at their first time sample.

    Each prim becomes a group with the name of its path, unless `groom_group_id` gives the groups. Widths, `displayColor`,
    root UVs (`groom_root_uv`, `surface_uv_coordinate`, `st`), factors of the material (`stiffness`, `damping`, `drag`), guides (`groom_guide`, `groom_closest_guides`,
    `groom_guide_weights`) are read in every interpolation.
    """
    stage = open_stage(path)
    to = space(stage, scale, up)
    strands: list[np.ndarray] = []
    parts: dict[str, list] = {name: [] for name in ("radii", "groups", "uvs", "colors", "flags", "closest", "weights", *FACTORS)}
    names: list[str] = []
    notes = faults(stage) + left_out(stage, UsdGeom.BasisCurves, (UsdGeom.NurbsCurves, UsdGeom.HermiteCurves), "BasisCurves")
    found = prims(stage, UsdGeom.BasisCurves)
    if not found:
        raise AbsentError("the stage has no visible BasisCurves" + because(notes))
    notes += unused_primvars(found)
    for prim in found:
        curves = UsdGeom.BasisCurves(prim)
        time = first_time([curves.GetPointsAttr(), curves.GetCurveVertexCountsAttr()])
        control, counts = curves.GetPointsAttr().Get(time), curves.GetCurveVertexCountsAttr().Get(time)
        if not control or not counts:
            notes.append(f"{prim.GetPath()} has no points; left out")
            continue
        control, counts = np.array(control, np.float64), np.array(counts)
        kind, basis, wrap = (str(a.Get(time)) for a in (curves.GetTypeAttr(), curves.GetBasisAttr(), curves.GetWrapAttr()))
        if counts.sum() != len(control) or counts.min() < 0:
            raise FormatError(f"{prim.GetPath()} has {len(control)} points, and its curveVertexCounts name {counts.sum()}")
        if wrap == "periodic":
            notes.append(f"{prim.GetPath()} has closed curves; left out")
            continue
        if kind == "cubic" and basis not in ("bezier", "bspline", "catmullRom"):
            raise FormatError(f"{prim.GetPath()} has the basis '{basis}'; bezier, bspline and catmullRom are read")
        check_counts(str(prim.GetPath()), counts, kind, basis)
        linear, shift = world(prim, time, to)
        length = float(np.cbrt(abs(np.linalg.det(linear))))
        group = len(names)
        names.append(str(prim.GetPath()))
        each = np.array([[varying_count(int(n), kind, basis, wrap) for n in counts], counts])
        what = lambda name: f"`{name}` of {prim.GetPath()}"
        widths, width_kind = widths_of(curves, time)
        widths, width_kind = fitted(widths, width_kind, each, what("widths"), notes, instead=DEFAULT_RADIUS)

        def fit(size: int, *read: str) -> tuple[np.ndarray | None, str]:
            values, interpolation = primvar(prim, *read)
            return fitted(values, interpolation, each, what(read[0]), notes, size)

        color, color_kind = fit(3, "displayColor")
        uv, uv_kind = fit(2, "groom_root_uv", "surface_uv_coordinate", "st", "uv")
        factors = {name: fit(1, name) for name in FACTORS}
        one = lambda name: of_strands(primvar(prim, name)[0], len(counts), what(name), notes)
        three = lambda name: of_strands(rows(primvar(prim, name)[0], len(counts)), len(counts), what(name), notes)
        ids, flags = one("groom_group_id"), one("groom_guide")
        closest, weights = three("groom_closest_guides"), three("groom_guide_weights")
        material_radius, stiffer = material.read(prim, widths is not None, notes)
        first = 0
        before = len(strands)
        for s, n in enumerate(counts):
            own = control[first : first + n]
            first += int(n)
            points = on_curve(own, kind, basis, wrap) @ linear + shift
            strands.append(points)
            along = None if widths is None else expand(widths, width_kind, s, each, len(points))
            without = np.nan if material_radius is None else material_radius
            parts["radii"].append(np.full(len(points), without) if along is None else 0.5 * length * along)
            shade = None if color is None else expand(color, color_kind, s, each, len(points))
            parts["colors"].append(np.full((len(points), 3), np.nan) if shade is None else shade[:, :3])
            root = None if uv is None else expand(uv, uv_kind, s, each, max(len(points), 1))
            parts["uvs"].append(np.full(2, np.nan) if root is None else root[0][:2])
            for name, (values, interpolation) in factors.items():
                factor = None if values is None else expand(values, interpolation, s, each, max(len(points), 1))
                without = np.nan if stiffer is None or name != "stiffness" else stiffer
                parts[name].append(without if factor is None else float(np.mean(factor)))
            parts["groups"].append(int(np.ravel(ids[s])[0]) if ids is not None else group)
            parts["flags"].append(bool(np.any(flags[s])) if flags is not None else False)
            if closest is not None and weights is not None:
                parts["closest"].append(before + np.resize(closest[s], 3).astype(np.int64))
                parts["weights"].append(np.resize(np.atleast_1d(weights[s]), 3))
    return assemble(strands, parts, names, notes)


def because(notes: list[str]) -> str:
    """What notes say about the cause of an error, in brackets."""
    return f" ({'; '.join(notes)})" if notes else ""


def widths_of(curves: UsdGeom.BasisCurves, time: Usd.TimeCode) -> tuple[np.ndarray | None, str]:
    """The widths of curves and their interpolation. The primvar counts before the attribute."""
    values, kind = primvar(curves.GetPrim(), "widths")
    if values is not None:
        return values.astype(np.float64), kind
    own = curves.GetWidthsAttr().Get(time)
    return None if own is None else np.array(own, np.float64), str(curves.GetWidthsInterpolation())


def rows(values: np.ndarray | None, strands: int) -> np.ndarray | None:
    """Values of strands, three numbers to a row if there are three for each strand."""
    if values is not None and values.ndim == 1 and len(values) == 3 * strands and strands > 0:
        return values.reshape(strands, 3)
    return values


def assemble(strands: list[np.ndarray], parts: dict[str, list], names: list[str], notes: list[str]) -> Curves:
    """Joins what was read of each strand."""
    if not strands:
        raise AbsentError("the stage has no curves that can be simulated" + because(notes))
    points, offsets = as_lengths_and_points(strands)
    curves = Curves(points, offsets, notes=notes, group_names=names)
    radii, colors = np.concatenate(parts["radii"]), np.concatenate(parts["colors"])
    if np.isfinite(radii).any():
        curves.radii = np.where(np.isfinite(radii), radii, np.nanmedian(radii)).astype(np.float32)
    for kept, name in ((np.isfinite(colors).all(), "displayColor"), (not np.isfinite(colors).any(), "")):
        if kept and name:
            curves.colors = np.clip(colors, 0, 1).astype(np.float32)
    if np.isfinite(colors).any() and curves.colors is None:
        notes.append("only some curves have displayColor; left out")
    uvs = np.array(parts["uvs"])
    if np.isfinite(uvs).all():
        curves.root_uvs = uvs.astype(np.float32)
    groups = np.array(parts["groups"])
    if groups.min() < 0 or groups.max() > 65535:
        notes.append("groom_group_id is not from 0 to 65535; left out")
    elif groups.max() > 0 or len(names) == 1:
        curves.groups = groups.astype(np.uint32)
    for name in FACTORS:
        values = np.array(parts[name])
        if np.isfinite(values).any():
            curves.factors[name] = np.where(np.isfinite(values), np.maximum(values, 0), 1).astype(np.float32)
    if len(parts["closest"]) == len(strands):
        closest, total = np.array(parts["closest"]), np.array(parts["weights"], np.float64)
        total /= np.maximum(total.sum(axis=1, keepdims=True), 1e-12)
        if closest.min() >= 0 and closest.max() < len(strands):
            curves.guides, curves.guide_weights = closest.astype(np.uint32), total.astype(np.float32)
        else:
            notes.append("`groom_closest_guides` names strands that do not exist; left out")
    if curves.guides is None and any(parts["flags"]):
        found = guides_from_flags(np.array(parts["flags"]), points[offsets[:-1]])
        if found:
            curves.guides, curves.guide_weights = found
    return curves


def sample_times(stage: Usd.Stage, meshes: list[Usd.Prim], notes: list[str]) -> tuple[np.ndarray, float]:
    """The times [time codes] at which any of `meshes` moves, equally spaced, and their rate [Hz]; none if nothing moves.

    They are as close as the closest two samples, but not closer than 1/240 s and not farther than one time code. A note says if
    samples are closer."""
    times: set[float] = set()
    for prim in meshes:
        times.update(UsdGeom.Mesh(prim).GetPointsAttr().GetTimeSamples())
        ancestor = prim
        while ancestor and not ancestor.IsPseudoRoot():
            times.update(UsdGeom.Xformable(ancestor).GetTimeSamples() if ancestor.IsA(UsdGeom.Xformable) else [])
            ancestor = ancestor.GetParent()
    rate = float(stage.GetTimeCodesPerSecond())
    ordered = distinct(times)
    if len(ordered) < 2:
        return np.zeros(0), rate
    if not (np.isfinite(rate) and rate > 0):
        raise FormatError(f"the stage has timeCodesPerSecond = {rate:g}, so its meshes move at no speed; set it to more than 0")
    closest = spacing(ordered)
    if closest < 0.99 * rate / MAX_RATE:
        notes.append(f"samples of the meshes are closer than 1/{MAX_RATE:g} s; their motion is sampled at {MAX_RATE:g} Hz")
    step = max(min(1.0, closest), rate / MAX_RATE)
    first = np.floor(ordered[0]) if step == 1.0 else ordered[0]
    steps = (ordered[-1] - first) / step
    if abs(steps - round(steps)) < 0.01 and round(steps) > 0:
        # Written times are rounded.
        step, steps = (ordered[-1] - first) / round(steps), round(steps)
    count = int(np.ceil(steps)) + 1
    if not np.isfinite(steps) or count > MAX_SAMPLES:
        raise FormatError(f"the samples of the meshes span {count} frames; the limit is {MAX_SAMPLES}, so shorten the motion")
    return first + step * np.arange(count), rate / step


def baked_skins(stage: Usd.Stage) -> Usd.Stage:
    """The stage with its skinned meshes as time-sampled points, in a layer in memory."""
    if not any(prim.IsA(UsdSkel.Root) for prim in stage.Traverse()):
        return stage
    flat = Usd.Stage.CreateInMemory()
    with quiet():
        flat.GetRootLayer().subLayerPaths.append(stage.GetRootLayer().identifier)
    flat.SetTimeCodesPerSecond(stage.GetTimeCodesPerSecond())
    UsdGeom.SetStageMetersPerUnit(flat, UsdGeom.GetStageMetersPerUnit(stage))
    UsdGeom.SetStageUpAxis(flat, UsdGeom.GetStageUpAxis(stage))
    for prim in list(flat.Traverse()):
        if prim.IsInstance():
            prim.SetInstanceable(False)
    UsdSkel.BakeSkinning(flat.Traverse())
    return flat


def read_mesh(path: Path, scale: float | None = None, up: str | None = None) -> MovingMesh:
    """Reads all meshes of a stage as one body, with the motion of their vertices: time samples, transforms and skeletons."""
    opened = open_stage(path)
    stage = baked_skins(opened)
    to = space(stage, scale, up)
    meshes = prims(stage, UsdGeom.Mesh)
    broken, notes = faults(opened), left_out(stage, UsdGeom.Mesh, SURFACES, "meshes")
    if not meshes:
        # The reader of curves reports files that are missing.
        known = prims(stage, UsdGeom.BasisCurves)
        raise AbsentError("the stage has no visible meshes" + because(notes if known else broken + notes))
    notes = broken + notes
    times, rate = sample_times(stage, meshes, notes)
    at = [Usd.TimeCode(float(t)) for t in times] or [Usd.TimeCode.EarliestTime()]
    triangles, parts, uvs, colors, sizes, total = [], [], [], [], [], 0
    for prim in meshes:
        mesh = UsdGeom.Mesh(prim)
        topology = [mesh.GetFaceVertexCountsAttr(), mesh.GetFaceVertexIndicesAttr()]
        if any(a.Get(t) != a.Get(at[0]) for a in topology for t in a.GetTimeSamples()):
            raise FormatError(f"the topology of {prim.GetPath()} changes over time; export a mesh of constant topology")
        points = mesh.GetPointsAttr().Get(at[0])
        counts, indices = (np.array(a.Get(at[0]) or [], np.int64) for a in topology)
        if points is None or not len(counts):
            raise FormatError(f"{prim.GetPath()} has no faces or no points")
        if counts.min() < 0 or counts.sum() != len(indices) or np.any((indices < 0) | (indices >= len(points))):
            raise FormatError(f"the faces of {prim.GetPath()} name vertices that do not exist")
        own = triangulate(counts, indices, np.array(points, np.float64))
        mirrored = np.linalg.det(world(prim, at[0], to)[0]) < 0
        if (str(mesh.GetOrientationAttr().Get()) == "leftHanded") != mirrored:
            own = own[:, ::-1]
        sizes.append(len(points))
        triangles.append(own + total)
        parts.append((str(prim.GetPath()), len(own)))
        uvs.append(of_vertices(prim, 2, indices, len(points), "st", "st0", "UVMap", "map1"))
        colors.append(of_vertices(prim, 3, indices, len(points), "displayColor"))
        total += len(points)
    if len(at) * total > MAX_POSITIONS:
        raise FormatError(f"the motion holds more than {MAX_POSITIONS} positions; shorten it")
    frames = np.empty((len(at), total, 3), np.float32)
    for f, time in enumerate(at):
        first = 0
        for prim, size in zip(meshes, sizes):
            points = np.array(UsdGeom.Mesh(prim).GetPointsAttr().Get(time) or np.zeros((0, 3)), np.float64)
            if len(points) != size:
                raise FormatError(
                    f"{prim.GetPath()} has {len(points)} points at time {time.GetValue():g} and {size} in the first sample;"
                    " export a mesh of constant topology"
                )
            linear, shift = world(prim, time, to)
            end = first + size
            frames[f, first:end] = points @ linear + shift
            first = end
    moves = len(at) > 1 and not np.allclose(frames, frames[:1], atol=1e-7)
    notes += [f"{len(at)} frames at {rate:g} Hz move the body's vertices"] if moves else []
    joined = np.concatenate(triangles).astype(np.uint32)
    return MovingMesh(
        frames[0].copy(), joined, together(uvs), parts, frames if moves else None, rate, notes, together(colors)
    )


def together(arrays: list[np.ndarray | None]) -> np.ndarray | None:
    """The arrays as one; None if one is missing."""
    known = [a for a in arrays if a is not None]
    return np.concatenate(known) if len(known) == len(arrays) else None


def of_vertices(prim: Usd.Prim, size: int, indices: np.ndarray, vertices: int, *names: str) -> np.ndarray | None:
    """The first of these primvars, with `size` numbers for each vertex: those of the first corner that uses it if they differ."""
    values, kind = primvar(prim, *names)
    if values is None or values.ndim != 2 or values.shape[1] < size:
        return None
    if kind in ("vertex", "varying") and len(values) == vertices:
        return values[:, :size].astype(np.float32)
    if kind != "faceVarying" or len(values) != len(indices):
        return None
    out = np.zeros((vertices, size), np.float32)
    out[indices[::-1]] = values[::-1, :size]
    return out


def read_cameras(path: Path, scale: float | None = None, up: str | None = None) -> dict[str, list[dict]]:
    """Reads all cameras: for each path, a list with one dict for each time sample.

    A dict holds `time` [time codes], `position` and `target` (3,) [m], and `fov`, the vertical field of view [degrees].
    """
    stage = open_stage(path)
    to = space(stage, scale, up)
    cameras: dict[str, list[dict]] = {}
    for prim in prims(stage, UsdGeom.Camera):
        times = UsdGeom.Xformable(prim).GetTimeSamples() or [None]
        samples = []
        for t in times:
            time = Usd.TimeCode.Default() if t is None else Usd.TimeCode(t)
            linear, shift = world(prim, time, to)
            lens: Gf.Camera = UsdGeom.Camera(prim).GetCamera(time)
            look = -linear[2] / np.linalg.norm(linear[2])
            fov = lens.GetFieldOfView(Gf.Camera.FOVVertical)
            samples.append({"time": t, "position": shift, "target": shift + look, "fov": float(fov)})
        cameras[str(prim.GetPath())] = samples
    return cameras
