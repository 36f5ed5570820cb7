"""Reader of cameras."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from pxr import Gf, Usd, UsdGeom

from .stage import open_stage, prims, space, world_of


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
            linear, shift = world_of(prim, time, to)
            lens: Gf.Camera = UsdGeom.Camera(prim).GetCamera(time)
            look = -linear[2] / np.linalg.norm(linear[2])
            fov = lens.GetFieldOfView(Gf.Camera.FOVVertical)
            samples.append({"time": t, "position": shift, "target": shift + look, "fov": float(fov)})
        cameras[str(prim.GetPath())] = samples
    return cameras
