"""Helpers of the tests."""

from pathlib import Path

import numpy as np
import pytest

from hairspring import _native


@pytest.fixture
def program():
    """Runs the program `hairspring` in a process of its own, and returns its exit code and standard error."""
    import subprocess
    import sys

    def run(*arguments):
        done = subprocess.run(
            [sys.executable, "-m", "hairspring", *map(str, arguments)], capture_output=True, text=True, timeout=600
        )
        return done.returncode, done.stdout, done.stderr

    assert _native
    return run


def tuft(strands=12, points=10, length=0.1, up=1):
    """Strands that stand on a disk of 2 cm, and their offsets; `up` is the index of the vertical axis."""
    angle = np.linspace(0, 2 * np.pi, strands, endpoint=False)
    t = np.linspace(0, length, points)
    out = np.zeros((strands, points, 3), np.float32)
    across = [axis for axis in range(3) if axis != up]
    out[:, :, across[0]] = (0.02 * np.cos(angle))[:, None]
    out[:, :, across[1]] = (0.02 * np.sin(angle))[:, None]
    out[:, :, up] = t
    return out.reshape(-1, 3), np.arange(strands + 1, dtype=np.uint32) * points


def shot(folder: Path, text: str = "") -> Path:
    """A scene with the built-in head and few hairs."""
    path = folder / "shot.toml"
    path.write_text("[builtin]\nstrands = 200\nguides = 30\n" + text)
    return path
