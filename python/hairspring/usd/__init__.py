"""Reads and writes USD by `usd-core` (`pip install hairspring[usd]`).

| function | |
| --- | --- |
| `read_curves` | BasisCurves as a groom |
| `read_mesh` | meshes, skinned or not, as a body with its motion |
| `read_cameras` | cameras over time |
| `used_files` | the layers and other files of a stage |
| `CurvesWriter` | strands that move, as time-sampled BasisCurves |

All content is in meters, Y up; the unit and the axis of a stage are converted.
"""

from .cameras import read_cameras
from .curves import read_curves
from .mesh import read_mesh
from .stage import used_files
from .write import CurvesWriter

__all__ = ["CurvesWriter", "read_cameras", "read_curves", "read_mesh", "used_files"]
