"""`hairspring wedge`: many variants of a bake or a picture, on this machine or on a Ray cluster."""

from .command import exit_code, main

__all__ = ["exit_code", "main"]
