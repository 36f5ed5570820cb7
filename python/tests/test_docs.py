"""The examples of the documentation run."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def examples():
    for page in ("README.md", "docs/python.md"):
        for k, code in enumerate(re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(), re.S)):
            yield pytest.param(code, id=f"{page}-{k + 1}")


@pytest.mark.parametrize("code", list(examples()))
def test_examples_run(code, capsys):
    exec(compile(code, "example", "exec"), {})


def test_the_tutorial_runs_and_draws_its_plots(tmp_path, monkeypatch):
    pytest.importorskip("matplotlib")
    monkeypatch.chdir(tmp_path)
    text = (ROOT / "docs/tutorial/python.md").read_text()
    session = {}
    for code in re.findall(r"```python\n(.*?)```", text, re.S):
        exec(compile(code, "tutorial", "exec"), session)
    drawn = {path.stem for path in tmp_path.glob("*.png")}
    assert drawn == set(re.findall(r"pictures/tutorial/python-(\w+)\.png", text)) and len(drawn) == 4


def test_type_stubs_match_the_module(tmp_path):
    pytest.importorskip("mypy")
    import subprocess
    import sys

    # Settings are attributes that the extension module looks up by name; its slots are not in the class's dictionary.
    dynamic = tmp_path / "dynamic"
    dynamic.write_text("".join(f"hairspring._native.{c}.__getattr__\n" for c in ("Material", "Solver", "Volume", "Wind")))
    checked = subprocess.run(
        [sys.executable, "-m", "mypy.stubtest", "hairspring._native", "--concise", "--allowlist", str(dynamic)],
        capture_output=True,
        text=True,
        cwd=ROOT / "python" / "tests",
    )
    assert checked.returncode == 0, checked.stdout + checked.stderr
