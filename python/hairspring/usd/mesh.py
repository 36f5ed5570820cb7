"""Reader of meshes, skinned or not, that move."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from pxr import Usd, UsdGeom, UsdSkel

from ..formats import MAX_POSITIONS, MAX_RATE, MAX_SAMPLES, AbsentError, FormatError, MovingMesh
from ..shapes import distinct, spacing, triangulate
from .stage import all_prims, because, faults, instancers, left_out, open_stage, primvar, prims, prototypes, quiet, space
from .stage import times_of, world_of

SURFACES = (UsdGeom.NurbsPatch, UsdGeom.Sphere, UsdGeom.Cube, UsdGeom.Cylinder, UsdGeom.Cone, UsdGeom.Capsule, UsdGeom.Plane)
"""Types of surfaces that are not read."""


def sample_times(stage: Usd.Stage, meshes: list[Usd.Prim], notes: list[str]) -> tuple[np.ndarray, float]:
    """The times [time codes] at which any of `meshes` moves, equally spaced, and their rate [Hz]; none if nothing moves.

    They are as close as the closest two samples, but not closer than 1/240 s and not farther than one time code. A note says if
    samples are closer."""
    rate = float(stage.GetTimeCodesPerSecond())
    ordered = distinct(times_of(meshes))
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
    if not all_prims(stage, UsdSkel.Root):
        return stage
    flat = Usd.Stage.CreateInMemory()
    with quiet():
        flat.GetRootLayer().subLayerPaths.append(stage.GetRootLayer().identifier)
    flat.SetTimeCodesPerSecond(stage.GetTimeCodesPerSecond())
    UsdGeom.SetStageMetersPerUnit(flat, UsdGeom.GetStageMetersPerUnit(stage))
    UsdGeom.SetStageUpAxis(flat, UsdGeom.GetStageUpAxis(stage))
    # Instances may hold instances.
    while instances := [prim for prim in flat.Traverse() if prim.IsInstance()]:
        for prim in instances:
            prim.SetInstanceable(False)
    with quiet():
        UsdSkel.BakeSkinning(flat.Traverse())
    return flat


def read_mesh(path: Path, scale: float | None = None, up: str | None = None) -> MovingMesh:
    """Reads all meshes of a stage as one body, with the motion of their vertices: time samples, transforms and skeletons."""
    opened = open_stage(path)
    stage = baked_skins(opened)
    to = space(stage, scale, up)
    meshes = prims(stage, UsdGeom.Mesh)
    broken, notes = faults(opened) + bad_skins(prims(opened, UsdGeom.Mesh)), left_out(stage, UsdGeom.Mesh, SURFACES, "meshes") + unread_instances(stage)
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
        mirrored = np.linalg.det(world_of(prim, at[0], to)[0]) < 0
        if (str(mesh.GetOrientationAttr().Get()) == "leftHanded") != mirrored:
            own = own[:, ::-1]
        sizes.append(len(points))
        triangles.append(own + total)
        parts.append((str(prim.GetPath()), len(own)))
        uvs.append(of_vertices(prim, 2, indices, len(points), notes, "st", "st0", "UVMap", "map1"))
        colors.append(of_vertices(prim, 3, indices, len(points), notes, "displayColor"))
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
            linear, shift = world_of(prim, time, to)
            end = first + size
            frames[f, first:end] = points @ linear + shift
            first = end
    moves = len(at) > 1 and not np.allclose(frames, frames[:1], atol=1e-7)
    notes += [f"{len(at)} frames at {rate:g} Hz move the body's vertices"] if moves else []
    for arrays, name in ((uvs, "texture coordinates"), (colors, "displayColor for each vertex")):
        if 0 < sum(a is not None for a in arrays) < len(arrays):
            notes.append(f"only some meshes have {name}; left out")
    joined = np.concatenate(triangles).astype(np.uint32)
    return MovingMesh(
        frames[0].copy(), joined, together(uvs), parts, frames if moves else None, rate, notes, together(colors)
    )


def bad_skins(meshes: list[Usd.Prim]) -> list[str]:
    """Notes about meshes whose weights cannot be used, so that they stay rigid."""
    notes = []
    for prim in meshes:
        binding = UsdSkel.BindingAPI(prim)
        indices, weights = binding.GetJointIndicesPrimvar(), binding.GetJointWeightsPrimvar()
        if not (indices and indices.HasValue()):
            continue
        own, shares = np.array(indices.ComputeFlattened() or []), np.array((weights and weights.ComputeFlattened()) or [])
        size = max(indices.GetElementSize(), 1)
        vertices = len(UsdGeom.Mesh(prim).GetPointsAttr().Get(Usd.TimeCode.EarliestTime()) or [])
        wanted = size * (1 if indices.GetInterpolation() == "constant" else vertices)
        skeleton = UsdSkel.Skeleton(binding.GetInheritedSkeleton()) if binding.GetInheritedSkeleton() else None
        joints = binding.GetJointsAttr().Get() or (skeleton and skeleton.GetJointsAttr().Get()) or []
        if len(own) != wanted or len(shares) != wanted or (len(joints) and len(own) and not 0 <= own.min() <= own.max() < len(joints)):
            notes.append(f"the joint indices or weights of {prim.GetPath()} do not fit its {vertices} vertices and {len(joints)} joints, so it does not bend")
    return notes


def unread_instances(stage: Usd.Stage) -> list[str]:
    """Notes about instancers of meshes."""
    notes = []
    for prim in instancers(stage):
        below = [p for root in prototypes(prim) if root for p in Usd.PrimRange(root, Usd.PrimAllPrimsPredicate)]
        if any(p.IsA(UsdGeom.Mesh) for p in below):
            count = len(UsdGeom.PointInstancer(prim).GetProtoIndicesAttr().Get(Usd.TimeCode.EarliestTime()) or [])
            notes.append(
                f"{prim.GetPath()} is a PointInstancer: its {count} instances are left out, and only prototypes that are"
                " visible by themselves are read; export the instances as meshes"
            )
    return notes


def together(arrays: list[np.ndarray | None]) -> np.ndarray | None:
    """The arrays as one; None if one is missing."""
    known = [a for a in arrays if a is not None]
    return np.concatenate(known) if len(known) == len(arrays) else None


def of_vertices(
    prim: Usd.Prim, size: int, indices: np.ndarray, vertices: int, notes: list[str], *names: str
) -> np.ndarray | None:
    """The first of these primvars, with `size` numbers for each vertex: those of the first corner that uses it if they differ."""
    values, kind = primvar(prim, *names)
    # One color for the whole mesh, or for each face, is a look.
    if values is None or kind in ("constant", "uniform"):
        return None
    corners = kind == "faceVarying"
    if values.ndim != 2 or values.shape[1] < size or len(values) != (len(indices) if corners else vertices):
        notes.append(f"`{names[0]}` of {prim.GetPath()} does not have {size} numbers for each {'corner' if corners else 'vertex'}; left out")
        return None
    if not corners:
        return values[:, :size].astype(np.float32)
    out = np.zeros((vertices, size), np.float32)
    out[indices[::-1]] = values[::-1, :size]
    return out
