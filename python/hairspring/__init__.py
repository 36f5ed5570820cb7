"""Real-time strand hair: simulation of mass-spring chains and elastic rods by an implicit, direct, banded solver.

    import hairspring as hs

    stage = hs.Stage(hs.Scene.builtin("wavy", strands=20_000))
    for frame in range(60):
        stage.step(fps=30)
    points = stage.points()          # [points, 3], float32, meters, Y up

| class | |
| --- | --- |
| `Groom`, `Body`, `Scene` | what files hold: strands, a mesh with its skeleton, a whole shot |
| `Material`, `Solver`, `Volume`, `Wind` | settings, by the names of scene files |
| `Stage` | a scene that plays |
| `Simulation` | strands that your program steps |
| `Collider`, `SignedDistanceField` | shapes that hair collides with |

`hairspring.usd` and `hairspring.alembic` read and write these formats; they need `usd-core` and `alembic3d`. The program
`hairspring` comes with the package, and reads and writes them too.

Quantities are in SI units; coordinates are right-handed, with Y up.
"""

from ._native import (
    Body,
    Collider,
    FileError,
    Groom,
    HairspringError,
    Material,
    Scene,
    SettingError,
    SignedDistanceField,
    Simulation,
    Snapshot,
    Solver,
    Stage,
    Volume,
    Wind,
    __version__,
)

__all__ = [
    "Body",
    "Collider",
    "FileError",
    "Groom",
    "HairspringError",
    "Material",
    "Scene",
    "SettingError",
    "SignedDistanceField",
    "Simulation",
    "Snapshot",
    "Solver",
    "Stage",
    "Volume",
    "Wind",
    "__version__",
]
