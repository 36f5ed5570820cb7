"""Jobs and variants."""

import csv
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import shot

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
    code, _, error = program("wedge", scene, *options, "-o", out, "--bake", "hair")
    assert code == 0 and error.count(": kept") == 4


def test_a_wedge_reports_what_fails_and_refuses_what_is_wrong(tmp_path, program):
    code, _, error = program("wedge", shot(tmp_path), "--set", "solver.substep=2", "-o", tmp_path / "w")
    assert code == 4 and "solver.substep" in error
    code, _, error = program("wedge", tmp_path / "none.toml", "-o", tmp_path / "w")
    assert code == 4 and "was not found" in error


def test_a_wedge_runs_on_ray(tmp_path, program):
    pytest.importorskip("ray")
    code, _, error = program(
        "wedge", shot(tmp_path), "--set", "solver.substeps=2,4", "--frames", "1-2", "--size", "64x64", "-o", tmp_path / "w", "--ray", "local"
    )
    assert code == 0, error
    assert len(list((tmp_path / "w").glob("*/clip.mp4"))) == 2
