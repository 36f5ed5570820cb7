"""Reader of BasisCurves."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from pxr import Usd, UsdGeom, UsdSkel

from . import material
from ..formats import FACTORS, MAX_POSITIONS, AbsentError, Curves, FormatError, as_lengths_and_points, guides_from_flags
from ..shapes import DEFAULT_RADIUS, check_counts, expand, fitted, of_strands, on_curve, unplayed, varying_count
from .instances import placed
from .stage import because, faults, first_time, left_out, open_stage, primvar, space, times_of, unused_primvars, world_of

PARTS = ("radii", "groups", "uvs", "colors", "objects", "flags", "closest", "weights")
"""What is read of each strand, besides its factors of the material."""


def read_curves(path: Path, scale: float | None = None, up: str | None = None) -> Curves:
    """Reads all BasisCurves of a stage as one groom, at their first time sample. A PointInstancer gives a copy for each instance.

    Each prim becomes a group with the name of its path, unless `groom_group_id` gives the groups. Widths, `displayColor`,
    root UVs (`groom_root_uv`, `surface_uv_coordinate`, `st`), factors of the material (those of `FACTORS`), guides (`groom_guide`, `groom_closest_guides`,
    `groom_guide_weights`) are read in every interpolation.
    """
    stage = open_stage(path)
    to = space(stage, scale, up)
    strands: list[np.ndarray] = []
    parts: dict[str, list] = {name: [] for name in (*PARTS, *FACTORS)}
    names: list[str] = []
    notes = faults(stage) + left_out(stage, UsdGeom.BasisCurves, (UsdGeom.NurbsCurves, UsdGeom.HermiteCurves), "BasisCurves")
    found = placed(stage, UsdGeom.BasisCurves, to, notes)
    if not found:
        raise AbsentError("the stage has no visible BasisCurves" + because(notes))
    notes += unused_primvars([prim for prim, _ in found]) + unplayed(times_of([prim for prim, _ in found]))
    total = 0
    for prim, places in found:
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
        # Static curves may move with their parents.
        at = Usd.TimeCode.EarliestTime() if time.IsDefault() else time
        places = [world_of(prim, at, to)] if places is None else places
        if prim.HasAPI(UsdSkel.BindingAPI):
            notes.append(f"{prim.GetPath()} is bound to a skeleton, which is not used: its roots follow the body")
        total += len(control) * len(places)
        if total > MAX_POSITIONS:
            raise FormatError(f"the curves and their instances have more than {MAX_POSITIONS} points; export fewer")
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
        for linear, shift in places:
            first = 0
            before = len(strands)
            length = float(np.cbrt(abs(np.linalg.det(linear))))
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
                parts["groups"].append(float(np.ravel(ids[s])[0]) if ids is not None else group)
                parts["objects"].append(group)
                parts["flags"].append(bool(np.any(flags[s])) if flags is not None else False)
                if closest is not None and weights is not None:
                    own, shares = np.ravel(closest[s])[:3], np.ravel(weights[s])[:3]
                    # Fewer than three guides: the others have no weight.
                    parts["closest"].append(before + np.append(own, np.repeat(own[:1], 3 - len(own))).astype(np.int64))
                    parts["weights"].append(np.append(shares, np.zeros(3 - len(shares))))
    return assemble(strands, parts, names, notes)


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
    groups = np.array(parts["groups"], np.float64)
    if not np.isfinite(groups).all() or groups.min() < 0 or groups.max() > 65535:
        notes.append("groom_group_id is not from 0 to 65535; left out")
    elif groups.max() > 0 or len(names) == 1:
        curves.groups = groups.astype(np.uint32)
    for name in FACTORS:
        values = np.array(parts[name])
        if np.isfinite(values).any():
            curves.factors[name] = np.where(np.isfinite(values), np.maximum(values, 0), 1).astype(np.float32)
    if len(parts["closest"]) == len(strands):
        closest, total = np.array(parts["closest"]), np.array(parts["weights"], np.float64)
        if not np.isfinite(total).all() or total.min() < 0 or total.sum(axis=1).min() <= 0:
            notes.append("`groom_guide_weights` are not finite, below 0 or all 0; left out, with the guides")
        elif closest.min() >= 0 and closest.max() < len(strands):
            total /= total.sum(axis=1, keepdims=True)
            curves.guides, curves.guide_weights = closest.astype(np.uint32), total.astype(np.float32)
        else:
            notes.append("`groom_closest_guides` names strands that do not exist; left out")
    if curves.guides is None and any(parts["flags"]):
        found = guides_from_flags(np.array(parts["flags"]), points[offsets[:-1]], np.array(parts["objects"]))
        if found:
            curves.guides, curves.guide_weights = found
    return curves
