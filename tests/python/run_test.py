# SPDX-License-Identifier: Apache-2.0
"""tex.run() does what the programs do."""

import threading
from pathlib import Path

import pytest

import tex
from conftest import SAMPLES


def test_all_commands_are_there():
    assert "bake-normals" in tex.commands() and len(tex.commands()) >= 11
    for name in tex.commands():
        assert tex.run(name, ["--version"], json=False).out.startswith(name)


def test_a_command_writes_the_bytes_of_the_program(commands):
    for name in ("bricks.png", "waves.png"):
        (commands.folder / name).write_bytes((SAMPLES / name).read_bytes())
    ran = tex.run("bake-normals", ["*.png", "--out-dir", "out", "--bumpiness", "12"])
    assert (ran.code, ran.err) == (0, "")
    assert [Path(each["output"]).name for each in ran.results] == ["bricks.dds", "waves.dds"]
    assert ran.results[0]["extent"] == [512, 512]
    commands("bake-normals", "bricks.png", "-o", "c.dds", "--bumpiness", "12")
    assert commands.bytes("out/bricks.dds") == commands.bytes("c.dds")


def test_failures_are_codes_with_their_messages(commands):
    assert tex.run("bake-normals", ["none.png", "-o", "x.dds"])[0] == 3
    ran = tex.run("bake-normals", ["--nonsense"])
    assert ran.code == 2 and "--nonsense" in ran.err and ran.results == []
    with pytest.raises(ValueError, match="'bake' must be one of 'bake-normals'|'bake' must be one of bake-normals"):
        tex.run("bake")


def test_findings_are_dictionaries(commands):
    commands("bake-normals", SAMPLES / "bricks.png", "-o", "n.dds", "--y", "down")
    ran = tex.run("check-normals", [commands.folder / "n.dds", "--require", "y=up"])
    assert ran.code == 1 and [f["id"] for f in ran.results[0]["findings"]] == ["N401"]
    assert tex.run("check-normals", ["--list"], json=False).results == []


def test_patterns_without_files_and_options_stay(commands):
    assert "*.none" in tex.run("bake-normals", ["*.none", "-o", "x.dds"]).err
    (commands.folder / "a[b].png").write_bytes((SAMPLES / "waves.png").read_bytes())
    assert tex.run("bake-normals", ["a[b].png", "-o", "x.dds"]).code == 0
    assert tex.run("bake-normals", ["a[b].png", "-o", "y.dds"], glob=False).code == 0


def test_threads_run_commands(commands):
    codes = []

    def work(k):
        codes.append(tex.run("bake-normals", [SAMPLES / "waves.png", "-o", f"{k}.dds"]).code)

    threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert codes == [0] * 4 and len({commands.bytes(f"{k}.dds") for k in range(4)}) == 1
