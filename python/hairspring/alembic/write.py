"""Writer of moving strands as Alembic curves with the attributes of Unreal's groom schema."""

from __future__ import annotations

import os
from pathlib import Path

import imath
import numpy as np
from alembic3d import Abc, AbcCoreAbstract, AbcGeom

from ..description import Description, MovingGroom, identifier

VERSION = (1, 5)
"""Version of Unreal's groom schema."""

Scope = AbcGeom.GeometryScope


def _floats(a):
    return imath.FloatArrayFromBuffer(np.ascontiguousarray(a, np.float32))


def _vectors(a):
    return imath.V3fArrayFromBuffer(np.ascontiguousarray(a, np.float32))


def _ints(a):
    return imath.IntArrayFromBuffer(np.ascontiguousarray(a, np.int32))


def _short(n: int):
    array = imath.ShortArray(1)
    array[0] = n
    return array


def _colors(a):
    array = imath.C3fArray(len(a))
    for channel, name in enumerate("rgb"):
        getattr(array, name)[:] = _floats(a[:, channel])
    return array


class CurvesWriter:
    """Writes strands that move to one Alembic archive, in meters, Y up.

    Each groom becomes one object of linear curves with positions, velocities, widths and bounds over time, and `groom_version_major`
    1, `groom_version_minor` 5, `groom_id`, `groom_width`, and if the groom has them `groom_group_id`, `groom_root_uv`, `groom_color`,
    `groom_closest_guides` and `groom_guide_weights`. If only some strands were simulated, they are a second object with
    `groom_guide` 1 and the same `groom_id`.

    Frame n is at the time n / fps. The file appears under its name when `finish` returns.
    """

    def __init__(self, path: str | os.PathLike, description: Description):
        self.path, self.description = Path(path), description
        self.pending = self.path.with_name(f".hairspring-{os.getpid()}-{self.path.name}")
        text = f"from {description.source}" if description.source else "hair"
        self.archive = Abc.CreateArchiveWithInfo(str(self.pending), description.fps, "Hairspring", text)
        sampling = AbcCoreAbstract.TimeSampling(1 / description.fps, description.first_frame / description.fps)
        self.sampling = Abc.Argument(self.archive.addTimeSampling(sampling))
        self.objects: list[dict] = []
        taken: set[str] = set()
        first = 0
        for groom in description.grooms:
            name = identifier(groom.name, taken)
            strands = np.arange(len(groom.counts))
            self._add(name, groom, strands, first, guide=False)
            if groom.guide.any() and not groom.guide.all():
                self._add(identifier(f"{name}_guides", taken), groom, np.flatnonzero(groom.guide), first, guide=True)
            first += len(groom.points)

    def _add(self, name: str, groom: MovingGroom, strands: np.ndarray, first: int, guide: bool) -> None:
        counts = groom.counts[strands]
        start = groom.offsets[strands].astype(np.int64)
        index = np.repeat(start - np.concatenate([[0], np.cumsum(counts)[:-1]]), counts) + np.arange(counts.sum())
        curves = AbcGeom.OCurves(self.archive.getTop(), name, self.sampling)
        schema = curves.getSchema()
        self.objects.append(
            {"schema": schema, "index": index + first, "counts": _ints(counts), "width": _floats(2 * groom.radii[index])}
        )
        parameters = schema.getArbGeomParams()

        def add(kind: str, name: str, values, scope) -> None:
            parameter = getattr(AbcGeom, f"O{kind}GeomParam")(parameters, name, False, scope, 1)
            parameter.set(getattr(AbcGeom, f"O{kind}GeomParamSample")(values, scope))

        add("Int16", "groom_version_major", _short(VERSION[0]), Scope.kConstantScope)
        add("Int16", "groom_version_minor", _short(VERSION[1]), Scope.kConstantScope)
        if guide:
            add("Int16", "groom_guide", _short(1), Scope.kConstantScope)
        add("Int32", "groom_id", _ints(strands), Scope.kUniformScope)
        add("Float", "groom_width", _floats(2 * groom.radii[index]), Scope.kVertexScope)
        if groom.groups is not None:
            add("Int32", "groom_group_id", _ints(groom.groups[strands]), Scope.kUniformScope)
        if groom.root_uvs is not None:
            uvs = imath.V2fArrayFromBuffer(np.ascontiguousarray(groom.root_uvs[strands], np.float32))
            add("V2f", "groom_root_uv", uvs, Scope.kUniformScope)
        if groom.colors is not None:
            add("C3f", "groom_color", _colors(groom.colors[index]), Scope.kVertexScope)
        if groom.guides is not None and not guide:
            closest = imath.V3iArrayFromBuffer(np.ascontiguousarray(groom.guides, np.int32))
            add("V3i", "groom_closest_guides", closest, Scope.kUniformScope)
            add("V3f", "groom_guide_weights", _vectors(groom.guide_weights), Scope.kUniformScope)

    def frame(self, frame: float, points: np.ndarray, velocities: np.ndarray) -> None:
        """Writes the points of all grooms [points, 3] [m] and their velocities [m/s] at the next frame."""
        del frame  # Samples are at equal times, one after the other.
        for item in self.objects:
            own = points[item["index"]]
            width = AbcGeom.OFloatGeomParamSample(item["width"], Scope.kVertexScope)
            sample = AbcGeom.OCurvesSchemaSample(
                _vectors(own), item["counts"], AbcGeom.CurveType.kLinear, AbcGeom.CurvePeriodicity.kNonPeriodic, width
            )
            # Blender reads curves with the default basis as Bézier curves, whatever their type.
            sample.setBasis(AbcGeom.BasisType.kNoBasis)
            sample.setVelocities(_vectors(velocities[item["index"]]))
            low, high = (imath.V3d(*map(float, corner)) for corner in (own.min(axis=0), own.max(axis=0)))
            sample.setSelfBounds(imath.Box3d(low, high))
            item["schema"].set(sample)

    def finish(self) -> None:
        """Completes the file."""
        self._close()
        with open(self.pending, "rb") as written:
            os.fsync(written.fileno())
        os.replace(self.pending, self.path)

    def discard(self) -> None:
        """Removes what was written."""
        self._close()
        self.pending.unlink(missing_ok=True)

    def _close(self) -> None:
        # The archive is written when its last object is destroyed.
        self.objects.clear()
        self.sampling = self.archive = None
