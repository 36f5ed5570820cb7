"""`hairspring wedge`."""

import contextlib
import csv
import json
import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import shot, tuft

import hairspring as hs


def write_groom(path, move=0.0):
    points, offsets = tuft()
    hs.Groom(points + np.float32([move, 0, 0]), offsets, radii=np.full(len(points), 40e-6, np.float32)).write(path)


SCENE = """\
[body]
file = "body.gltf"
[[groom]]
file = "hair.data"
scale = 1.0
[groom.maps]
length = { values = "FOLDER/length.txt" }
"""


CORNERS = [[0, -1, 0], [1, -2, 0], [-1, -2, 1], [-1, -2, -1]]


def write_body(folder, size=0.01, name="box"):
    """A tetrahedron below the hair, whose numbers are in a file of their own."""
    corners = np.float32(CORNERS) * np.float32(size)
    triangles = np.uint16([0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3])
    (folder / "body.bin").write_bytes(corners.tobytes() + triangles.tobytes())
    box = {"min": corners.min(0).tolist(), "max": corners.max(0).tolist()}
    body = {
        "asset": {"version": "2.0"},
        "buffers": [{"uri": "body.bin", "byteLength": 72}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", **box},
            {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"},
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "nodes": [{"mesh": 0, "name": name}],
        "scenes": [{"nodes": [0]}],
        "scene": 0,
    }
    (folder / "body.gltf").write_text(json.dumps(body))


def write_cache(folder, size=0.01):
    """Two positions of the vertices of the body."""
    for k, moved in enumerate((0.01, size), 1):
        text = "".join(f"v {x * moved} {y * moved} {z * moved}\n" for x, y, z in CORNERS)
        (folder / f"body.{k:04}.obj").write_text(text + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")


@pytest.fixture
def start():
    """Starts a wedge with two programs at a time that take long, and waits until each has begun to write. Whatever still
    runs after the test is ended."""
    folders = []

    def wedge(scene, out, *options):
        folders.append(out)
        command = [sys.executable, "-m", "hairspring", "wedge", scene, "--frames", "1-100000", "--size", "64x64", "-o", out]
        started = subprocess.Popen([*map(str, command), *options], stderr=subprocess.PIPE, text=True)
        # Ray takes its time to start on a machine that does other work.
        until = time.time() + 240
        while len(pending(out)) < 2 and time.time() < until and started.poll() is None:
            time.sleep(0.05)
        assert len(pending(out)) == 2
        return started

    yield wedge
    for process in [process for out in folders for process in programs_in(out)]:
        with contextlib.suppress(ProcessLookupError):
            os.kill(int(process), signal.SIGKILL)


def pending(out):
    return list(out.glob("*/.hairspring-*"))


def programs_in(folder):
    """Processes whose command line names a folder."""
    found = []
    for process in Path("/proc").iterdir():
        if process.name.isdigit() and int(process.name) != os.getpid():
            try:
                if str(folder).encode() in (process / "cmdline").read_bytes():
                    found.append(process.name)
            except OSError:
                pass
    return found


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


@pytest.mark.parametrize("options, last", [([], 7), (["--frames", "2-4"], 4)])
def test_the_picture_is_the_last_frame_of_the_clip(tmp_path, program, options, last):
    # A quarter of a second, which has another number of frames at the default rate.
    scene = shot(tmp_path, "[clip]\nkeys = [{ time = 0.0 }, { time = 0.25, rotation = [0.0, 20.0, 0.0] }]\n")
    out = tmp_path / "w"
    rate = ["--fps", "24", "--size", "64x64"]
    code, _, error = program("wedge", scene, *options, *rate, "-o", out)
    assert code == 0, error
    assert program("render", scene, "-o", tmp_path / "last.png", "--frames", last, *rate)[0] == 0
    assert (out / "shot" / "still.png").read_bytes() == (tmp_path / "last.png").read_bytes()


def test_a_wedge_notices_a_changed_groom(tmp_path, program):
    scene, groom = tmp_path / "shot.toml", tmp_path / "hair.data"
    scene.write_text('[[groom]]\nfile = "hair.data"\nscale = 1.0\n')
    write_groom(groom)
    command = ["wedge", scene, "--frames", "1-2", "--size", "64x64", "-o", tmp_path / "w", "--bake", "hair"]
    assert program(*command)[0] == 0
    baked = next((tmp_path / "w").glob("*/hair.0001.hair"))
    before = baked.read_bytes()
    write_groom(groom, move=0.03)
    code, _, error = program(*command)
    assert code == 0 and ": kept" not in error, error
    assert baked.read_bytes() != before


def test_a_wedge_runs_on_ray(tmp_path, program):
    pytest.importorskip("ray")
    code, _, error = program(
        "wedge", shot(tmp_path), "--set", "solver.substeps=2,4", "--frames", "1-2", "--size", "64x64", "-o", tmp_path / "w", "--ray", "local"
    )
    assert code == 0, error
    assert len(list((tmp_path / "w").glob("*/clip.mp4"))) == 2


@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP", "SIGINT"])
def test_an_interrupted_wedge_stops_its_programs_and_writes_its_table(tmp_path, start, name):
    if not hasattr(signal, name) or not Path("/proc/self/cmdline").exists():
        pytest.skip("needs signals and /proc")
    if signal.getsignal(getattr(signal, name)) == signal.SIG_IGN:
        pytest.skip(f"the tests run with {name} ignored, as under nohup")
    out = tmp_path / "w"
    # Three variants: two run, one waits.
    wedge = start(shot(tmp_path), out, "--set", "solver.substeps=1,2,3", "--jobs", "2")
    assert len(programs_in(out)) == 3
    wedge.send_signal(getattr(signal, name))
    _, error = wedge.communicate(timeout=60)
    assert wedge.returncode == 130, error
    assert error == "hairspring wedge: interrupted; 0 of 3 variants are done; run it again to continue\n"
    assert not programs_in(out) and not pending(out)
    rows = list(csv.DictReader(open(out / "table.csv")))
    assert len(rows) == 3 and not any(r["frames"] for r in rows)


def test_an_interrupted_wedge_keeps_what_is_done(tmp_path, program):
    scene, out = shot(tmp_path), tmp_path / "w"
    options = ["--set", "solver.substeps=1,2", "--frames", "1-2", "--size", "64x64", "-o", str(out)]
    command = [sys.executable, "-m", "hairspring", "wedge", str(scene), *options]
    wedge = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    first = wedge.stderr.readline()
    assert first.startswith("1/2 "), first
    wedge.terminate()
    _, error = wedge.communicate(timeout=60)
    assert wedge.returncode == 130 and error.endswith("variants are done; run it again to continue\n"), error
    rows = list(csv.DictReader(open(out / "table.csv")))
    assert rows[0]["frames"] == "2" and float(rows[0]["simulate_ms"]) > 0
    code, _, error = program("wedge", scene, *options)
    assert code == 0 and error.count(": kept") >= 1, error


@pytest.mark.parametrize("change", ["body", "buffer", "cache", "map", "options", "deleted"])
def test_a_wedge_runs_again_if_anything_has_changed(tmp_path, program, change):
    scene, out = tmp_path / "shot.toml", tmp_path / "w"
    write_groom(tmp_path / "hair.data")
    write_body(tmp_path)
    write_cache(tmp_path)
    (tmp_path / "length.txt").write_text("1\n" * 12)
    text = SCENE.replace("FOLDER", tmp_path.as_posix())
    if change == "cache":
        text = text.replace('"body.gltf"', '"body.0001.obj"\nvertex_cache = "body.####.obj"')
    scene.write_text(text)
    command = ["wedge", scene, "--frames", "1-2", "--size", "64x64", "-o", out]
    code, _, error = program(*command)
    assert code == 0, error
    code, _, error = program(*command)
    assert code == 0 and error.count(": kept") == 1, error
    if change == "body":
        write_body(tmp_path, name="renamed")
    elif change == "buffer":
        write_body(tmp_path, size=0.02)
    elif change == "cache":
        write_cache(tmp_path, size=0.011)
    elif change == "map":
        (tmp_path / "length.txt").write_text("0.5\n" * 12)
    elif change == "options":
        command += ["--fps", "24"]
    else:
        next(out.glob("*/clip.mp4")).unlink()
    code, _, error = program(*command)
    assert code == 0 and ": kept" not in error, error
    assert program(*command)[2].count(": kept") == 1


def test_the_table_has_the_values_of_the_report(tmp_path, program):
    scene, out = shot(tmp_path), tmp_path / "w"
    assert program("wedge", scene, "--frames", "1-2", "--size", "64x64", "-o", out)[0] == 0
    [row] = csv.DictReader(open(out / "table.csv"))
    code, output, _ = program("render", scene, "-o", tmp_path / "a.mp4", "--frames", "1-2", "--size", "64x64", "--json")
    report = json.loads(output)
    assert code == 0 and int(row["frames"]) == report["frames"]
    assert int(row["simulated"]) == report["simulated_strands"] and int(row["strands"]) == report["strands"]
    assert float(row["simulate_ms"]) > 0 and report["ms_per_frame"]["simulate"] > 0


WRONG = [
    (["--set", "wind.gust"], 2, "--set wind.gust: expected KEY=VALUE"),
    (["--set", "=3"], 2, "expected KEY=VALUE"),
    (["--set", "solver.substeps=2", "--set", "solver.substeps=4"], 2, "--set solver.substeps is given twice"),
    (["--set", "solver.substep=2"], 4, "solver.substep"),
    (["--size", "64"], 2, "invalid value '64' for '--size"),
    (["--frames", "5-2"], 2, "invalid value '5-2' for '--frames"),
    (["--fps", "x"], 2, "invalid value 'x' for '--fps"),
    (["--clip", "none.bvh"], 3, "none.bvh was not found"),
    (["--jobs", "0"], 2, "expected a whole number from 1, not '0'"),
    (["--retries=-1"], 2, "expected a whole number from 0, not '-1'"),
]


@pytest.mark.parametrize("options, expected, sentence", WRONG, ids=lambda x: "".join(x) if isinstance(x, list) else "")
def test_wrong_arguments_are_one_sentence_and_an_exit_code(tmp_path, program, options, expected, sentence):
    code, _, error = program("wedge", shot(tmp_path), "--size", "64x64", "--frames", "1-2", *options, "-o", tmp_path / "w")
    assert code == expected and sentence in error, error
    assert "Traceback" not in error and "For more information" not in error


def test_files_and_folders_that_cannot_be_used_are_refused(tmp_path, program):
    scene, out = shot(tmp_path), tmp_path / "w"
    assert program("wedge", tmp_path / "none.toml", "-o", out)[::2] == (3, f"hairspring wedge: {tmp_path}/none.toml was not found\n")
    code, _, error = program("wedge", tmp_path, "-o", out)
    assert code == 3 and error == f"hairspring wedge: {tmp_path} could not be read: Is a directory\n"
    for folder in (scene, scene / "below"):
        code, _, error = program("wedge", scene, "-o", folder)
        assert code == 2 and error == f"hairspring wedge: {scene} is a file; name a folder with -o\n"
    if Path("/proc/self").exists():
        code, _, error = program("wedge", scene, "-o", "/proc/none")
        assert code == 5 and error == "hairspring wedge: /proc/none could not be written: No such file or directory\n"
    # A file that cannot be written in the folder of a variant.
    (out / "shot").mkdir(parents=True)
    (out / "shot" / "scene.toml").mkdir()
    code, _, error = program("wedge", scene, "-o", out, "--frames", "1-2", "--size", "64x64")
    assert code == 5 and "scene.toml could not be written: Is a directory" in error and "Traceback" not in error


def test_different_errors_have_exit_code_1(tmp_path):
    from hairspring.wedge import exit_code

    assert exit_code({"a": {}, "b": {}}) == 0
    assert exit_code({"a": {"error": "x", "code": 6}, "b": {}}) == 6
    assert exit_code({"a": {"error": "x", "code": 6}, "b": {"error": "y", "code": 4}}) == 1
    assert exit_code({"a": {"error": "killed", "code": -9}}) == 1


def test_an_interrupted_wedge_stops_its_programs_on_ray(tmp_path, start):
    pytest.importorskip("ray")
    out = tmp_path / "w"
    wedge = start(shot(tmp_path), out, "--set", "solver.substeps=1,2", "--ray", "local")
    wedge.terminate()
    _, error = wedge.communicate(timeout=120)
    assert wedge.returncode == 130 and "interrupted; 0 of 2 variants are done" in error, error
    assert not pending(out) and not programs_in(out) and (out / "table.csv").exists()


def test_a_cluster_that_does_not_answer_is_an_error(tmp_path, program):
    pytest.importorskip("ray")
    with socket.socket() as unused:
        unused.bind(("127.0.0.1", 0))
        port = unused.getsockname()[1]
        for address in (f"127.0.0.1:{port}", f"ray://127.0.0.1:{port}", "127.0.0.1:99999"):
            code, _, error = program("wedge", shot(tmp_path), "-o", tmp_path / "w", "--ray", address)
            assert code == 7 and error.startswith(f"hairspring wedge: --ray {address}: nothing answers there ("), error
            assert error.count("\n") == 1


def test_a_cluster_that_cannot_be_used_is_one_sentence(tmp_path, program, monkeypatch):
    (tmp_path / "ray.py").write_text("raise ImportError\n")
    monkeypatch.setenv("PYTHONPATH", f"{tmp_path}{os.pathsep}{os.environ.get('PYTHONPATH', '')}")
    code, _, error = program("wedge", shot(tmp_path), "-o", tmp_path / "w", "--ray", "local")
    assert code == 7 and error == "hairspring wedge: ray is not installed; run `pip install 'hairspring[ray]'`\n"
