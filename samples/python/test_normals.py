# SPDX-License-Identifier: Apache-2.0
"""Fails if a normal map of the project has errors: NORMALS=assets python3 -m pytest test_normals.py"""

import os
from pathlib import Path

import pytest
import tex

FOLDER = Path(os.environ.get("NORMALS", "."))


@pytest.mark.parametrize("path", sorted(FOLDER.rglob("*_n.dds")), ids=str)
def test_normal_map(path):
    report = tex.check(path, require={"y": "up", "mips": "full", "format": "dxt5nm"})
    errors = [f"{finding.id}: {finding.message}" for finding in report if finding.severity == "error"]
    assert not errors, "\n".join(errors)
