"""Writer of moving strands as Alembic curves with the attributes of Unreal's groom schema."""

from __future__ import annotations

import ctypes
import os
import shutil
from pathlib import Path
from typing import Any

import imath
import numpy as np
from alembic3d import Abc, AbcCoreAbstract, AbcGeom

from ..description import Description, MovingGroom, identifier, publish

VERSION = (1, 5)
"""Version of Unreal's groom schema."""

NOT_CREATED = "the file cannot be created; check that its folder exists and that you may write there"
NOT_WRITTEN = "the disk may be full, or a limit on the size of files is reached; free some space and run it again"

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
    `groom_closest_guides` and `groom_guide_weights`. The numbers of `groom_id` are unique in the file. If only some strands of the
    file were simulated, those of each groom are a second object with `groom_guide` 1 and the same `groom_id`.

    Frame n is at the time n / fps, and samples between frames are at equal distances. The file appears under its name when `finish` returns.
    """

    def __init__(self, path: str | os.PathLike, description: Description):
        self.path, self.description = Path(path), description
        self.pending = self.path.with_name(f".hairspring-{os.getpid()}-{self.path.name}")
        self.objects: list[dict] = []
        self.sampling: Any = None
        self.archive: Any = None
        # Whether the stream has failed. The library ends the process if such an archive is destroyed.
        self.failed = False
        grooms = description.grooms
        # What is written for each object and sample when the archive is closed.
        self.closing = (1 << 20) + 1024 * description.frames * len(grooms)
        self._require(sum(64 * (len(groom.points) + len(groom.counts)) for groom in grooms))
        try:
            self._begin()
        except BaseException as error:
            self.failed = isinstance(error, RuntimeError)
            self.discard()
            if self.failed:
                raise OSError(NOT_CREATED) from None
            raise

    def _begin(self) -> None:
        description = self.description
        text = f"from {description.source}" if description.source else "hair"
        self.archive = Abc.CreateArchiveWithInfo(str(self.pending), description.fps, "Hairspring", text)
        step = 1 / (description.fps * description.per_frame)
        sampling = AbcCoreAbstract.TimeSampling(step, description.first_frame / description.fps)
        self.sampling = Abc.Argument(self.archive.addTimeSampling(sampling))
        taken: set[str] = set()
        # Where all strands were simulated, none is marked. Otherwise also the guides of a groom without other strands are.
        some = not all(groom.guide.all() for groom in description.grooms)
        first, first_id = 0, 0
        for groom in description.grooms:
            name = identifier(groom.name, taken)
            strands = np.arange(len(groom.counts))
            self._add(name, groom, strands, first, first_id, guide=False)
            if some and groom.guide.any():
                guides = np.flatnonzero(groom.guide)
                self._add(identifier(f"{name}_guides", taken), groom, guides, first, first_id, guide=True)
            first, first_id = first + len(groom.points), first_id + len(groom.counts)

    def _add(self, name: str, groom: MovingGroom, strands: np.ndarray, first: int, first_id: int, guide: bool) -> None:
        """Adds the object of these strands of a groom, whose points begin at `first` and whose ids begin at `first_id`."""
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
        add("Int32", "groom_id", _ints(first_id + strands), Scope.kUniformScope)
        add("Float", "groom_width", _floats(2 * groom.radii[index]), Scope.kVertexScope)
        if groom.groups is not None:
            add("Int32", "groom_group_id", _ints(groom.groups[strands]), Scope.kUniformScope)
        if groom.root_uvs is not None:
            uvs = imath.V2fArrayFromBuffer(np.ascontiguousarray(groom.root_uvs[strands], np.float32))
            add("V2f", "groom_root_uv", uvs, Scope.kUniformScope)
        if groom.colors is not None:
            add("C3f", "groom_color", _colors(groom.colors[index]), Scope.kVertexScope)
        if groom.guides is not None and not guide:
            closest = imath.V3iArrayFromBuffer(np.ascontiguousarray(first_id + groom.guides.astype(np.int64), np.int32))
            add("V3i", "groom_closest_guides", closest, Scope.kUniformScope)
            add("V3f", "groom_guide_weights", _vectors(groom.guide_weights), Scope.kUniformScope)

    def frame(self, frame: float, points: np.ndarray, velocities: np.ndarray) -> None:
        """Writes the points of all grooms [points, 3] [m] and their velocities [m/s] at the next frame."""
        del frame  # Samples are at equal times, one after the other.
        # Positions, velocities and widths of each point, with room for what else a sample has.
        self._require(sum(32 * len(item["index"]) + 4 * len(item["counts"]) + 4096 for item in self.objects))
        try:
            for item in self.objects:
                self._set(item, points[item["index"]], velocities[item["index"]])
        except RuntimeError:
            self.failed = True
            raise OSError(NOT_WRITTEN) from None

    @staticmethod
    def _set(item: dict, points: np.ndarray, velocities: np.ndarray) -> None:
        """Writes the next sample of an object."""
        width = AbcGeom.OFloatGeomParamSample(item["width"], Scope.kVertexScope)
        sample = AbcGeom.OCurvesSchemaSample(
            _vectors(points), item["counts"], AbcGeom.CurveType.kLinear, AbcGeom.CurvePeriodicity.kNonPeriodic, width
        )
        # Blender reads curves with the default basis as Bézier curves, whatever their type.
        sample.setBasis(AbcGeom.BasisType.kNoBasis)
        sample.setVelocities(_vectors(velocities))
        low, high = (imath.V3d(*map(float, corner)) for corner in (points.min(axis=0), points.max(axis=0)))
        sample.setSelfBounds(imath.Box3d(low, high))
        item["schema"].set(sample)

    def _require(self, size: int) -> None:
        """Refuses to write `size` more bytes if the disk has no room for them and for the end of the file.

        The library ends the process if the disk is full when it closes the archive.
        """
        try:
            free, needed = shutil.disk_usage(self.path.parent).free, size + self.closing
        except OSError:
            # The folder is missing, or the system does not say.
            return
        if free < needed:
            raise OSError(
                f"the disk is full: {free / 1e6:.1f} MB are free, and the next frame and the end of the file need"
                f" {needed / 1e6:.1f} MB; free some space and run it again"
            )

    def finish(self) -> None:
        """Completes the file. If that fails, nothing is left of it."""
        try:
            self._require(0)
            self._close()
            publish(self.pending, self.path)
        except BaseException:
            self.discard()
            raise

    def discard(self) -> None:
        """Removes what was written."""
        if self.pending.exists():
            # The archive needs room to be closed.
            os.truncate(self.pending, 0)
        if self.failed:
            self._abandon()
        self._close()
        self.pending.unlink(missing_ok=True)

    def _abandon(self) -> None:
        """Keeps the archive and its objects alive for ever, so that the library does not try to complete the file."""
        for kept in (self.archive, self.sampling, *(item["schema"] for item in self.objects)):
            ctypes.pythonapi.Py_IncRef(ctypes.py_object(kept))

    def _close(self) -> None:
        # The archive is written when its last object is destroyed.
        self.objects.clear()
        self.sampling = self.archive = None
