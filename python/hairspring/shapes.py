"""Points on curves, values along them (OpenUSD, "UsdGeomBasisCurves"), triangles of polygons, and times of samples."""

from __future__ import annotations

import numpy as np

from .formats import FormatError

# Most corners of a polygon that is not convex; larger ones become fans.
MAX_CONCAVE = 128

DEFAULT_RADIUS = "left out, so that its strands have the radius of the others, or the default"
"""What happens without widths."""


def distinct(times: set[float] | list[float]) -> np.ndarray:
    """Sorted times; of those that differ by rounding, the first."""
    ordered = np.array(sorted(times), np.float64)
    return ordered[np.concatenate([[True], np.diff(ordered) > 1e-5])] if len(ordered) else ordered


def spacing(times: np.ndarray) -> float:
    """The least distance of two or more sorted times; their mean distance if all are equal but for rounding."""
    steps = np.diff(times)
    mean = float(times[-1] - times[0]) / len(steps)
    return mean if steps.max() - steps.min() < 1e-3 * mean else float(steps.min())


def with_phantoms(points: np.ndarray, basis: str) -> np.ndarray:
    """Adds the points that a pinned curve has in addition, so that it reaches its first and last point."""
    if basis == "catmullRom" or basis == "bspline":
        first, last = 2 * points[:1] - points[1:2], 2 * points[-1:] - points[-2:-1]
        return np.concatenate([first, points, last])
    return points


def on_curve(points: np.ndarray, kind: str, basis: str, wrap: str) -> np.ndarray:
    """Returns points on a curve with the control points `points` [n, 3], from its start to its end.

    A linear curve, and a pinned Catmull-Rom curve, pass through their control points. Others are evaluated: B-splines and
    Catmull-Rom curves at the ends of their segments, Bézier curves also at the thirds between.
    """
    if kind == "linear" or len(points) < 3:
        return points
    if basis == "bezier":
        count = (len(points) - 1) // 3
        out = [points[:1]]
        for segment in range(count):
            p = points[3 * segment : 3 * segment + 4]
            for t in (1 / 3, 2 / 3, 1.0):
                s = 1 - t
                out.append((s**3 * p[0] + 3 * s * s * t * p[1] + 3 * s * t * t * p[2] + t**3 * p[3])[None])
        return np.concatenate(out)
    control = with_phantoms(points, basis) if wrap == "pinned" else points
    if basis == "bspline":
        return (control[:-2] + 4 * control[1:-1] + control[2:]) / 6
    return control[1:-1]


def check_counts(name: str, counts: np.ndarray, kind: str, basis: str) -> None:
    """Refuses Bézier curves of another number of control points than 3 for each segment and 1."""
    wrong = counts[(counts < 4) | (counts % 3 != 1)] if kind == "cubic" and basis == "bezier" else counts[:0]
    if len(wrong):
        raise FormatError(f"{name} has a Bézier curve of {wrong[0]} points; a curve of n segments must have 3 n + 1")


def fitted(
    values: np.ndarray | None,
    kind: str,
    each: np.ndarray,
    what: str,
    notes: list[str],
    size: int = 1,
    instead: str = "left out",
) -> tuple[np.ndarray | None, str]:
    """Values of curves and their interpolation if there are as many as it needs; otherwise None, and a note.

    `each` is as the `counts` of `expand`. One value holds for all curves. `size` is the least number of components of a value,
    and `instead` says what happens without the values.
    """
    if values is None or len(values) == 0:
        return None, kind
    if (values.shape[1] if values.ndim == 2 else values.ndim) < size or (size == 1 and values.ndim != 1):
        notes.append(f"{what} does not have {size} numbers for each value; {instead}")
        return None, kind
    if kind == "constant" or len(values) == 1:
        return values, "constant"
    varying, vertex = (int(counts.sum()) for counts in each)
    needs = {"uniform": each.shape[1], "varying": varying, "faceVarying": varying, "vertex": vertex}
    if needs.get(kind) == len(values):
        return values, kind
    if kind in ("varying", "faceVarying", "vertex") and len(values) in (vertex, varying):
        return values, "vertex" if len(values) == vertex else "varying"
    if kind in needs:
        notes.append(f"{what} has {len(values)} values, and {kind} interpolation needs {needs[kind]}; {instead}")
    else:
        notes.append(f"{what} has the unknown interpolation '{kind}'; {instead}")
    return None, kind


