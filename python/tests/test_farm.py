"""Jobs and variants."""

import csv
import json
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import shot, tuft

import hairspring as hs

TEMPLATE = Path(__file__).parents[2] / "docs" / "pipeline" / "bake.openjd.yaml"


def test_the_job_template_runs(tmp_path):
    openjd = Path(sys.executable).with_name("openjd")
    if not openjd.exists():
        pytest.skip("openjd-cli is not installed")
    # The program as the wheel installs it, or from this checkout.
    tools = tmp_path / "bin"
    tools.mkdir()
    program = tools / "hairspring"
    program.write_text(f'#!/bin/sh\nexec {sys.executable} -m hairspring "$@"\n')
    program.chmod(0o755)
    environment = os.environ | {"PATH": f"{tools}:{os.environ['PATH']}"}
    scene = shot(tmp_path)
    parameters = [f"Scene={scene}", f"Output={tmp_path}/h.####.data", "Frames=1-5", "Checkpoint=2"]
    command = [str(openjd), "run", str(TEMPLATE), "--step", "Bake"]
    ran = subprocess.run(
        [*command, *(x for p in parameters for x in ("-p", p))], capture_output=True, text=True, env=environment, timeout=300
    )
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert len(list(tmp_path.glob("h.*.data"))) == 5
    assert "openjd_progress" in ran.stdout or "Progress: 100" in ran.stdout or "100.00" in ran.stdout


def test_progress_is_json_on_request(tmp_path, program):
    code, _, error = program("bake", shot(tmp_path), "-o", tmp_path / "h.####.data", "--frames", "1-3", "--progress", "json")
    assert code == 0
    events = [json.loads(line) for line in error.splitlines()]
    progress = [e for e in events if e["event"] == "progress"]
    assert [e["done"] for e in progress] == [1, 2, 3] and progress[0]["total"] == 3


def test_a_wedge_simulates_all_combinations_and_keeps_what_is_complete(tmp_path, program):
    scene = shot(tmp_path)
    options = ["--set", "solver.substeps=2,4", "--set", "wind.velocity=[0,0,0];[4,0,0]", "--frames", "1-3", "--size", "64x64"]
    out = tmp_path / "wedge"
    code, _, error = program("wedge", scene, *options, "-o", out, "--bake", "hair")
    assert code == 0, error
    folders = sorted(f.name for f in out.iterdir() if f.is_dir())
    assert len(folders) == 4 and all((out / f / "clip.mp4").exists() for f in folders)
    assert all(len(list((out / f).glob("hair.*.hair"))) == 3 for f in folders)
    rows = list(csv.DictReader(open(out / "table.csv")))
    assert {(r["solver.substeps"], r["wind.velocity"]) for r in rows} == {
        (n, w) for n in "24" for w in ("[0,0,0]", "[4,0,0]")
    }
    assert (out / "sheet.png").exists()
    assert all(float(r["simulate_ms"]) > 0 and int(r["simulated"]) > 0 for r in rows)
    code, _, error = program("wedge", scene, *options, "-o", out, "--bake", "hair")
    assert code == 0 and error.count(": kept") == 4


def test_a_wedge_notices_a_changed_groom(tmp_path, program):
    scene, groom = tmp_path / "shot.toml", tmp_path / "hair.data"
    scene.write_text('[[groom]]\nfile = "hair.data"\nscale = 1.0\n')
    points, offsets = tuft()
    hs.Groom(points, offsets, radii=np.full(len(points), 40e-6, np.float32)).write(groom)
    command = ["wedge", scene, "--frames", "1-2", "--size", "64x64", "-o", tmp_path / "w", "--bake", "hair"]
    assert program(*command)[0] == 0
    baked = next((tmp_path / "w").glob("*/hair.0001.hair"))
    before = baked.read_bytes()
    hs.Groom(points + np.float32([0.03, 0, 0]), offsets, radii=np.full(len(points), 40e-6, np.float32)).write(groom)
    code, _, error = program(*command)
    assert code == 0 and ": kept" not in error, error
    assert baked.read_bytes() != before


def test_a_terminated_wedge_stops_its_programs(tmp_path):
    command = [sys.executable, "-m", "hairspring", "wedge", shot(tmp_path), "--frames", "1-100000", "--size", "64x64"]
    wedge = subprocess.Popen([*command, "-o", tmp_path / "w"], stderr=subprocess.PIPE, text=True)
    pending = lambda: list((tmp_path / "w").glob("*/.hairspring-*"))  # noqa: E731
    until = time.time() + 60
    while not pending() and time.time() < until:
        time.sleep(0.05)
    assert pending()
    wedge.terminate()
    _, error = wedge.communicate(timeout=60)
    assert wedge.returncode == 130 and "interrupted" in error, error
    assert not pending() and (tmp_path / "w" / "table.csv").exists()


def test_a_wedge_reports_what_fails_and_refuses_what_is_wrong(tmp_path, program):
    code, _, error = program("wedge", shot(tmp_path), "--set", "solver.substep=2", "-o", tmp_path / "w")
    assert code == 4 and "solver.substep" in error
    code, _, error = program("wedge", tmp_path / "none.toml", "-o", tmp_path / "w")
    assert code == 3 and "was not found" in error
    scene = shot(tmp_path)
    code, _, error = program("wedge", scene, "--set", "wind.gust", "-o", tmp_path / "w")
    assert code == 2 and "expected KEY=VALUE" in error
    code, _, error = program("wedge", scene, "-o", scene)
    assert code == 2 and "is a file" in error
    code, _, error = program("wedge", scene, "-o", tmp_path / "w", "--size", "64", "--frames", "1-2")
    assert code == 1 and "invalid value '64' for '--size" in error


def test_a_wedge_runs_on_ray(tmp_path, program):
    pytest.importorskip("ray")
    code, _, error = program(
        "wedge", shot(tmp_path), "--set", "solver.substeps=2,4", "--frames", "1-2", "--size", "64x64", "-o", tmp_path / "w", "--ray", "local"
    )
    assert code == 0, error
    assert len(list((tmp_path / "w").glob("*/clip.mp4"))) == 2
