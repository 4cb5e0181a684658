# SPDX-License-Identifier: Apache-2.0
"""The scripts of samples/python run."""

import importlib.util
import os
import re
import subprocess
import sys
import types

import numpy as np

import tex
from conftest import SAMPLES, SOURCE

SCRIPTS = SAMPLES / "python"


def run(*arguments, **environment):
    return subprocess.run([sys.executable, *arguments], capture_output=True, text=True, check=False,
                          env={**os.environ, **environment})


def test_bake_folder(tmp_path):
    folder = tmp_path / "heights"
    folder.mkdir()
    for name in ("bricks.png", "waves.png"):
        (folder / name).write_bytes((SAMPLES / name).read_bytes())
    done = run(SCRIPTS / "bake_folder.py", folder, tmp_path / "out")
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("bricks.png: slopes from -") and len(done.stdout.splitlines()) == 2
    assert tex.check(tmp_path / "out/waves.dds", require={"format": "dxt5nm", "mips": "full"}).levels == 8
    (folder / "broken.png").write_bytes(b"nonsense")
    done = run(SCRIPTS / "bake_folder.py", folder, tmp_path / "out")
    assert done.returncode == 3 and "broken.png" in done.stderr and len(done.stdout.splitlines()) == 2


class Pixels:
    def __init__(self, count):
        self.values = np.zeros(count, np.float32)

    def foreach_get(self, target):
        target[:] = self.values

    def foreach_set(self, values):
        self.values[:] = values


class Images(dict):
    """What the script uses of bpy.data.images."""

    def new(self, name, width, height, float_buffer, is_data):
        assert float_buffer and is_data
        image = types.SimpleNamespace(size=(width, height), pixels=Pixels(width * height * 4), pack=lambda: None)
        self[name] = image
        return image


def test_blender_bake(tmp_path, monkeypatch):
    heights = tex.read_image(SAMPLES / "bricks.png")["Y"]
    images, saved = Images(), []
    source = images.new("Height", 512, 512, True, True)
    source.pixels.foreach_set(np.repeat(heights[::-1, :, None], 4, axis=2).ravel())
    save = types.SimpleNamespace(save_mainfile=lambda: saved.append(True))
    bpy = types.SimpleNamespace(data=types.SimpleNamespace(images=images), ops=types.SimpleNamespace(wm=save))
    monkeypatch.setitem(sys.modules, "bpy", bpy)
    spec = importlib.util.spec_from_file_location("blender_bake", SCRIPTS / "blender_bake.py")
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    script.main("Height", str(tmp_path / "n.dds"))
    n = tex.bake(heights, bumpiness=8)
    expected = tex.encode_file(tex.pack(tex.build_mip_chain(n)), "dds")
    assert (tmp_path / "n.dds").read_bytes() == expected and saved == [True]
    stored = images["Height normals"].pixels.values.reshape(512, 512, 4)[::-1, :, :3]
    np.testing.assert_allclose(stored * 2 - 1, n, atol=1e-6)


def test_check_in_pytest(tmp_path):
    n = tex.bake(tex.read_image(SAMPLES / "bricks.png")["Y"], bumpiness=12)
    chain = tex.build_mip_chain(n)
    tex.write_texture(tmp_path / "good_n.dds", tex.pack(chain))
    arguments = ("-m", "pytest", "-q", "-p", "no:cacheprovider", SCRIPTS / "test_normals.py")
    done = run(*arguments, NORMALS=str(tmp_path))
    assert done.returncode == 0 and "1 passed" in done.stdout, done.stdout + done.stderr
    tex.write_texture(tmp_path / "bad_n.dds", tex.pack(chain, y_axis="down"))
    done = run(*arguments, NORMALS=str(tmp_path))
    assert done.returncode == 1 and "N401" in done.stdout and "1 failed, 1 passed" in done.stdout


def test_the_readme_runs(commands):
    (commands.folder / "rock.png").write_bytes((SAMPLES / "bricks.png").read_bytes())
    readme = (SOURCE / "libtex/python/README.md").read_text(encoding="utf-8")
    exec(re.search(r"^```python\n(.*?)^```$", readme, re.DOTALL | re.MULTILINE).group(1), {})
    assert tex.read_texture("out/rock.ktx2").encoding == "dxt5nm"
