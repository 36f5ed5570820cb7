"""`hairspring wedge`: many variants of a bake or a picture, on this machine or on a Ray cluster."""

from __future__ import annotations

import argparse
import hashlib
import itertools
import json
import os
import re
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path

HELP = """examples:
  hairspring wedge shot.toml --set material.hair.bend=1,4,16 --set 'wind.velocity=[0,0,0];[4,0,0]' -o out/wedge
  hairspring wedge a.toml b.toml --clip walk.bvh run.bvh -o out/wedge --bake abc
  hairspring wedge shot.toml --set solver.substeps=2,4,8 -o out/wedge --ray auto

Each variant is a folder with its scene, its log, the clip and the bake. `table.csv` and `sheet.png` show all of them.
The command can be interrupted and run again: variants that are complete are kept."""


class UsageError(Exception):
    """Wrong arguments: one sentence."""


@dataclass(frozen=True)
class Variant:
    """One combination of scene, clip and values."""

    name: str
    scene: Path
    clip: Path | None
    values: tuple[tuple[str, str], ...]


def parse_arguments(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="hairspring wedge",
        description="Simulates all combinations of scenes, clips and values of parameters.",
        epilog=HELP,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("scenes", nargs="+", type=Path, metavar="SCENE.toml")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="FOLDER", help="folder of the results")
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="KEY=A,B,C",
        help="values of a parameter, as in a scene file; separated by commas, or by semicolons if a value has commas",
    )
    parser.add_argument("--clip", nargs="+", type=Path, default=[], metavar="FILE", help="motions of the body")
    parser.add_argument("--frames", metavar="A-B", help="frames to simulate [default: the scene's motion]")
    parser.add_argument("--fps", default="30", help="frames per second [default: 30]")
    parser.add_argument("--size", default="480x480", metavar="WxH", help="size of the clips [default: 480x480]")
    parser.add_argument("--bake", choices=("hair", "usdc", "abc", "pc2"), help="also write the moving strands")
    parser.add_argument("--jobs", type=int, default=1, help="variants at a time on this machine [default: 1]")
    parser.add_argument("--retries", type=int, default=1, help="further tries of a variant that fails [default: 1]")
    parser.add_argument("--ray", metavar="ADDRESS", help="run on a Ray cluster: its address, or `local`")
    return parser.parse_args(arguments)


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
    from . import _native

    pairs = list(variant.values)
    if variant.clip:
        pairs.append(("clip.file", json.dumps(str(variant.clip.resolve()))))
    return _native.scene_with(variant.scene.resolve(), folder, [(k, toml_value(v)) for k, v in pairs])


def toml_value(text: str) -> str:
    """A value as TOML: words without quotes are strings."""
    plain = re.fullmatch(r"[+-]?[0-9][0-9_.eE+-]*|true|false|\[.*\]|\{.*\}|\".*\"|'.*'", text)
    return text if plain else json.dumps(text)


