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
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path
from types import FrameType
from typing import Any

HELP = """examples:
  hairspring wedge shot.toml --set material.hair.bend=1,4,16 --set 'wind.velocity=[0,0,0];[4,0,0]' -o out/wedge
  hairspring wedge a.toml b.toml --clip walk.bvh run.bvh -o out/wedge --bake abc
  hairspring wedge shot.toml --set solver.substeps=2,4,8 -o out/wedge --ray auto

Each variant is a folder with its scene, its log, the clip and the bake. `table.csv` and `sheet.png` show all of them.
The command can be interrupted and run again: variants that are complete are kept."""


class UsageError(Exception):
    """Wrong arguments: one sentence."""


class UnavailableError(Exception):
    """The machine lacks what the command needs: one sentence."""


@dataclass(frozen=True)
class Variant:
    """One combination of scene, clip and values."""

    name: str
    scene: Path
    clip: Path | None
    values: tuple[tuple[str, str], ...]


def at_least(least: int) -> Callable[[str], int]:
    """Reads a whole number that is not below `least`."""

    def read(text: str) -> int:
        if not text.isascii() or not text.isdigit() or int(text) < least:
            raise argparse.ArgumentTypeError(f"expected a whole number from {least}, not {text!r}")
        return int(text)

    return read


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
    parser.add_argument("--jobs", type=at_least(1), default=1, help="variants at a time on this machine [default: 1]")
    parser.add_argument("--retries", type=at_least(0), default=1, help="further tries of a variant that fails [default: 1]")
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
        # A signal handler takes the lock too, in the middle of `end`: it must not wait for itself.
        self.lock = threading.RLock()
        self.running: set[subprocess.Popen[str]] = set()
        self.ended = False

    def run(self, command: list[str]) -> tuple[int, str, str]:
        """Runs a program; returns its exit code, output and errors. The code is 130 if `end` stopped it."""
        with self.lock:
            if self.ended:
                return 130, "", "interrupted"
            child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            self.running.add(child)
        try:
            while True:
                # Ray cancels a task with an exception that does not interrupt a wait without a limit.
                try:
                    output, errors = child.communicate(timeout=0.5)
                    break
                except subprocess.TimeoutExpired:
                    continue
        except BaseException:
            child.terminate()
            child.wait()
            raise
        finally:
            with self.lock:
                self.running.discard(child)
        # A program that has not installed its handlers yet is ended by the signal itself.
        return 130 if self.ended and child.returncode else child.returncode, output, errors

    def end(self) -> None:
        """Stops all programs, which remove their unfinished files, and starts no more. A second call stops them immediately."""
        with self.lock:
            self.ended = True
            for child in self.running:
                child.terminate()


CHILDREN = Children()
SIGNALS = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]


def end_on_signals(before: dict[signal.Signals, Any]) -> None:
    """Lets interrupts stop the programs. `before` holds the earlier handlers; a signal that they ignore stays ignored."""

    def stop(number: int, frame: FrameType | None) -> None:
        CHILDREN.end()

    for number, handler in before.items():
        if handler != signal.SIG_IGN:
            signal.signal(number, stop)


def key_of(task: dict, scene: Path) -> str:
    """Identifies everything that the results of a task depend on: options, version, the scene and the files that it names."""
    from . import _native

    parts = [task["text"], task["frames"], task["fps"], task["size"], task["bake"], _native.__version__]
    return hashlib.sha256(json.dumps([*parts, _native.scene_inputs(scene)]).encode()).hexdigest()


def run_variant(task: dict) -> dict:
    """Simulates one variant in its folder. Runs here or on another machine, which has the same files."""
    try:
        return simulate_variant(task)
    except OSError as error:
        return {"error": unwritable(error, task["folder"]), "code": 5}


def unwritable(error: OSError, path: Path | str) -> str:
    """A sentence for a file that could not be written."""
    return f"{error.filename or path} could not be written: {error.strerror or error}"


def simulate_variant(task: dict) -> dict:
    """As `run_variant`, with an exception if a file cannot be written."""
    from . import HairspringError

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
        if before.get("key") == key and all((folder / name).exists() for name in before.get("files", [])):
            return before | {"kept": True}
    # A bake that was interrupted continues, unless something has changed since.
    started = folder / "started.txt"
    resume = ["--resume"] if key and started.exists() and started.read_text() == key else []
    started.write_text(key)
    # The earlier results are replaced from here on.
    done.unlink(missing_ok=True)
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
                lines = errors.strip().splitlines() or [f"the program ended with code {code}"]
                sentence = next((line.removeprefix("error: ") for line in lines if line.startswith("error: ")), lines[-1])
                return {"error": sentence, "code": code}
            if "--json" in command:
                result = json.loads(output)
    files = sorted(f.name for f in folder.iterdir() if f.is_file() and not f.name.startswith(".") and f != done)
    result |= {"key": key, "files": files, "seconds": round(time.time() - began, 2)}
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


Report = Callable[[dict, dict], None]
"""Receives a task and its result."""


