"""Writer of moving strands as BasisCurves."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
from pxr import Gf, Kind, Sdf, Tf, Usd, UsdGeom, Vt

from ..description import Description, MovingGroom, identifier, publish
from . import material
from .instances import is_below_an_instancer
from .stage import open_stage, quiet, space, world_of

DEFORMABLE = "PhysicsCurvesDeformableSimAPI"
"""The applied schema of curves that a simulation deforms (AOUSD proposal "Deformable Body Physics", curves)."""


class CurvesWriter:
    """Writes strands that move to one USD file, in meters, Y up, with one time code for each frame.

    Each groom becomes a linear, nonperiodic BasisCurves below `/Hair` with `points`, `velocities` and `extent` over time;
    `widths`; and the primvars `groom_id`, `groom_group_id`, `groom_guide` and, if the groom has them, `groom_root_uv`, `st`,
    `displayColor`, `groom_closest_guides` and `groom_guide_weights`. `physics:restShapePoints` is the groom at rest, and a
    physics material beside the curves has the constants of the hair's first material.

    With `over`, the file is an animated layer over that stage: it has the stage as a sublayer, and overrides the curves that the
    grooms were read from, in their own space.

    The file appears under its name when `finish` returns.
    """

    def __init__(self, path: str | os.PathLike, description: Description, over: str | os.PathLike | None = None):
        self.path, self.description = Path(path), description
        if self.path.suffix.lower() == ".usdz":
            raise ValueError("a .usdz package cannot be written frame by frame; write .usdc and package it with `usdzip`")
        self.pending = self.path.with_name(f".hairspring-{os.getpid()}-{self.path.name}")
        try:
            with quiet():
                self.layer = Sdf.Layer.CreateNew(str(self.pending))
        except Tf.ErrorException:
            self.layer = None
        if not self.layer:
            self.pending.unlink(missing_ok=True)
            raise OSError("the file cannot be created; check that its folder exists and that you may write there")
        self.stage = Usd.Stage.Open(self.layer)
        # Curves, their points, and the prim in whose space they are, if that is not the space of the file.
        self.targets: list[tuple[UsdGeom.BasisCurves, slice, Usd.Prim | None]] = []
        # The stage below the layer, and the matrix from its unit and axes to meters and Y up.
        self.base: Usd.Stage | None = None
        self.to = np.eye(3)
        self.margin: dict[str, float] = {}
        try:
            self._begin(over)
        except BaseException:
            self.discard()
            raise

    def _begin(self, over) -> None:
        stage, description = self.stage, self.description
        if over is None:
            UsdGeom.SetStageMetersPerUnit(stage, 1.0)
            UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
            root = UsdGeom.Xform.Define(stage, "/Hair")
            stage.SetDefaultPrim(root.GetPrim())
            Usd.ModelAPI(root.GetPrim()).SetKind(Kind.Tokens.component)
            self._define_all()
        else:
            self._override_all(Path(over))
        stage.SetTimeCodesPerSecond(description.fps)
        stage.SetFramesPerSecond(description.fps)
        stage.SetStartTimeCode(description.first_frame)
        stage.SetEndTimeCode(description.last_frame)
        if description.source:
            self.layer.comment = f"Simulated by Hairspring from {description.source}"

    def _define_all(self) -> None:
        taken: set[str] = set()
        first = 0
        for groom in self.description.grooms:
            curves = UsdGeom.BasisCurves.Define(self.stage, f"/Hair/{identifier(groom.name, taken)}")
            self._describe(curves, groom, slice(0, len(groom.counts)), np.eye(3), np.zeros(3), complete=True)
            self.targets.append((curves, slice(first, first + len(groom.points)), None))
            first += len(groom.points)

    def _override_all(self, over: Path) -> None:
        base = self.base = open_stage(over)
        self._check_time(over)
        UsdGeom.SetStageMetersPerUnit(self.stage, UsdGeom.GetStageMetersPerUnit(base))
        UsdGeom.SetStageUpAxis(self.stage, UsdGeom.GetStageUpAxis(base))
        self.layer.subLayerPaths.append(os.path.relpath(over, self.path.parent))
        if base.HasDefaultPrim():
            self.layer.defaultPrim = base.GetDefaultPrim().GetName()
        self.to = space(base, None, None)
        first = 0
        for groom in self.description.grooms:
            for prim, own in curves_of(groom, base, over):
                back, shift = self._own_space(prim, Usd.TimeCode.EarliestTime())
                check_size(prim, groom.points[groom.offsets[own]], np.linalg.inv(back), over)
                curves = UsdGeom.BasisCurves(self.stage.OverridePrim(prim.GetPath()))
                points = slice(first + int(groom.offsets[own.start]), first + int(groom.offsets[own.stop]))
                block_attributes(curves, UsdGeom.BasisCurves(prim), points.stop - points.start)
                self._describe(curves, groom, own, back, shift, complete=False)
                self.targets.append((curves, points, prim))
            first += len(groom.points)
        if not self.targets:
            raise ValueError(f"none of the grooms was read from {over}")

    def _check_time(self, over: Path) -> None:
        """Refuses a layer whose frames are not those of the stage, so that hair and body would move at different times."""
        base, wanted = self.base, self.description
        rate = base.GetTimeCodesPerSecond()
        if not base.HasAuthoredTimeCodeRange() or base.GetStartTimeCode() >= base.GetEndTimeCode():
            return
        if abs(rate - wanted.fps) > 1e-3 * rate:
            raise ValueError(f"{over} has {rate:g} frames a second and the bake {wanted.fps:g}; bake with --fps {rate:g}")
        if not base.GetStartTimeCode() <= wanted.first_frame <= base.GetEndTimeCode():
            begin, end = base.GetStartTimeCode(), base.GetEndTimeCode()
            raise ValueError(
                f"{over} moves in the frames {begin:g} to {end:g}, and the bake begins at {wanted.first_frame:g}; bake with"
                f" --start {begin:g} --frames {begin:g}-{end:g}"
            )

    def _own_space(self, prim: Usd.Prim, time: Usd.TimeCode) -> tuple[np.ndarray, np.ndarray]:
        """The matrix from meters and Y up to the space of a prim at a time, and the translation before it."""
        linear, shift = world_of(prim, time, self.to)
        if abs(np.linalg.det(linear)) < 1e-12:
            raise ValueError(f"{prim.GetPath()} is scaled to 0, so its curves have no size; give it another scale")
        return np.linalg.inv(linear), shift

    def _describe(self, curves, groom: MovingGroom, own: slice, back, shift, complete: bool) -> None:
        """Writes what does not change."""
        points = slice(int(groom.offsets[own.start]), int(groom.offsets[own.stop]))
        counts = groom.counts[own]
        curves.CreateTypeAttr(UsdGeom.Tokens.linear)
        curves.CreateWrapAttr(UsdGeom.Tokens.nonperiodic)
        curves.CreateCurveVertexCountsAttr(Vt.IntArray.FromNumpy(counts.astype(np.int32)))
        size = float(np.cbrt(abs(np.linalg.det(back))))
        widths = (2 * size * groom.radii[points]).astype(np.float32)
        self.margin[str(curves.GetPath())] = 0.5 * float(widths.max())
        curves.CreateWidthsAttr(Vt.FloatArray.FromNumpy(widths))
        curves.SetWidthsInterpolation(UsdGeom.Tokens.vertex)
        prim = curves.GetPrim()
        prim.AddAppliedSchema(DEFORMABLE)
        rest = ((groom.points[points].astype(np.float64) - shift) @ back).astype(np.float32)
        attribute = prim.CreateAttribute("physics:restShapePoints", Sdf.ValueTypeNames.Point3fArray, False)
        attribute.Set(Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(rest)))
        if groom.materials:
            self._bind_materials(curves, groom, own)
        api, types = UsdGeom.PrimvarsAPI(prim), Sdf.ValueTypeNames

        def primvar(name, kind, values, interpolation=UsdGeom.Tokens.uniform, size=-1):
            api.CreatePrimvar(name, kind, interpolation, size).Set(values)

        ints = lambda a: Vt.IntArray.FromNumpy(np.ascontiguousarray(a, np.int32))
        primvar("groom_id", types.IntArray, ints(np.arange(own.start, own.stop)))
        primvar("groom_guide", types.IntArray, ints(groom.guide[own]))
        if groom.groups is not None:
            primvar("groom_group_id", types.IntArray, ints(groom.groups[own]))
        if groom.root_uvs is not None and complete:
            uvs = Vt.Vec2fArray.FromNumpy(np.ascontiguousarray(groom.root_uvs[own], np.float32))
            primvar("groom_root_uv", types.TexCoord2fArray, uvs)
            primvar("st", types.TexCoord2fArray, uvs)
        if groom.colors is not None and complete:
            colors = Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(groom.colors[points], np.float32))
            primvar("displayColor", types.Color3fArray, colors, UsdGeom.Tokens.vertex)
        if groom.guides is not None and groom.guide_weights is not None and complete:
            closest = Vt.Vec3iArray.FromNumpy(np.ascontiguousarray(groom.guides[own], np.int32))
            weights = Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(groom.guide_weights[own], np.float32))
            primvar("groom_closest_guides", types.Int3Array, closest)
            primvar("groom_guide_weights", types.Float3Array, weights)

    def _bind_materials(self, curves: UsdGeom.BasisCurves, groom: MovingGroom, own: slice) -> None:
        """Binds the physics material of the first group to the curves. Where there are several groups, each has a material
        bind subset of its own segments."""
        path, n = curves.GetPath().GetParentPath().AppendChild(f"{curves.GetPrim().GetName()}_physics"), 2
        while self.base and self.base.GetPrimAtPath(path):
            path, n = path.ReplaceName(f"{curves.GetPrim().GetName()}_physics_{n}"), n + 1
        groups = groom.groups[own] if groom.groups is not None else np.zeros(own.stop - own.start, int)
        used = np.unique(groups)
        radii = groom.radii[int(groom.offsets[own.start]) : int(groom.offsets[own.stop])]
        of_point = np.repeat(groups, groom.counts[own])
        taken: set[str] = set()
        for group in used:
            settings = groom.materials[min(int(group), len(groom.materials) - 1)]
            radius = float(radii[of_point == group].mean())
            if group == used[0]:
                material.write(curves, path, settings, radius)
            else:
                name = groom.group_names[group] if group < len(groom.group_names) else f"group_{group}"
                name = identifier(name.rsplit("/", 1)[-1], taken)
                strands = np.flatnonzero(groups == group)
                subset = material.subset(curves, name, strands, groom.counts[own][strands])
                material.write(subset, path.ReplaceName(f"{path.name}_{name}"), settings, radius)

    def frame(self, frame: float, points: np.ndarray, velocities: np.ndarray) -> None:
        """Writes the points of all grooms [points, 3] [m] and their velocities [m/s] at a frame."""
        time = Usd.TimeCode(frame)
        for curves, own, space_of in self.targets:
            placed, moved = points[own], velocities[own]
            if space_of:
                # The parents of the curves may move.
                rate = self.base.GetTimeCodesPerSecond() / self.description.fps
                back, shift = self._own_space(space_of, Usd.TimeCode(frame * rate))
                placed = np.ascontiguousarray((placed.astype(np.float64) - shift) @ back, np.float32)
                moved = np.ascontiguousarray(moved.astype(np.float64) @ back, np.float32)
            curves.GetPointsAttr().Set(Vt.Vec3fArray.FromNumpy(placed), time)
            curves.GetVelocitiesAttr().Set(Vt.Vec3fArray.FromNumpy(moved), time)
            margin = self.margin[str(curves.GetPath())]
            low, high = placed.min(axis=0) - margin, placed.max(axis=0) + margin
            curves.CreateExtentAttr().Set(Vt.Vec3fArray([Gf.Vec3f(*map(float, low)), Gf.Vec3f(*map(float, high))]), time)

    def finish(self) -> None:
        """Completes the file. If that fails, nothing is left of it."""
        try:
            self._save()
            self.targets.clear()
            self.stage = self.layer = self.base = None
            publish(self.pending, self.path)
        except BaseException:
            self.discard()
            raise

    def _save(self) -> None:
        try:
            with quiet():
                saved = self.layer.Save()
        except Tf.ErrorException:
            saved = False
        if not saved:
            raise OSError("the disk may be full, or the folder may be read-only; free some space and run it again")

    def discard(self) -> None:
        """Removes what was written."""
        self.targets.clear()
        self.stage = self.layer = self.base = None
        self.pending.unlink(missing_ok=True)


def curves_of(groom: MovingGroom, base: Usd.Stage, over: Path) -> list[tuple[Usd.Prim, slice]]:
    """The prims of a stage that a groom was read from, each with its strands."""
    prims = []
    for name in groom.group_names:
        prim = base.GetPrimAtPath(name) if name.startswith("/") else None
        if not prim or prim.IsInstanceProxy():
            why = "is an instance" if prim else "is not in"
            raise ValueError(f"the curves {name} of the groom cannot be overridden: it {why} {over}")
        if is_below_an_instancer(prim):
            raise ValueError(f"the curves {name} of the groom cannot be overridden: a PointInstancer copies them; export each copy")
        prims.append(prim)
    total = len(groom.counts)
    if any(UsdGeom.PrimvarsAPI(prim).GetPrimvar("groom_group_id").HasValue() for prim in prims):
        # The groups are those of the file, and the strands of the prims follow one another.
        sizes = [len(UsdGeom.Curves(p).GetCurveVertexCountsAttr().Get(Usd.TimeCode.EarliestTime()) or []) for p in prims]
        if sum(sizes) != total:
            raise ValueError(f"the groom has {total} strands, and its curves in {over} have {sum(sizes)}; simulate all of them, unchanged")
        ends = np.cumsum([0, *sizes])
        return [(prim, slice(int(a), int(b))) for prim, a, b in zip(prims, ends, ends[1:]) if b > a]
    groups = groom.groups if groom.groups is not None else np.zeros(total, int)
    found = []
    for g, prim in enumerate(prims):
        strands = np.flatnonzero(groups == g)
        if len(strands) == 0:
            continue
        own = slice(int(strands[0]), int(strands[-1]) + 1)
        if len(strands) != own.stop - own.start:
            raise ValueError(f"the strands of {prim.GetPath()} are not in one piece")
        found.append((prim, own))
    return found


def check_size(prim: Usd.Prim, roots: np.ndarray, linear: np.ndarray, over: Path) -> None:
    """Refuses a groom that was read in another unit than that of the stage, by the extent of its roots [m]. `linear` maps the space
    of the prim to meters."""
    curves = UsdGeom.Curves(prim)
    first, counts = (a.Get(Usd.TimeCode.EarliestTime()) or [] for a in (curves.GetPointsAttr(), curves.GetCurveVertexCountsAttr()))
    starts = np.cumsum([0, *counts])[:-1]
    if len(first) == 0 or len(starts) == 0 or starts[-1] >= len(first):
        return
    own = np.array(first, np.float64)[starts] @ linear
    sizes = [float(np.linalg.norm(np.ptp(places, axis=0))) for places in (roots, own)]
    # Thinned hair covers a little less.
    if min(sizes) > 0 and not 0.3 < sizes[0] / sizes[1] < 3:
        raise ValueError(
            f"the groom is {sizes[0] / sizes[1]:.3g} times as large as its curves {prim.GetPath()} in {over}; read it without `scale`"
        )


def block_attributes(curves: UsdGeom.BasisCurves, base: UsdGeom.BasisCurves, points: int) -> None:
    """Blocks the attributes of curves that have a value for each point, where the number of points changes: that of cubic curves
    does. `primvars:widths` would count before the widths that are written."""
    before = len(base.GetPointsAttr().Get(Usd.TimeCode.EarliestTime()) or [])
    for own in UsdGeom.PrimvarsAPI(base).GetPrimvarsWithAuthoredValues():
        along = own.GetInterpolation() in (UsdGeom.Tokens.vertex, UsdGeom.Tokens.varying)
        if own.GetPrimvarName() == "widths" or along and before != points:
            curves.GetPrim().CreateAttribute(own.GetName(), own.GetTypeName(), False).Block()
    if before != points and base.GetNormalsAttr().HasAuthoredValue():
        curves.CreateNormalsAttr().Block()
