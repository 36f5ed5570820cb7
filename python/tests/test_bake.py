"""Bakes that a farm can trust."""

import json
import os
import random
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from conftest import shot

import hairspring as hs

FRAMES = 40


def bake(*arguments):
    return [sys.executable, "-m", "hairspring", "bake", *map(str, arguments)]


def frames_of(folder):
    return {f.name: f.read_bytes() for f in sorted(folder.glob("h.*.data"))}


def changed_after(folder, time):
    """Number of frames that were written after a time."""
    return sum(f.stat().st_mtime > time for f in folder.glob("h.*.data"))


def test_kill_9_at_random_moments_gives_the_undisturbed_result(tmp_path):
    scene = shot(tmp_path, "[wind]\nvelocity = [1.0, 0.0, 0.5]\n")
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    options = ["--frames", f"1-{FRAMES}", "--checkpoint", "6", "--threads", "1"]
    whole = subprocess.run(bake(scene, "-o", tmp_path / "a" / "h.####.data", *options), capture_output=True, text=True)
    assert whole.returncode == 0, whole.stderr
    command = bake(scene, "-o", tmp_path / "b" / "h.####.data", *options, "--resume")
    rng, resumed = random.Random(1), False
    for round in range(10):
        log = tmp_path / f"log{round}"
        with open(log, "w") as errors:
            process = subprocess.Popen(command, stderr=errors, stdout=subprocess.DEVNULL)
        # Killed at a random moment after a random number of further frames.
        began, more = time.time(), rng.randrange(1, 9)
        while process.poll() is None and changed_after(tmp_path / "b", began) < more:
            time.sleep(0.001)
        time.sleep(rng.uniform(0, 0.01))
        os.kill(process.pid, signal.SIGKILL)
        process.wait()
        resumed |= "continues from frame" in log.read_text()
    last = subprocess.run(command, capture_output=True, text=True)
    assert last.returncode == 0, last.stderr
    assert resumed or "continues from frame" in last.stderr
    undisturbed, result = frames_of(tmp_path / "a"), frames_of(tmp_path / "b")
    assert len(undisturbed) == FRAMES and undisturbed == result


def test_a_chunk_begins_at_a_checkpoint(tmp_path, program):
    scene = shot(tmp_path)
    whole, chunk = tmp_path / "h.####.data", ["--checkpoint", "5"]
    assert program("bake", scene, "-o", whole, "--frames", "1-20", *chunk)[0] == 0
    before = frames_of(tmp_path)
    for number in range(16, 21):
        (tmp_path / f"h.{number:04}.data").unlink()
    code, _, error = program("bake", scene, "-o", whole, "--frames", "16-20", *chunk, "--resume")
    assert code == 0 and "continues from frame 16" in error
    assert frames_of(tmp_path) == before


def test_a_damaged_checkpoint_is_said_and_an_earlier_one_is_used(tmp_path, program):
    scene, options = shot(tmp_path), ["-o", tmp_path / "h.####.data", "--frames", "1-12", "--checkpoint", "4"]
    assert program("bake", scene, *options)[0] == 0
    before = frames_of(tmp_path)
    last = tmp_path / "h.checkpoints" / "step.000008"
    last.write_bytes(last.read_bytes()[:-10])
    (tmp_path / "h.0012.data").unlink()
    code, _, error = program("bake", scene, *options, "--resume")
    assert code == 0 and "step.000008 is damaged" in error and "continues from frame 5" in error
    assert frames_of(tmp_path) == before


def test_a_resume_with_a_changed_wind_is_refused(tmp_path, program):
    scene, options = shot(tmp_path), ["-o", tmp_path / "h.####.data", "--frames", "1-3", "--checkpoint", "2"]
    assert program("bake", scene, *options)[0] == 0
    shot(tmp_path, "[wind]\nvelocity = [3.0, 0.0, 0.0]\n")
    code, _, error = program("bake", scene, *options, "--resume")
    assert code == 2 and "shot.toml has changed" in error


