# SPDX-License-Identifier: Apache-2.0
"""What the tests share. CTest sets TEX_BINARY_DIR and puts the built module into PYTHONPATH."""

import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

import tex

SOURCE = Path(__file__).resolve().parents[2]
BINARY = Path(os.environ["TEX_BINARY_DIR"])
SAMPLES = SOURCE / "samples"


def pytest_configure():
    assert BINARY in Path(tex.__file__).parents, f"another module tex: {tex.__file__}"


class Commands:
    """The real commands, run in a scratch folder."""

    def __init__(self, folder):
        self.folder = folder

    def __call__(self, name, *arguments):
        return subprocess.run(
            [BINARY / name, *arguments], cwd=self.folder, check=True, capture_output=True, text=True
        ).stdout

    def floats(self, name):
        """The three planes of a file of floats."""
        image = tex.read_image(self.folder / name)
        return np.stack([image[c] for c in "RGB"], axis=2)

    def bytes(self, name):
        return (self.folder / name).read_bytes()


@pytest.fixture
def commands(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return Commands(tmp_path)


@pytest.fixture(scope="session")
def bricks():
    return SAMPLES / "bricks.png"


@pytest.fixture(scope="session")
def heights(bricks):
    return tex.read_image(bricks)["Y"]


@pytest.fixture(scope="session")
def normals(heights):
    return tex.bake(heights, bumpiness=12)
