"""One variant: a clip, a picture and a bake in a folder of its own."""

from __future__ import annotations

import hashlib
import json
import os
import sys
import time
from pathlib import Path
from typing import TextIO

from .programs import CHILDREN


def key_of(task: dict, scene: Path) -> str:
    """Identifies everything that the results of a task depend on: options, version, the scene and the files that it names."""
    from .. import _native

    parts = [task["text"], task["frames"], task["fps"], task["size"], task["bake"], _native.__version__]
    return hashlib.sha256(json.dumps([*parts, _native.scene_inputs(scene)]).encode()).hexdigest()


class ProgramError(Exception):
    """A program failed: one sentence, and its exit code."""

    def __init__(self, sentence: str, code: int) -> None:
        super().__init__(sentence)
        self.code = code


def run_program(arguments: list[str], log: TextIO) -> str:
    """Runs the program, and logs what it prints. Returns its standard output."""
    code, output, errors = CHILDREN.run([sys.executable, "-m", "hairspring", "--quiet", *arguments])
    log.write(f"$ hairspring {' '.join(arguments)}\n{output}{errors}")
    if code:
        lines = errors.strip().splitlines() or [f"the program ended with code {code}"]
        sentence = next((line.removeprefix("error: ") for line in lines if line.startswith("error: ")), lines[-1])
        raise ProgramError(sentence, code)
    return output


def run_variant(task: dict) -> dict:
    """Simulates one variant in its folder. Runs here or on another machine, which has the same files."""
    try:
        return simulate_variant(task)
    except ProgramError as error:
        return {"error": str(error), "code": error.code}
    except OSError as error:
        return {"error": unwritable(error, task["folder"]), "code": 5}


def unwritable(error: OSError, path: Path | str) -> str:
    """A sentence for a file that could not be written."""
    return f"{error.filename or path} could not be written: {error.strerror or error}"


def simulate_variant(task: dict) -> dict:
    """As `run_variant`, with an exception if a program fails or a file cannot be written."""
    from .. import HairspringError

    if CHILDREN.ended:
        return {"error": "interrupted", "code": 130}
    folder = Path(task["folder"])
    folder.mkdir(parents=True, exist_ok=True)
    scene, done = folder / "scene.toml", folder / "done.json"
    scene.write_text(task["text"])
    try:
        key = key_of(task, scene)
    except HairspringError:
        # The program finds the same error and knows its exit code.
        key = ""
    if key and done.exists():
        try:
            before = json.loads(done.read_text())
        except ValueError:
            before = {}
        if isinstance(before, dict) and before.get("key") == key and all((folder / name).exists() for name in before.get("files", [])):
            return before | {"kept": True}
    # A bake that was interrupted continues, unless something has changed since.
    started = folder / "started.txt"
    resume = ["--resume"] if key and started.exists() and started.read_text() == key else []
    started.write_text(key)
    # The earlier results are replaced from here on.
    done.unlink(missing_ok=True)
    began, rate = time.time(), ["--fps", task["fps"]]
    frames = ["--frames", task["frames"]] if task["frames"] else []
    render = ["render", str(scene), "--size", task["size"], *rate]
    with open(folder / "log.txt", "a") as log:
        result = json.loads(run_program([*render, "-o", str(folder / "clip.mp4"), *frames, "--json"], log))
        # A clip of the whole motion begins at frame 1.
        last = task["frames"].split("-")[-1] if task["frames"] else str(result["frames"])
        run_program([*render, "-o", str(folder / "still.png"), "--frames", last], log)
        if task["bake"]:
            name = "hair.####.hair" if task["bake"] == "hair" else f"hair.{task['bake']}"
            run_program(["bake", str(scene), "-o", str(folder / name), *rate, *frames, *resume], log)
    files = sorted(f.name for f in folder.iterdir() if f.is_file() and not f.name.startswith(".") and f != done)
    result |= {"key": key, "files": files, "seconds": round(time.time() - began, 2)}
    pending = folder / ".done.json"
    pending.write_text(json.dumps(result))
    os.replace(pending, done)
    return result