def test_a_resume_with_a_changed_layer_of_a_usd_file_is_refused(tmp_path, program):
    pytest.importorskip("pxr")
    layer = """#usda 1.0
( metersPerUnit = 1 )
def BasisCurves "hair"
{
    int[] curveVertexCounts = [3]
    point3f[] points = [(0, 1, 0), (0, 0.95, 0), (0, 0.9, 0)]
    uniform token type = "linear"
}
"""
    (tmp_path / "layer.usda").write_text(layer)
    (tmp_path / "root.usda").write_text("#usda 1.0\n( metersPerUnit = 1\n subLayers = [@layer.usda@] )\n")
    command = ["bake", tmp_path / "root.usda", "-o", tmp_path / "h.####.data", "--frames", "1-2"]
    assert program(*command)[0] == 0
    inputs = json.loads((tmp_path / "h.bake.data.json").read_text())["origin"]["inputs"]
    assert sorted(inputs) == ["layer.usda", "root.usda"]
    (tmp_path / "layer.usda").write_text(layer.replace("(0, 1, 0)", "(0, 1.1, 0)"))
    code, _, error = program(*command, "--resume")
    assert code == 2 and "layer.usda has changed" in error


def test_a_point_cache_has_the_frames_of_the_bake(tmp_path, program):
    scene = shot(tmp_path)
    assert program("bake", scene, "-o", tmp_path / "h.####.data", "--frames", "1-3")[0] == 0
    assert program("bake", scene, "-o", tmp_path / "h.pc2", "--frames", "1-3")[0] == 0
    data = (tmp_path / "h.pc2").read_bytes()
    version, points = np.frombuffer(data, "<i4", 2, 12)
    first, step = np.frombuffer(data, "<f4", 2, 20)
    samples = int(np.frombuffer(data, "<i4", 1, 28)[0])
    assert data[:12] == b"POINTCACHE2\0" and (version, first, step, samples) == (1, 1, 1, 3)
    found = np.frombuffer(data, "<f4", -1, 32).reshape(samples, points, 3)
    for k in range(3):
        groom = hs.Groom.read(tmp_path / f"h.000{k + 1}.data", scale=1.0)
        assert (found[k] == groom.points).all()


@pytest.mark.parametrize("option", [["--samples", "2"], ["--over", "x.usda"], ["--keep-frames"]])
def test_options_of_one_file_are_refused_for_numbered_files(tmp_path, program, option):
    code, _, error = program("bake", shot(tmp_path), "-o", tmp_path / "h.####.data", *option)
    assert code == 2 and "need one file of moving strands" in error
    code, _, error = program("bake", shot(tmp_path), "-o", tmp_path / "h.####.data", "--frames", "1-5", "--start", "3")
    assert code == 2 and "frame 1 is before frame 3" in error


def test_a_vertex_cache_of_numbered_meshes_moves_the_body(tmp_path, program):
    quad = "f 1 2 3 4\n"
    for k in range(6):
        corners = [(x + 0.02 * k, 0.0, z) for x, z in ((-0.1, -0.1), (-0.1, 0.1), (0.1, 0.1), (0.1, -0.1))]
        text = "".join(f"v {x} {y} {z}\n" for x, y, z in corners) + quad
        (tmp_path / f"body.{k + 1:04}.obj").write_text(text)
    hs.Groom(np.float32([[0, 0.01 * i, 0] for i in range(10)]), [0, 10]).write(tmp_path / "h.data")
    scene = tmp_path / "shot.toml"
    scene.write_text(
        '[body]\nfile = "body.0001.obj"\nscale = 1.0\nvertex_cache = "body.####.obj"\nvertex_rate = 30\n'
        '[[groom]]\nfile = "h.data"\nscale = 1.0\n[solver]\ncollide_body = false\n'
    )
    code, _, error = program("bake", scene, "-o", tmp_path / "out.####.data")
    assert code == 0, error
    assert "6 frames at 30 Hz" in error
    root = hs.Groom.read(tmp_path / "out.0006.data", scale=1.0).points[0]
    np.testing.assert_allclose(root, [0.1, 0, 0], atol=1e-5)
    (tmp_path / "body.0003.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n")
    code, _, error = program("bake", scene, "-o", tmp_path / "out.####.data")
    assert code == 4 and "changes of topology" in error and "shot.toml, line 4" in error
