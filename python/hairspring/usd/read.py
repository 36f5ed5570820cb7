"""Readers of USD stages."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from pxr import Gf, Tf, Usd, UsdGeom, UsdSkel

from . import material
from ..formats import FACTORS, MAX_POSITIONS, MAX_RATE, MAX_SAMPLES, Curves, FormatError, MovingMesh, as_lengths_and_points, guides_from_flags
from ..shapes import expand, on_curve, triangulate, varying_count

AXIS = {"Y": np.eye(3), "Z": np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])}
"""Rotation of a stage's axes to Y up."""


def open_stage(path: Path) -> Usd.Stage:
    """Opens a stage."""
    try:
        stage = Usd.Stage.Open(str(path))
    except Tf.ErrorException as error:
        raise FormatError(f"the stage cannot be opened ({str(error).splitlines()[-1].strip()})") from None
    if not stage:
        raise FormatError("the stage cannot be opened; check it with `usdchecker`")
    return stage


def space(stage: Usd.Stage, scale: float | None, up: str | None) -> np.ndarray:
    """Matrix [3, 3] from the stage's unit and axes to meters, Y up; for row vectors."""
    meters = scale if scale is not None else UsdGeom.GetStageMetersPerUnit(stage)
    axis = (up or UsdGeom.GetStageUpAxis(stage)).upper()
    return AXIS.get(axis, AXIS["Y"]).T * meters


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
    names, notes = [], []
    found = prims(stage, UsdGeom.BasisCurves)
    if not found:
        raise FormatError("the stage has no visible BasisCurves")
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
        linear, shift = world(prim, time, to)
        length = float(np.cbrt(abs(np.linalg.det(linear))))
        group = len(names)
        names.append(str(prim.GetPath()))
        widths = curves.GetWidthsAttr().Get(time)
        widths = np.array(widths if widths is not None else [], np.float64)
        width_kind = str(curves.GetWidthsInterpolation())
        override, override_kind = primvar(prim, "widths")
        if override is not None:
            widths, width_kind = override, override_kind
        color, color_kind = primvar(prim, "displayColor")
        uv, uv_kind = primvar(prim, "groom_root_uv", "surface_uv_coordinate", "st", "uv")
        ids, _ = primvar(prim, "groom_group_id")
        flags, _ = primvar(prim, "groom_guide")
        closest, _ = primvar(prim, "groom_closest_guides")
        weights, _ = primvar(prim, "groom_guide_weights")
        factors = {name: primvar(prim, name) for name in FACTORS}
        material_radius, stiffer = material.read(prim, widths.size > 0, notes)
        each = np.array([[varying_count(int(n), kind, basis, wrap) for n in counts], counts])
        first = 0
        before = len(strands)
        for s, n in enumerate(counts):
            own = control[first : first + n]
            first += int(n)
            points = on_curve(own, kind, basis, wrap) @ linear + shift
            strands.append(points)
            along = expand(widths, width_kind, s, each, len(points))
            without = np.nan if material_radius is None else material_radius
            parts["radii"].append(np.full(len(points), without) if along is None else 0.5 * length * along)
            along = None if color is None else expand(color, color_kind, s, each, len(points))
            parts["colors"].append(np.full((len(points), 3), np.nan) if along is None else along)
            root = None if uv is None else expand(uv, uv_kind, s, each, max(len(points), 1))
            parts["uvs"].append(np.full(2, np.nan) if root is None else root[0][:2])
            for name, (values, interpolation) in factors.items():
                own = None if values is None else expand(values, interpolation, s, each, max(len(points), 1))
                without = np.nan if stiffer is None or name != "stiffness" else stiffer
                parts[name].append(without if own is None else float(np.mean(own)))
            parts["groups"].append(int(ids[s]) if ids is not None and len(ids) == len(counts) else group)
            parts["flags"].append(bool(flags[s]) if flags is not None and len(flags) == len(counts) else False)
            if closest is not None and weights is not None and len(closest) == len(counts) == len(weights):
                parts["closest"].append(before + np.resize(closest[s], 3))
                parts["weights"].append(np.resize(np.atleast_1d(weights[s]), 3))
    return assemble(strands, parts, names, notes)


def assemble(strands: list[np.ndarray], parts: dict[str, list], names: list[str], notes: list[str]) -> Curves:
    """Joins what was read of each strand."""
    if not strands:
        raise FormatError("the stage has no curves that can be simulated" + (f" ({'; '.join(notes)})" if notes else ""))
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
        total = np.array(parts["weights"], np.float64)
        total /= np.maximum(total.sum(axis=1, keepdims=True), 1e-12)
        curves.guides, curves.guide_weights = np.array(parts["closest"], np.uint32), total.astype(np.float32)
    elif any(parts["flags"]):
        found = guides_from_flags(np.array(parts["flags"]), points[offsets[:-1]])
        if found:
            curves.guides, curves.guide_weights = found
    return curves


def sample_times(stage: Usd.Stage, meshes: list[Usd.Prim]) -> tuple[np.ndarray, float]:
    """The times [time codes] at which any of `meshes` moves, equally spaced, and their rate [Hz]; none if nothing moves.

    They are as close as the closest two samples, but not closer than 1/240 s and not farther than one time code."""
    times: set[float] = set()
    for prim in meshes:
        times.update(UsdGeom.Mesh(prim).GetPointsAttr().GetTimeSamples())
        ancestor = prim
        while ancestor and not ancestor.IsPseudoRoot():
            times.update(UsdGeom.Xformable(ancestor).GetTimeSamples() if ancestor.IsA(UsdGeom.Xformable) else [])
            ancestor = ancestor.GetParent()
    rate = float(stage.GetTimeCodesPerSecond())
    if len(times) < 2:
        return np.zeros(0), rate
    ordered = np.unique(np.round(sorted(times), 6))
    step = max(min(1.0, float(np.diff(ordered).min(initial=1.0))), rate / MAX_RATE)
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
    flat.GetRootLayer().subLayerPaths.append(stage.GetRootLayer().identifier)
    for copy in (flat.SetTimeCodesPerSecond,):
        copy(stage.GetTimeCodesPerSecond())
    UsdGeom.SetStageMetersPerUnit(flat, UsdGeom.GetStageMetersPerUnit(stage))
    UsdGeom.SetStageUpAxis(flat, UsdGeom.GetStageUpAxis(stage))
    for prim in list(flat.Traverse()):
        if prim.IsInstance():
            prim.SetInstanceable(False)
    UsdSkel.BakeSkinning(flat.Traverse())
    return flat


def read_mesh(path: Path, scale: float | None = None, up: str | None = None) -> MovingMesh:
    """Reads all meshes of a stage as one body, with the motion of their vertices: time samples, transforms and skeletons."""
    stage = baked_skins(open_stage(path))
    to = space(stage, scale, up)
    meshes = prims(stage, UsdGeom.Mesh)
    if not meshes:
        raise FormatError("the stage has no visible meshes")
    times, rate = sample_times(stage, meshes)
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
        if counts.min() < 0 or counts.sum() != len(indices) or (len(indices) and indices.max() >= len(points)):
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
            points = np.array(UsdGeom.Mesh(prim).GetPointsAttr().Get(time), np.float64)
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
    whole = [np.concatenate(arrays) if all(a is not None for a in arrays) else None for arrays in (uvs, colors)]
    notes = [f"{len(at)} frames at {rate:g} Hz move the body's vertices"] if moves else []
    joined = np.concatenate(triangles).astype(np.uint32)
    return MovingMesh(frames[0].copy(), joined, whole[0], parts, frames if moves else None, rate, notes, whole[1])


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
