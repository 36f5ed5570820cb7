"""Stages that the tests of USD read."""

import numpy as np
from pxr import Usd, UsdGeom, Vt

CORNERS = np.array([[0, 0, 0], [0.2, 0, 0], [0, 0.2, 0], [0, 0, 0.2]])
FACES = ([3] * 4, [0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2])


def define_curves(stage, path, points, offsets, kind="linear", basis=None, wrap="nonperiodic", widths=None, interpolation=None):
    curves = UsdGeom.BasisCurves.Define(stage, path)
    curves.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(points, np.float32)))
    curves.CreateCurveVertexCountsAttr(Vt.IntArray.FromNumpy(np.diff(offsets).astype(np.int32)))
    curves.CreateTypeAttr(kind)
    curves.CreateWrapAttr(wrap)
    if basis:
        curves.CreateBasisAttr(basis)
    if widths is not None:
        curves.CreateWidthsAttr(Vt.FloatArray.FromNumpy(np.ascontiguousarray(widths, np.float32)))
        curves.SetWidthsInterpolation(interpolation)
    return curves


def new_stage(path, up="Y", meters=1.0):
    stage = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageUpAxis(stage, up)
    UsdGeom.SetStageMetersPerUnit(stage, meters)
    return stage


def a_mesh(stage, points, counts, indices):
    mesh = UsdGeom.Mesh.Define(stage, "/m")
    mesh.CreateFaceVertexCountsAttr(counts)
    mesh.CreateFaceVertexIndicesAttr(indices)
    mesh.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(points, np.float32)))
    return mesh


def volume(read):
    a, b, c = (read.vertices[read.triangles[:, k]].astype(np.float64) for k in range(3))
    return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
