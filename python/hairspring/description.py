"""What a writer of moving strands gets before the first frame."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np


@dataclass
class MovingGroom:
    """A groom of a bake: what does not change over time."""

    name: str
    points: np.ndarray
    """Rest positions [points, 3] [m]."""
    offsets: np.ndarray
    """[strands + 1]."""
    radii: np.ndarray
    """[points] [m]."""
    guide: np.ndarray
    """Whether each strand was simulated: [strands], bool."""
    groups: np.ndarray | None = None
    group_names: list[str] = field(default_factory=list)
    root_uvs: np.ndarray | None = None
    colors: np.ndarray | None = None
    guides: np.ndarray | None = None
    guide_weights: np.ndarray | None = None
    materials: list[dict] = field(default_factory=list)
    """The settings of the material of each group, by name."""

    @property
    def counts(self) -> np.ndarray:
        """Number of points of each strand."""
        return np.diff(self.offsets.astype(np.int64))


@dataclass
class Description:
    """A bake: its grooms and its time."""

    fps: float
    first_frame: float
    frames: int
    """Number of samples."""
    grooms: list[MovingGroom]
    source: str = ""
    per_frame: int = 1
    """Samples for each frame."""

    @property
    def last_frame(self) -> float:
        """Number of the last frame."""
        return self.first_frame + (self.frames - 1) / self.per_frame


def identifier(name: str, taken: set[str]) -> str:
    """A name of letters, digits and underscores that is not in `taken`, to which it is added."""
    plain = "".join(c if c.isascii() and (c.isalnum() or c == "_") else "_" for c in name) or "groom"
    plain = plain if not plain[0].isdigit() else f"_{plain}"
    unique, n = plain, 2
    while unique in taken:
        unique, n = f"{plain}_{n}", n + 1
    taken.add(unique)
    return unique


def publish(pending: Path, path: Path) -> None:
    """Flushes a complete file to the disk and gives it its final name."""
    with open(pending, "rb") as written:
        os.fsync(written.fileno())
    os.replace(pending, path)
