"""Reads and writes Alembic by `alembic3d` (`pip install hairspring[alembic]`).

Curves have the attributes of Unreal's groom schema, version 1.5. All content is in meters, Y up; Alembic stores no unit, so
readers take `scale` (Unreal and Maya: 0.01) and guess it otherwise.
"""

from .read import read_curves, read_mesh
from .write import CurvesWriter

__all__ = ["CurvesWriter", "read_curves", "read_mesh"]
