"""What the extension module calls to read and write USD and Alembic."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .description import Description, MovingGroom
from .formats import FormatError

USD = (".usd", ".usda", ".usdc", ".usdz")


def _module(path: Path):
    """The module for a file; a FormatError if its library is not installed."""
    try:
        if path.suffix.lower() in USD:
            from . import usd

            return usd
        from . import alembic

        return alembic
    except ImportError as error:
        extra, library = ("usd", "usd-core") if path.suffix.lower() in USD else ("alembic", "alembic3d")
        raise FormatError(f"{library} is not installed ({error}); run `pip install 'hairspring[{extra}]'`") from None


def _stated(path: Path, scale: float | None) -> bool:
    """Whether the unit is known: USD states it, Alembic does not."""
    return scale is not None or path.suffix.lower() in USD


def read_groom(path: str, scale: float | None, up: str | None):
    """Returns the groom's arrays by the names of `Groom`'s parameters, its group names, whether its unit is known, and notes."""
    file = Path(path)
    read = _module(file).read_curves(file, scale, up)
    names = ("points", "offsets", "radii", "groups", "root_uvs", "colors", "guides", "guide_weights")
    arrays = {name: getattr(read, name) for name in names if getattr(read, name) is not None}
    arrays |= read.factors
    return arrays, read.group_names, _stated(file, scale), read.notes


def read_body(path: str, scale: float | None, up: str | None):
    """Returns vertices, triangles, texture coordinates or None, colors of the vertices or None, parts, frames or None, their rate,
    whether the unit is known, and notes."""
    file = Path(path)
    read = _module(file).read_mesh(file, scale, up)
    known = _stated(file, scale)
    return read.vertices, read.triangles, read.uvs, read.colors, read.parts, read.frames, read.rate, known, read.notes


def used_files(path: str) -> list[str]:
    """Returns the layers and other files that a USD file consists of; none for Alembic. What is missing is left out."""
    if Path(path).suffix.lower() not in USD:
        return []
    from . import usd

    return usd.used_files(path)


def write_cache(path: str, time: tuple[float, float, int, int], source: str, over: str | None, grooms: list[dict]):
    """Begins a file of moving strands. `time` is the frames per second, the first frame, the number of samples and the samples for
    each frame; `grooms` holds the fields of `MovingGroom`."""
    file = Path(path)
    described = []
    for groom in grooms:
        guides = groom.pop("guides_and_weights")
        groom["guides"], groom["guide_weights"] = guides if guides else (None, None)
        groom["guide"] = np.asarray(groom["guide"], bool)
        described.append(MovingGroom(**groom))
    fps, first_frame, frames, per_frame = time
    description = Description(fps, first_frame, frames, described, source, per_frame)
    try:
        if over is None:
            return _module(file).CurvesWriter(file, description)
        if file.suffix.lower() not in USD:
            raise FormatError("only a USD file can be a layer over another; write .usdc")
        return _module(file).CurvesWriter(file, description, over)
    except ValueError as error:
        raise FormatError(str(error)) from None
