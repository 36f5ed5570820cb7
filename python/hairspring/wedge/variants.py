"""The combinations of scenes, clips and values."""

from __future__ import annotations

import argparse
import itertools
import json
import re
from dataclasses import dataclass
from pathlib import Path


class UsageError(Exception):
    """Wrong arguments: one sentence."""


@dataclass(frozen=True)
class Variant:
    """One combination of scene, clip and values."""

    name: str
    scene: Path
    clip: Path | None
    values: tuple[tuple[str, str], ...]


def values_of(text: str) -> tuple[str, list[str]]:
    """The key and the values of `--set`."""
    key, equals, values = text.partition("=")
    if not equals or not key or not values:
        raise UsageError(f"--set {text}: expected KEY=VALUE,VALUE, such as solver.substeps=2,4,8")
    separator = ";" if ";" in values or "[" in values else ","
    return key.strip(), [v.strip() for v in values.split(separator)]


def variants(options: argparse.Namespace) -> list[Variant]:
    """All combinations, with names that are unique and safe as folders."""
    keys = [values_of(text) for text in options.set]
    for k, (key, _) in enumerate(keys):
        if any(key == other for other, _ in keys[:k]):
            raise UsageError(f"--set {key} is given twice; name all of its values at one place, such as --set {key}=2,4")
    found = []
    for scene in options.scenes:
        for clip in options.clip or [None]:
            for values in itertools.product(*(v for _, v in keys)):
                pairs = tuple((key, value) for (key, _), value in zip(keys, values))
                parts = [scene.stem] + ([clip.stem] if clip else []) + [f"{k.split('.')[-1]}-{v}" for k, v in pairs]
                name = re.sub(r"[^A-Za-z0-9.+-]+", "_", "_".join(parts)).strip("_.")
                found.append(Variant(name, scene, clip, pairs))
    names = [v.name for v in found]
    if len(set(names)) < len(names):
        found = [Variant(f"{k:03}_{v.name}", v.scene, v.clip, v.values) for k, v in enumerate(found)]
    return found


def scene_text(variant: Variant, folder: Path) -> str:
    """The scene with the values of a variant, for a file in `folder`."""
    from .. import _native

    pairs = list(variant.values)
    if variant.clip:
        pairs.append(("clip.file", json.dumps(str(variant.clip.resolve()))))
    return _native.scene_with(variant.scene.resolve(), folder, [(k, toml_value(v)) for k, v in pairs])


def toml_value(text: str) -> str:
    """A value as TOML: words without quotes are strings."""
    plain = re.fullmatch(r"[+-]?[0-9][0-9_.eE+-]*|true|false|\[.*\]|\{.*\}|\".*\"|'.*'", text)
    return text if plain else json.dumps(text)


def tasks(options: argparse.Namespace, found: list[Variant]) -> list[dict]:
    """What `run_variant` needs of each variant."""
    out = []
    for variant in found:
        folder = (options.output / variant.name).resolve()
        text = scene_text(variant, folder)
        out.append(
            {"name": variant.name, "folder": str(folder), "text": text, "frames": options.frames, "fps": options.fps}
            | {"size": options.size, "bake": options.bake}
        )
    return out