def of_strands(values: np.ndarray | None, strands: int, what: str, notes: list[str]) -> np.ndarray | None:
    """Values that are one for each strand, or one for all; otherwise None, and a note."""
    if values is None or len(values) == strands:
        return values
    if len(values) == 1:
        return np.repeat(values, strands, axis=0)
    notes.append(f"{what} has {len(values)} values for {strands} strands; left out")
    return None


def expand(values: np.ndarray, interpolation: str, curve: int, counts: np.ndarray, points: int) -> np.ndarray | None:
    """Returns the values of one curve at its `points` points, from the values of the prim.

    `counts` is the number of values that a varying and a vertex primvar have for each curve: [2, curves].
    """
    if len(values) == 0:
        return None
    if interpolation == "constant":
        return np.repeat(values[:1], points, axis=0)
    if interpolation == "uniform":
        return np.repeat(values[curve : curve + 1], points, axis=0)
    each = counts[1 if interpolation == "vertex" else 0]
    first = int(each[:curve].sum())
    own = values[first : first + int(each[curve])]
    if len(own) == points:
        return own
    if len(own) == 0:
        return None
    # Values at equal parameters along the curve, interpolated at the points.
    at, to = np.linspace(0, 1, len(own)), np.linspace(0, 1, points)
    flat = own.reshape(len(own), -1)
    columns = [np.interp(to, at, flat[:, k]) for k in range(flat.shape[1])]
    return np.stack(columns, axis=1).reshape(points, *own.shape[1:])


def unplayed(times: set[float]) -> list[str]:
    """A note that curves with samples at these times are read at the first one; none for curves that do not move."""
    if len(times) < 2:
        return []
    return [f"the curves have {len(times)} time samples, which are not played: strands are read at the first one, and follow the [body]"]


def naming(names: list[str]) -> str:
    """The first three names, and the number of the others."""
    more = f" and {len(names) - 3} more" if len(names) > 3 else ""
    return ", ".join(names[:3]) + more


def varying_count(control: int, kind: str, basis: str, wrap: str) -> int:
    """Number of varying values of a curve with `control` control points: the ends of its segments."""
    if kind == "linear":
        return control
    if basis == "bezier":
        return (control - 4) // 3 + 2
    return control if wrap == "pinned" else control - 2


def triangulate(counts: np.ndarray, indices: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Triangles of polygons: [triangles, 3]. Convex ones become fans; of others, ears are clipped."""
    first = np.concatenate([[0], np.cumsum(counts)[:-1]])
    fans = np.maximum(counts - 2, 0)
    start = np.repeat(first, fans)
    step = np.arange(fans.sum()) - np.repeat(np.cumsum(fans) - fans, fans)
    triangles = np.stack([indices[start], indices[start + step + 1], indices[start + step + 2]], axis=1)
    # The triangles of a fan of a convex polygon have the same orientation.
    corners = points[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    face = np.repeat(np.arange(len(counts)), fans)
    whole = np.zeros((len(counts), 3))
    np.add.at(whole, face, normals)
    concave = np.unique(face[np.einsum("ij,ij->i", normals, whole[face]) < 0])
    ends = np.cumsum(fans)
    for f in concave[counts[concave] <= MAX_CONCAVE]:
        polygon = indices[first[f] : first[f] + counts[f]]
        triangles[ends[f] - fans[f] : ends[f]] = polygon[ears(points[polygon], whole[f])]
    return triangles


def ears(points: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Triangles of a simple polygon with this normal, by clipping ears (Meisters 1975): [corners - 2, 3]."""
    left, found = list(range(len(points))), []
    while len(left) > 3:
        for k in range(len(left)):
            a, b, c = left[k - 1], left[k], left[(k + 1) % len(left)]
            side = [np.dot(np.cross(points[j] - points[i], points[left] - points[i]), normal) for i, j in ((a, b), (b, c), (c, a))]
            convex = np.dot(np.cross(points[b] - points[a], points[c] - points[b]), normal) > 0
            inside = np.all(np.array(side) > 0, axis=0)
            if convex and not inside.any():
                break
        else:
            # It crosses itself: any corner will do.
            k = 0
        found.append((left[k - 1], left[k], left[(k + 1) % len(left)]))
        del left[k]
    return np.array([*found, tuple(left)], np.int64)
