# SPDX-License-Identifier: Apache-2.0
"""repair(): what the rules prove is undone."""

import numpy as np
import pytest

import tex


def bumps():
    y, x = np.mgrid[0:128, 0:128] * (2.0 * np.pi / 128)
    height = 0.15 * np.sin(3 * x + 2 * y) + 0.12 * np.sin(5 * x - 4 * y + 1) + 0.1 * np.sin(2 * x + 7 * y + 2)
    normals = np.asarray(tex.bake(height.astype(np.float32), bumpiness=9, wrap="repeat"))
    return np.floor((normals + 1) / 2 * 255 + 0.5).clip(0, 255).astype(np.uint8)


def test_channels_go_back():
    clean = bumps()
    done = tex.repair(np.ascontiguousarray(clean[..., ::-1]))
    assert [(step["rule"], step["text"], step["certainty"]) for step in done["steps"]] == [
        ("N308", "exchange R and B", "safe")]
    assert done["before"].findings[0].id == "N308" and not done["left"]
    assert bytes(done["texture"].levels[0]) == clean.tobytes()
    assert tex.repair(clean)["texture"] is None


def test_likely_ones_are_asked_for():
    inverted = bumps()
    inverted[..., 2] = 255 - inverted[..., 2]
    left = tex.repair(inverted)["left"]
    assert [(finding.id, certainty) for finding, certainty in left] == [("N220", "likely")]
    assert [step["kind"] for step in tex.repair(inverted, likely=True, only=["N220"])["steps"]] == ["invert"]
    with pytest.raises(ValueError):
        tex.repair(inverted, only=["N999"])


def test_rules_have_classes():
    rows = tex.rule_repairs()
    assert {"rule": "N302", "certainty": "safe", "kind": "decode-srgb"} in rows
