"""A round trip through Blender (bpy): hair on a mesh that moves and deforms goes out, is baked, and comes back."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("bpy")

FRAMES = 12

EXPORT = """
import bpy, numpy as np, sys
out, frames = sys.argv[1], int(sys.argv[2])
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.frame_start, scene.frame_end, scene.render.fps = 1, frames, 24
bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12, radius=0.1, location=(0, 0, 1.5))
head = bpy.context.object
head.name = "head"
head.shape_key_add(name="Basis")
key = head.shape_key_add(name="wide")
for v in key.data:
    v.co.x *= 1.3
key.value = 0
key.keyframe_insert("value", frame=1)
key.value = 1
key.keyframe_insert("value", frame=frames)
head.keyframe_insert("location", frame=1)
head.location.y = 0.2
head.keyframe_insert("location", frame=frames)
data = bpy.data.hair_curves.new("hair")
count, points = 40, 12
data.add_curves([points] * count)
angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
t = np.linspace(0, 0.12, points)
normal = np.stack([0.6 * np.cos(angle), 0.6 * np.sin(angle), np.full(count, 0.8)], 1)
xyz = np.float32(normal[:, None] * (0.1 + t)[None, :, None] + [0, 0, 1.5])
data.position_data.foreach_set("vector", xyz.reshape(-1))
radius = data.attributes.get("radius") or data.attributes.new("radius", "FLOAT", "POINT")
radius.data.foreach_set("value", np.full(count * points, 4e-5, np.float32))
hair = bpy.data.objects.new("hair", data)
scene.collection.objects.link(hair)
if out.endswith(".abc"):
    bpy.ops.wm.alembic_export(filepath=out, start=1, end=frames, export_hair=True, export_custom_properties=False)
else:
    bpy.ops.wm.usd_export(filepath=out, export_animation=True, export_hair=True, export_materials=False)
np.save(sys.argv[3], xyz.reshape(-1, 3))
"""

IMPORT = """
import bpy, numpy as np, sys
path, frames = sys.argv[1], int(sys.argv[2])
bpy.ops.wm.read_factory_settings(use_empty=True)
if path.endswith(".abc"):
    bpy.ops.wm.alembic_import(filepath=path, set_frame_range=False, as_background_job=False)
else:
    bpy.ops.wm.usd_import(filepath=path)
bpy.context.scene.render.fps = 24
[hair] = [o for o in bpy.context.scene.objects if o.type == "CURVES" and "guides" not in o.name]
found = []
for frame in range(1, frames + 1):
    bpy.context.scene.frame_set(frame)
    evaluated = hair.evaluated_get(bpy.context.evaluated_depsgraph_get())
    data = evaluated.data
    xyz = np.empty(3 * len(data.position_data), np.float32)
    data.position_data.foreach_get("vector", xyz)
    m = np.array(evaluated.matrix_world)
    found.append(xyz.reshape(-1, 3) @ m[:3, :3].T + m[:3, 3])
np.save(sys.argv[3], np.array(found))
"""


def blender(script: str, *arguments) -> None:
    """Runs a script with bpy in a process of its own: bpy holds one scene, and has a USD library of its own."""
    done = subprocess.run([sys.executable, "-c", script, *map(str, arguments)], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr[-2000:]


@pytest.mark.parametrize("suffix", ["usdc", "abc"])
def test_hair_goes_out_of_blender_is_baked_and_comes_back(tmp_path: Path, program, suffix: str):
    pytest.importorskip("pxr" if suffix == "usdc" else "alembic3d")
    import hairspring as hs

    asset, baked = tmp_path / f"asset.{suffix}", tmp_path / f"sim.{suffix}"
    blender(EXPORT, asset, FRAMES, tmp_path / "out.npy")
    rest = np.load(tmp_path / "out.npy")
    groom = hs.Groom.read(asset, scale=1.0)
    to_y_up = lambda p: p[..., [0, 2, 1]] * [1, 1, -1]
    np.testing.assert_allclose(groom.points, to_y_up(rest), atol=1e-5)
    np.testing.assert_allclose(groom.radii, 4e-5, rtol=1e-3)
    options = ["--fps", "24", "--guides", "all", "--frames", f"1-{FRAMES}", "--scale", "1"]
    code, _, error = program("bake", asset, "-o", tmp_path / "sim.####.hair", *options)
    assert code == 0, error
    assert "move the body's vertices" in error
    code, _, error = program("bake", asset, "-o", baked, *options)
    assert code == 0, error
    blender(IMPORT, baked, FRAMES, tmp_path / "back.npy")
    back = to_y_up(np.load(tmp_path / "back.npy"))
    for frame in range(FRAMES):
        expected = hs.Groom.read(tmp_path / f"sim.{frame + 1:04}.hair", up="y").points
        np.testing.assert_allclose(back[frame], expected, atol=1e-5)
    # The roots stay on the skin, which moves by 0.2 m and gets wider.
    roots = back[-1].reshape(40, 12, 3)[:, 0]
    np.testing.assert_allclose(roots[:, 2].mean(), -0.2, atol=0.01)
    assert np.ptp(roots[:, 0]) > 1.2 * np.ptp(rest.reshape(40, 12, 3)[:, 0, 0])
