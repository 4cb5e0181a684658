# SPDX-License-Identifier: Apache-2.0
"""pip makes a wheel without the network, and it works where it is unpacked."""

import os
import subprocess
import sys
import zipfile

from conftest import BINARY, SAMPLES, SOURCE

CODE = """
import sys, tex
assert tex.__file__.startswith(sys.argv[1]), tex.__file__
tex.write_texture("n.tif", tex.pack(tex.bake(tex.read_image(sys.argv[2])["Y"]), "rgb8"))
print(tex.read_image("n.tif"), tex.reader_info()["program"])
"""


def test_a_wheel_works_where_it_is_unpacked(tmp_path):
    environment = {**os.environ, "TEX_BUILD": str(BINARY), "PIP_NO_INDEX": "1", "PIP_DISABLE_PIP_VERSION_CHECK": "1"}
    done = subprocess.run([sys.executable, "-m", "pip", "wheel", "--no-deps", "-w", tmp_path, SOURCE / "libtex/python"],
                          env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    [wheel] = tmp_path.glob("*.whl")
    place = tmp_path / "site"
    with zipfile.ZipFile(wheel) as archive:
        assert archive.testzip() is None
        archive.extractall(place)
        for entry in archive.infolist():
            (place / entry.filename).chmod(entry.external_attr >> 16 & 0o777 or 0o644)
    run = subprocess.run([sys.executable, "-P", "-c", CODE, place, SAMPLES / "waves.png"], cwd=tmp_path, text=True,
                         env={**os.environ, "PYTHONPATH": str(place)}, capture_output=True, check=False)
    assert run.returncode == 0, run.stderr
    assert run.stdout.startswith("<tex.Image") and run.stdout.rstrip().endswith(str(place / "tex/tex-reader"))
