"""Jobs of render farms."""

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
