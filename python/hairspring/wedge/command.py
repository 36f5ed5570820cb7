"""The command line of `hairspring wedge`, its table and its exit code."""

from __future__ import annotations

import argparse
import signal
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

from .programs import CHILDREN, SIGNALS, end_on_signals
from .runners import UnavailableError, run_here, run_on_ray
from .task import unwritable
from .variants import UsageError, Variant, tasks, variants

HELP = """examples:
  hairspring wedge shot.toml --set material.hair.bend=1,4,16 --set 'wind.velocity=[0,0,0];[4,0,0]' -o out/wedge
  hairspring wedge a.toml b.toml --clip walk.bvh run.bvh -o out/wedge --bake abc
  hairspring wedge shot.toml --set solver.substeps=2,4,8 -o out/wedge --ray auto

Each variant is a folder with its scene, its log, the clip, a picture of the clip's last frame and the bake. `table.csv` and
`sheet.png` show all of them.
The command can be interrupted and run again: variants that are complete are kept."""


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
    from .. import HairspringError
    from ..sheet import write_sheet

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