def run_here(all_tasks: list[dict], jobs: int, retries: int, report: Report) -> None:
    """Runs tasks on this machine."""

    def attempt(task: dict) -> dict:
        for _ in range(retries + 1):
            result = run_variant(task)
            # A scene that is wrong stays wrong.
            if "error" not in result or result.get("code") in (2, 3, 4, 6, 130):
                break
        return result

    with ThreadPoolExecutor(max_workers=jobs) as pool:
        waiting = {pool.submit(attempt, task): task for task in all_tasks}
        for future in as_completed(waiting):
            result = future.result()
            if not (CHILDREN.ended and result.get("code") == 130):
                report(waiting[future], result)


def run_on_worker(task: dict) -> dict:
    """As `run_variant`, in a process of Ray. The cancellation of a task arrives as an interrupt, which must not be ignored."""
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGINT, signal.default_int_handler)
    return run_variant(task)


def run_on_ray(all_tasks: list[dict], address: str, retries: int, report: Report, signals: dict[signal.Signals, Any]) -> None:
    """Runs tasks on a Ray cluster, which retries those whose worker is lost. `signals` are as for `end_on_signals`."""
    try:
        import ray
    except ImportError:
        raise UnavailableError("ray is not installed; run `pip install 'hairspring[ray]'`") from None
    try:
        ray.init(address=address, log_to_driver=False, include_dashboard=False)
    except (ConnectionError, RuntimeError, ValueError) as error:
        sentence = (str(error).splitlines() or ["no answer"])[0]
        raise UnavailableError(f"--ray {address}: the cluster cannot be used: {sentence}") from None
    remote = ray.remote(max_retries=retries, retry_exceptions=True)(run_on_worker)
    # Ray has replaced the handlers.
    end_on_signals(signals)
    waiting = {remote.remote(task): task for task in all_tasks}
    while waiting and not CHILDREN.ended:
        for ready in ray.wait(list(waiting), num_returns=1, timeout=0.5)[0]:
            try:
                result = ray.get(ready)
            except ray.exceptions.RayError as error:
                result = {"error": f"the task was lost on the cluster: {str(error).splitlines()[0]}", "code": 1}
            report(waiting.pop(ready), result)
    # The tasks end their programs and wait for them. Ray itself would kill the programs, and their unfinished files would stay.
    for unfinished in waiting:
        ray.cancel(unfinished)
    if waiting:
        ray.wait(list(waiting), num_returns=len(waiting), timeout=20)
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


def exit_code(results: dict[str, dict]) -> int:
    """The code of the variants that failed, if all have the same; otherwise 1. 0 if none failed."""
    codes = {r["code"] for r in results.values() if "error" in r}
    if not codes:
        return 0
    [code, *others] = codes
    return 1 if others or code < 0 else code


def main(arguments: list[str]) -> int:
    """Runs the command. Returns its exit code: 0, that of the variants that failed, 2 for wrong arguments, 130 if interrupted."""
    options = parse_arguments(arguments)
    CHILDREN.ended = False
    before: dict[signal.Signals, Any] = {}
    if threading.current_thread() is threading.main_thread():
        before = {number: signal.getsignal(number) for number in SIGNALS if signal.getsignal(number) is not None}
    end_on_signals(before)
    try:
        return run(options, before)
    finally:
        for number, handler in before.items():
            # After an interrupt, another one while Python exits must not change the exit code.
            signal.signal(number, signal.SIG_IGN if CHILDREN.ended else handler)


def refuse(sentence: object, code: int) -> int:
    """Prints an error and returns its exit code."""
    print(f"hairspring wedge: {sentence}", file=sys.stderr)
    return code


def run(options: argparse.Namespace, signals: dict[signal.Signals, Any]) -> int:
    """Runs all variants and writes the table and the sheet. Returns the exit code of the command."""
    from . import HairspringError
    from .sheet import write_sheet

    for scene in options.scenes:
        try:
            scene.read_bytes()
        except FileNotFoundError:
            return refuse(f"{scene} was not found", 3)
        except OSError as error:
            return refuse(f"{scene} could not be read: {error.strerror}", 3)
    for part in (options.output, *options.output.parents):
        if part.exists() and not part.is_dir():
            return refuse(f"{part} is a file; name a folder with -o", 2)
    try:
        found = variants(options)
        todo = tasks(options, found)
        options.output.mkdir(parents=True, exist_ok=True)
    except UsageError as error:
        return refuse(error, 2)
    except HairspringError as error:
        return refuse(error, 4)
    except OSError as error:
        return refuse(unwritable(error, options.output), 5)
    results: dict[str, dict] = {}

    def report(task: dict, result: dict) -> None:
        results[task["name"]] = result
        state = result.get("error") or ("kept" if result.get("kept") else f"{result['seconds']} s")
        print(f"{len(results)}/{len(todo)} {task['name']}: {state}", file=sys.stderr, flush=True)

    if options.ray:
        try:
            run_on_ray(todo, options.ray, options.retries, report, signals)
        except UnavailableError as error:
            return refuse(error, 7)
    else:
        run_here(todo, options.jobs, options.retries, report)
    pictures = [(v.name, options.output / v.name / "still.png") for v in found]
    try:
        write_table(options.output / "table.csv", found, results)
        write_sheet(options.output / "sheet.png", [(n, p) for n, p in pictures if p.exists()])
    except OSError as error:
        return refuse(unwritable(error, options.output), 5)
    if CHILDREN.ended:
        return refuse(f"interrupted; {len(results)} of {len(todo)} variants are done; run it again to continue", 130)
    return exit_code(results)
