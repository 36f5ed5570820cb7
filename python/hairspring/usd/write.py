"""Writer of moving strands as BasisCurves."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
from pxr import Gf, Kind, Sdf, Tf, Usd, UsdGeom, Vt

from ..description import Description, MovingGroom, identifier, publish
from . import material
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
        if self.path.suffix == ".usdz":
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
        # Curves, their points, and the transform to their own space, if it is not that of the file.
        self.targets: list[tuple[UsdGeom.BasisCurves, slice, tuple[np.ndarray, np.ndarray] | None]] = []
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
        base = open_stage(over)
        UsdGeom.SetStageMetersPerUnit(self.stage, UsdGeom.GetStageMetersPerUnit(base))
        UsdGeom.SetStageUpAxis(self.stage, UsdGeom.GetStageUpAxis(base))
        self.layer.subLayerPaths.append(os.path.relpath(over, self.path.parent))
        if base.HasDefaultPrim():
            self.layer.defaultPrim = base.GetDefaultPrim().GetName()
        to = space(base, None, None)
        first = 0
        for groom in self.description.grooms:
            groups = groom.groups if groom.groups is not None else np.zeros(len(groom.counts), int)
            for g, name in enumerate(groom.group_names):
                strands = np.flatnonzero(groups == g)
                if len(strands) == 0:
                    continue
                prim = base.GetPrimAtPath(name) if name.startswith("/") else None
                if not prim or prim.IsInstanceProxy():
                    why = "is an instance" if prim else "is not in"
                    raise ValueError(f"the curves {name} of the groom cannot be overridden: it {why} {over}")
                own = slice(int(strands[0]), int(strands[-1]) + 1)
                if len(strands) != own.stop - own.start:
                    raise ValueError(f"the strands of {name} are not in one piece")
                linear, shift = world_of(prim, Usd.TimeCode.EarliestTime(), to)
                back = np.linalg.inv(linear)
                curves = UsdGeom.BasisCurves(self.stage.OverridePrim(prim.GetPath()))
                self._describe(curves, groom, own, back, shift, complete=False)
                points = slice(first + int(groom.offsets[own.start]), first + int(groom.offsets[own.stop]))
                self.targets.append((curves, points, (back, shift)))
            first += len(groom.points)
        if not self.targets:
            raise ValueError(f"none of the grooms was read from {over}")

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
        path = curves.GetPath().GetParentPath().AppendChild(f"{curves.GetPrim().GetName()}_physics")
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
                back, shift = space_of
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
            self.stage = self.layer = None
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
        self.stage = self.layer = None
        self.pending.unlink(missing_ok=True)
