"""Curves that a PointInstancer scatters."""

from __future__ import annotations

import numpy as np
from pxr import Gf, Usd, UsdGeom

from .stage import DRAWN, first_time, instancers, prims, prototypes, world

Place = tuple[np.ndarray, np.ndarray]
"""Linear part and translation of a transform to meters and Y up; for row vectors."""


def placed(stage: Usd.Stage, kind, to: np.ndarray, notes: list[str]) -> list[tuple[Usd.Prim, list[Place] | None]]:
    """All prims of a type that are drawn, with the places of their copies: None for a prim that has only its own."""
    own = [(prim, None) for prim in prims(stage, kind) if not is_below_an_instancer(prim)]
    return own + [pair for prim in instancers(stage) for pair in of_instancer(prim, kind, to, notes)]


def of_instancer(prim: Usd.Prim, kind, to: np.ndarray, notes: list[str]) -> list[tuple[Usd.Prim, list[Place]]]:
    """The prims of a type in the prototypes of an instancer, with the places of their copies at the first time sample."""
    instancer = UsdGeom.PointInstancer(prim)
    roots = prototypes(prim)
    below = [(k, curves) for k, root in enumerate(roots) if root for curves in drawn_below(root, kind)]
    if not below:
        return []
    if is_below_an_instancer(prim):
        notes.append(f"{prim.GetPath()} is a PointInstancer in a prototype of another; left out, so place its instances directly")
        return []
    arrays = (instancer.GetProtoIndicesAttr(), instancer.GetPositionsAttr(), instancer.GetOrientationsAttr(), instancer.GetScalesAttr())
    time = first_time(arrays)
    # Static instances may move with their parents.
    time = Usd.TimeCode.EarliestTime() if time.IsDefault() else time
    indices = np.array(arrays[0].Get(time) or [], np.int64)
    every = UsdGeom.PointInstancer
    transforms = instancer.ComputeInstanceTransformsAtTime(time, time, every.IncludeProtoXform, every.IgnoreMask) or []
    if len(transforms) != len(indices) or np.any((indices < 0) | (indices >= len(roots))):
        notes.append(f"the arrays of {prim.GetPath()} do not have one valid value for each instance; left out")
        return []
    mask = instancer.ComputeMaskAtTime(time) or [True] * len(indices)
    cache, base = UsdGeom.XformCache(time), UsdGeom.Imageable(prim).ComputeLocalToWorldTransform(time)
    found = []
    for k, curves in below:
        within = cache.ComputeRelativeTransform(curves, roots[k])[0]
        chosen = [m for m, index, shown in zip(transforms, indices, mask) if shown and index == k]
        found.append((curves, [world(within * Gf.Matrix4d(m) * base, to) for m in chosen]))
    return found


def drawn_below(root: Usd.Prim, kind) -> list[Usd.Prim]:
    """The prims of a type that a copy of the prototype `root` draws."""

    def shown(prim: Usd.Prim) -> bool:
        while True:
            own = UsdGeom.Imageable(prim)
            if own and own.GetVisibilityAttr().Get(Usd.TimeCode.EarliestTime()) == "invisible":
                return False
            if prim == root:
                return True
            prim = prim.GetParent()

    every = Usd.PrimRange(root, Usd.TraverseInstanceProxies(Usd.PrimAllPrimsPredicate))
    return [p for p in every if p.IsA(kind) and UsdGeom.Imageable(p).ComputePurpose() in DRAWN and shown(p)]


def is_below_an_instancer(prim: Usd.Prim) -> bool:
    """Whether a prim is a child of an instancer, which draws it only as a prototype."""
    parent = prim.GetParent()
    while parent and not parent.IsPseudoRoot():
        if parent.IsA(UsdGeom.PointInstancer):
            return True
        parent = parent.GetParent()
    return False
