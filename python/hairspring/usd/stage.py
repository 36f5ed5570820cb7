"""Opens stages, finds their prims, and reports prims that the readers skip."""

from __future__ import annotations

import re
from contextlib import contextmanager
from pathlib import Path
from typing import Iterator

import numpy as np
from pxr import Gf, Tf, Usd, UsdGeom, UsdUtils

from ..formats import FACTORS, FormatError
from ..shapes import naming

AXIS = {"Y": np.eye(3), "Z": np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])}
"""Rotation of a stage's axes to Y up."""

KNOWN_PRIMVARS = frozenset(
    (
        *("widths", "normals", "displayColor", "displayOpacity", "st", "uv", "surface_uv_coordinate", "groom_root_uv"),
        *("groom_id", "groom_guide", "groom_group_id", "groom_closest_guides", "groom_guide_weights", *FACTORS),
    )
)
"""Primvars of curves that are read, or that have nothing to do with the simulation."""


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
    """Returns the layers and other files that a stage consists of, without those that are missing."""
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


DRAWN = ("default", "render")
"""Purposes of prims that belong to the picture."""


def is_drawn(prim: Usd.Prim) -> bool:
    """Whether a prim is visible at first, and not a stand-in or a guide of the viewport."""
    image = UsdGeom.Imageable(prim)
    return image.ComputePurpose() in DRAWN and image.ComputeVisibility(Usd.TimeCode.EarliestTime()) != "invisible"


def all_prims(stage: Usd.Stage, kind) -> list[Usd.Prim]:
    """All prims of a type, those of instances included."""
    return [prim for prim in Usd.PrimRange.Stage(stage, Usd.TraverseInstanceProxies()) if prim.IsA(kind)]


def prims(stage: Usd.Stage, kind) -> list[Usd.Prim]:
    """All prims of a type that are drawn, those of instances included."""
    return [prim for prim in all_prims(stage, kind) if is_drawn(prim)]


def instancers(stage: Usd.Stage) -> list[Usd.Prim]:
    """All instancers that are drawn."""
    return prims(stage, UsdGeom.PointInstancer)


def prototypes(instancer: Usd.Prim) -> list[Usd.Prim]:
    """The prims that an instancer copies."""
    targets = UsdGeom.PointInstancer(instancer).GetPrototypesRel().GetForwardedTargets()
    return [instancer.GetStage().GetPrimAtPath(target) for target in targets]


def left_out(stage: Usd.Stage, kind, others: tuple, into: str) -> list[str]:
    """Returns notes about prims that the readers skip: hidden ones of the type `kind`, and visible ones of the types `others`."""
    hidden = [str(prim.GetPath()) for prim in all_prims(stage, kind) if not is_drawn(prim)]
    notes = []
    if hidden:
        notes.append(f"{kind.__name__} prims that are hidden, guides or proxies are left out ({naming(hidden)})")
    for other in others:
        names = [str(prim.GetPath()) for prim in prims(stage, other)]
        if names:
            notes.append(f"{other.__name__} prims are left out ({naming(names)}); convert them to {into}")
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


def times_of(prims: list[Usd.Prim]) -> set[float]:
    """The time samples [time codes] of the points of any of these prims, and of the transforms above them."""
    times: set[float] = set()
    for prim in prims:
        times.update(UsdGeom.PointBased(prim).GetPointsAttr().GetTimeSamples())
        ancestor = prim
        while ancestor and not ancestor.IsPseudoRoot():
            times.update(UsdGeom.Xformable(ancestor).GetTimeSamples() if ancestor.IsA(UsdGeom.Xformable) else [])
            ancestor = ancestor.GetParent()
    return times


def world_of(prim: Usd.Prim, time: Usd.TimeCode, to: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Linear part and translation of a prim's transform, to meters and Y up; for row vectors."""
    return world(UsdGeom.Imageable(prim).ComputeLocalToWorldTransform(time), to)


def world(transform: Gf.Matrix4d, to: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Linear part and translation of a transform in the stage, to meters and Y up; for row vectors."""
    m = np.array(transform)
    return m[:3, :3] @ to, m[3, :3] @ to


def primvar(prim: Usd.Prim, *names: str):
    """The first of these primvars that has a value, and its interpolation."""
    api = UsdGeom.PrimvarsAPI(prim)
    for name in names:
        # Constant primvars of parents count.
        found = api.FindPrimvarWithInheritance(name)
        if found and found.HasValue():
            value = found.ComputeFlattened(first_time([found.GetAttr()]))
            if value is not None:
                values = np.atleast_1d(np.array(value))
                if values.dtype.kind not in "biuf":
                    raise FormatError(f"the primvar `{name}` of {prim.GetPath()} holds {found.GetTypeName()}; write numbers")
                return values, str(found.GetInterpolation())
    return None, ""


def because(notes: list[str]) -> str:
    """What notes say about the cause of an error, in brackets."""
    return f" ({'; '.join(notes)})" if notes else ""
