"""What readers of formats return, in meters, Y up."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np


@dataclass
class Curves:
    """Strands of a file; arrays as in `Groom`. Optional arrays are None."""

    points: np.ndarray
    offsets: np.ndarray
    radii: np.ndarray | None = None
    groups: np.ndarray | None = None
    group_names: list[str] = field(default_factory=list)
    root_uvs: np.ndarray | None = None
    colors: np.ndarray | None = None
    guides: np.ndarray | None = None
    guide_weights: np.ndarray | None = None
    factors: dict[str, np.ndarray] = field(default_factory=dict)
    """Factors of the material for each strand: those of `FACTORS`; [strands], float32."""
    notes: list[str] = field(default_factory=list)


@dataclass
class MovingMesh:
    """A triangle mesh and, if it moves, the positions of its vertices in each frame."""

    vertices: np.ndarray
    """[vertices, 3], float32: the first frame [m]."""
    triangles: np.ndarray
    """[triangles, 3], uint32."""
    uvs: np.ndarray | None = None
    """[vertices, 2], float32."""
    parts: list[tuple[str, int]] = field(default_factory=list)
    """Name and number of triangles of each part, in order."""
    frames: np.ndarray | None = None
    """[frames, vertices, 3], float32 [m]; None if nothing moves."""
    rate: float = 24.0
    """Frames per second of `frames` [Hz]."""
    notes: list[str] = field(default_factory=list)
    colors: np.ndarray | None = None
    """[vertices, 3], float32, 0 to 1."""


class FormatError(Exception):
    """A file that cannot be read or written: one sentence without the name of the file."""


class AbsentError(FormatError):
    """A file that has nothing of the kind that is to be read."""


FACTORS = ("stiffness", "damping", "drag", "friction", "charge", "flatness", "tether", "density")
"""Names of the attributes with a number for each strand: factors of the material, and the share of strands that is kept."""

MAX_POSITIONS = 150_000_000

# Most samples of the motion of a body, and most of them a second [Hz].
MAX_SAMPLES = 100_000
MAX_RATE = 240.0
"""Largest number of vertex positions of a motion: 1,500 frames of 100,000 vertices."""


def as_lengths_and_points(strands: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Joins strands of shape [n, 3] to points and offsets."""
    offsets = np.zeros(len(strands) + 1, np.uint32)
    np.cumsum([len(s) for s in strands], out=offsets[1:])
    points = np.concatenate(strands) if strands else np.zeros((0, 3), np.float32)
    return np.ascontiguousarray(points, np.float32), offsets


def guides_from_flags(flags: np.ndarray, roots: np.ndarray, objects: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    """Guides and weights of strands, if only `flags` says which of them are guides: the nearest guide by its root, among those
    of the same object. `objects` numbers the object of each strand; those of an object without guides follow the others'."""
    guides = np.flatnonzero(flags)
    if len(guides) == 0 or len(guides) == len(flags):
        return None
    nearest = np.empty(len(flags), np.uint32)
    for label in np.unique(objects):
        strands = np.flatnonzero(objects == label)
        own = strands[flags[strands]]
        own = own if len(own) else guides
        # In blocks, so that memory stays bounded.
        for first in range(0, len(strands), 4096):
            block = strands[first : first + 4096]
            distance = ((roots[block, None, :] - roots[None, own, :]) ** 2).sum(axis=2)
            nearest[block] = own[distance.argmin(axis=1)]
    nearest[guides] = guides
    weights = np.zeros((len(flags), 3), np.float32)
    weights[:, 0] = 1.0
    return np.repeat(nearest[:, None], 3, axis=1), weights