class Children:
    """The programs that run, so that an interrupt can end them."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.running: set[subprocess.Popen[str]] = set()
        self.ended = False

    def run(self, command: list[str]) -> tuple[int, str, str]:
        """Runs a program; returns its exit code, output and errors."""
        with self.lock:
            if self.ended:
                return 130, "", "interrupted"
            child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            self.running.add(child)
        try:
            output, errors = child.communicate()
        finally:
            with self.lock:
                self.running.discard(child)
        return child.returncode, output, errors

    def end(self) -> None:
        """Stops all programs, which remove their unfinished files, and starts no more."""
        with self.lock:
            self.ended = True
            for child in self.running:
                child.terminate()


CHILDREN = Children()


def key_of(task: dict, scene: Path) -> str:
    """Identifies everything that the results of a task depend on: options, version, the scene and the files that it names."""
    from . import _native

    parts = [task["text"], task["frames"], task["fps"], task["size"], task["bake"], _native.__version__]
    return hashlib.sha256(json.dumps([*parts, _native.scene_inputs(scene)]).encode()).hexdigest()


def run_variant(task: dict) -> dict:
    """Simulates one variant in its folder. Runs here or on another machine, which has the same files."""
    from . import HairspringError

    folder = Path(task["folder"])
    folder.mkdir(parents=True, exist_ok=True)
    scene, done = folder / "scene.toml", folder / "done.json"
    scene.write_text(task["text"])
    try:
        key = key_of(task, scene)
    except HairspringError as error:
        return {"error": str(error), "code": 4}
    if done.exists():
        try:
            before = json.loads(done.read_text())
        except ValueError:
            before = {}
        if before.get("key") == key:
            return before | {"kept": True}
    # A bake that was interrupted continues, unless something has changed since.
    started = folder / "started.txt"
    resume = ["--resume"] if started.exists() and started.read_text() == key else []
    started.write_text(key)
    program = [sys.executable, "-m", "hairspring", "--quiet"]
    frames = ["--frames", task["frames"]] if task["frames"] else []
    commands = [
        ["render", str(scene), "-o", str(folder / "clip.mp4"), "--fps", task["fps"], "--size", task["size"], *frames, "--json"],
        ["render", str(scene), "-o", str(folder / "still.png"), "--size", task["size"], *task["still"]],
    ]
    if task["bake"]:
        name = "hair.####.hair" if task["bake"] == "hair" else f"hair.{task['bake']}"
        commands.append(["bake", str(scene), "-o", str(folder / name), "--fps", task["fps"], *frames, *resume])
    began, result = time.time(), {}
    with open(folder / "log.txt", "a") as log:
        for command in commands:
            code, output, errors = CHILDREN.run([*program, *command])
            log.write(f"$ hairspring {' '.join(command)}\n{output}{errors}")
            if code:
                lines = errors.strip().splitlines() or [f"exit code {code}"]
                sentence = next((line.removeprefix("error: ") for line in lines if line.startswith("error: ")), lines[-1])
                return {"error": sentence, "code": code}
            if "--json" in command:
                result = json.loads(output)
    result |= {"key": key, "seconds": round(time.time() - began, 2)}
    pending = folder / ".done.json"
    pending.write_text(json.dumps(result))
    os.replace(pending, done)
    return result


def tasks(options: argparse.Namespace, found: list[Variant]) -> list[dict]:
    """What `run_variant` needs of each variant."""
    still = ["--frames", options.frames.split("-")[-1] if options.frames else "60"]
    out = []
    for variant in found:
        folder = (options.output / variant.name).resolve()
        text = scene_text(variant, folder)
        out.append(
            {"name": variant.name, "folder": str(folder), "text": text, "frames": options.frames, "fps": options.fps}
            | {"size": options.size, "bake": options.bake, "still": still}
        )
    return out


def run_here(all_tasks: list[dict], jobs: int, retries: int, report) -> None:
    """Runs tasks on this machine."""

    def attempt(task: dict) -> dict:
        for _ in range(retries + 1):
            result = run_variant(task)
            # A scene that is wrong stays wrong.
            if "error" not in result or result.get("code") in (2, 3, 4, 6, 130):
                break
        return result

    with ThreadPoolExecutor(max_workers=max(jobs, 1)) as pool:
        waiting = {pool.submit(attempt, task): task for task in all_tasks}
        try:
            for future in as_completed(waiting):
                report(waiting[future], future.result())
        except KeyboardInterrupt:
            pool.shutdown(wait=False, cancel_futures=True)
            CHILDREN.end()
            raise


def run_on_ray(all_tasks: list[dict], address: str, retries: int, report) -> None:
    """Runs tasks on a Ray cluster, which retries those whose worker is lost."""
    try:
        import ray
    except ImportError:
        raise SystemExit("hairspring wedge: ray is not installed; run `pip install 'hairspring[ray]'`") from None
    ray.init(address=address, log_to_driver=False, include_dashboard=False)
    remote = ray.remote(max_retries=retries, retry_exceptions=True)(run_variant)
    waiting = {remote.remote(task): task for task in all_tasks}
    while waiting:
        [ready], _ = ray.wait(list(waiting), num_returns=1)
        report(waiting.pop(ready), ray.get(ready))
    ray.shutdown()


def write_table(path: Path, found: list[Variant], results: dict[str, dict]) -> None:
    """Writes the values and the results of all variants."""
    import csv

    keys = list(dict.fromkeys(key for v in found for key, _ in v.values))
    measured = ["frames", "seconds", "simulate_ms", "strands", "simulated", "error"]
    with open(path, "w", newline="") as out:
        rows = csv.writer(out)
        rows.writerow(["variant", "scene", "clip", *keys, *measured])
        for v in found:
            result = results.get(v.name, {})
            result = result | {"simulate_ms": result.get("ms_per_frame", {}).get("simulate", "")}
            result["simulated"] = result.get("simulated_strands", "")
            values = dict(v.values)
            cells = [values.get(k, "") for k in keys] + [result.get(m, "") for m in measured]
            rows.writerow([v.name, v.scene.name, v.clip.name if v.clip else "", *cells])


def main(arguments: list[str]) -> int:
    """Runs the command. Returns its exit code: 0, 1 if a variant failed, 2 for wrong arguments, 130 if interrupted."""
    options = parse_arguments(arguments)
    from . import HairspringError
    from .sheet import write_sheet

    def refuse(sentence: object, code: int) -> int:
        print(f"hairspring wedge: {sentence}", file=sys.stderr)
        return code

    for scene in options.scenes:
        if not scene.exists():
            return refuse(f"{scene} was not found", 3)
    if options.output.exists() and not options.output.is_dir():
        return refuse(f"{options.output} is a file; name a folder with -o", 2)
    try:
        found = variants(options)
        todo = tasks(options, found)
    except UsageError as error:
        return refuse(error, 2)
    except HairspringError as error:
        return refuse(error, 4)
    options.output.mkdir(parents=True, exist_ok=True)
    results: dict[str, dict] = {}

    def report(task: dict, result: dict) -> None:
        results[task["name"]] = result
        state = result.get("error") or ("kept" if result.get("kept") else f"{result['seconds']} s")
        print(f"{len(results)}/{len(todo)} {task['name']}: {state}", file=sys.stderr, flush=True)

    def stop(number: int, frame: object) -> None:
        raise KeyboardInterrupt

    for name in ("SIGTERM", "SIGHUP"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), stop)
    interrupted = False
    try:
        if options.ray:
            run_on_ray(todo, options.ray, options.retries, report)
        else:
            run_here(todo, options.jobs, options.retries, report)
    except KeyboardInterrupt:
        interrupted = True
    write_table(options.output / "table.csv", found, results)
    pictures = [(v.name, options.output / v.name / "still.png") for v in found]
    write_sheet(options.output / "sheet.png", [(n, p) for n, p in pictures if p.exists()])
    if interrupted:
        print("hairspring wedge: interrupted; run the same command again to continue", file=sys.stderr)
        return 130
    return 1 if any("error" in r for r in results.values()) else 0
