"""The program `hairspring`: `hairspring wedge` here, all other commands in the extension module."""

from __future__ import annotations

import sys

from . import _native


def main() -> int:
    """Runs the program with the arguments of the process. Returns its exit code."""
    arguments = sys.argv[1:]
    if arguments[:1] == ["wedge"]:
        from .wedge import main as wedge

        return wedge(arguments[1:])
    return _native.run_command(["hairspring", *arguments])


if __name__ == "__main__":
    sys.exit(main())
