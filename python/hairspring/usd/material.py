"""Physics materials of curves (AOUSD proposal "Deformable Body Physics").

The proposal has had two sets of names: `physics:bendStiffness` and its like are moduli [mass/(distance time²)], and
`physics:curvesBendStiffness` and its like are those times the cross section: EA [force], EI and GJ [force distance²]. Both are
written, and both are read.
"""

from __future__ import annotations

import math

import numpy as np
from pxr import Sdf, Usd, UsdGeom, UsdPhysics, UsdShade, Vt

SCHEMA = "PhysicsCurvesDeformableMaterialAPI"
"""The applied schema of the material of curves."""

HAIR = {"young": 3.9e9, "density": 1310.0}
"""Young's modulus [Pa] and density [kg/m³] of the default material, a human hair."""


def subset(curves: UsdGeom.BasisCurves, name: str, strands: np.ndarray, counts: np.ndarray) -> UsdGeom.Subset:
    """Defines the subset of all segments of these strands, which have `counts` points, to which a material can be bound."""
    segments = np.repeat(strands, counts - 1)
    begins = np.repeat(np.cumsum(counts - 1) - (counts - 1), counts - 1)
    pairs = np.column_stack([segments, np.arange(len(segments)) - begins])
    indices = Vt.IntArray.FromNumpy(np.ascontiguousarray(pairs.ravel(), np.int32))
    api = UsdShade.MaterialBindingAPI.Apply(curves.GetPrim())
    return api.CreateMaterialBindSubset(name, indices, UsdGeom.Tokens.segment)


def write(target: UsdGeom.BasisCurves | UsdGeom.Subset, path: Sdf.Path, material: dict, radius: float) -> None:
    """Defines a material with the constants of `material`, for hair of this radius [m], and binds it to curves or to a subset of
    their segments for physics."""
    stage = target.GetPrim().GetStage()
    unit = UsdGeom.GetStageMetersPerUnit(stage)
    defined = UsdShade.Material.Define(stage, path)
    prim = defined.GetPrim()
    friction = float(material["friction"])
    api = UsdPhysics.MaterialAPI.Apply(prim)
    api.CreateDensityAttr(float(material["density"]) * unit**3)
    api.CreateStaticFrictionAttr(friction)
    api.CreateDynamicFrictionAttr(friction * float(material["friction_kinetic"]))
    prim.AddAppliedSchema(SCHEMA)
    bend = float(material["bend"])
    stretch, twist = float(material["young"]), float(material["shear"]) * bend
    area, second = math.pi * radius**2, 0.25 * math.pi * radius**4
    values = {
        "thickness": 2 * radius / unit,
        "stretchStiffness": stretch * unit,
        "bendStiffness": stretch * bend * unit,
        "twistStiffness": twist * unit,
        "curvesThickness": 2 * radius / unit,
        "curvesStretchStiffness": stretch * area / unit,
        "curvesBendStiffness": stretch * bend * second / unit**3,
        "curvesTwistStiffness": twist * 2 * second / unit**3,
    }
    for name, value in values.items():
        prim.CreateAttribute(f"physics:{name}", Sdf.ValueTypeNames.Float, False).Set(value)
    UsdShade.MaterialBindingAPI.Apply(target.GetPrim()).Bind(defined, materialPurpose="physics")


def read(prim: Usd.Prim, widths: bool, notes: list[str]) -> tuple[float | None, float | None]:
    """The radius [m] and the factor of a human hair's stiffness that the physics material of curves gives; None for what it does
    not give. With `widths`, the curves have their own radii. Notes say what is used and what is not."""
    bound, _ = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial("physics")
    found = bound.GetPrim() if bound else None
    schemas = found.GetMetadata("apiSchemas") if found else None
    if found is None or not schemas or SCHEMA not in schemas.GetAppliedItems():
        return None, None
    unit = UsdGeom.GetStageMetersPerUnit(prim.GetStage())

    def value(name: str) -> float | None:
        given = found.GetAttribute(f"physics:{name}").Get()
        return float(given) if given is not None and np.isfinite(given) and given > 0 else None

    thickness = value("curvesThickness") or value("thickness")
    radius = 0.5 * thickness * unit if thickness else None
    modulus = value("bendStiffness")
    young = modulus / unit if modulus else None
    structural = value("curvesBendStiffness")
    if structural and radius:
        young = structural * unit**3 / (0.25 * math.pi * radius**4)
    factor = young / HAIR["young"] if young else None
    used = []
    if radius and not widths:
        used.append(f"a radius of {1e6 * radius:.3g} µm")
    if factor and abs(factor - 1) > 1e-3:
        used.append(f"{factor:.3g} times the stiffness of a human hair, by which the scene's material is multiplied")
    density = value("density")
    unused = []
    if density and abs(density / unit**3 / HAIR["density"] - 1) > 0.01:
        unused.append(f"density = {density / unit**3:.4g}")
    friction = value("staticFriction")
    if friction and abs(friction - 0.3) > 1e-6:
        unused.append(f"friction = {friction:.3g}")
    said = []
    if used:
        said.append(f"the physics material {found.GetPath()} gives {' and '.join(used)}")
    if unused:
        said.append(f"set {', '.join(unused)} of the physics material {found.GetPath()} in the scene's material; it is not used")
    parts = UsdShade.MaterialBindingAPI(prim).GetMaterialBindSubsets()
    others = [p for p in parts if UsdShade.MaterialBindingAPI(p).GetDirectBinding("physics").GetMaterial()]
    if others:
        said.append(
            f"{prim.GetPath()} has other physics materials for {len(others)} of its parts ({others[0].GetPrim().GetName()}); they"
            " are not used: set a material for each group in the scene"
        )
    notes.extend(note for note in said if note not in notes)
    return radius, factor
