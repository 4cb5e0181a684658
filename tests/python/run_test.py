# SPDX-License-Identifier: Apache-2.0
"""tex.run() does what the programs do."""

import pickle
import subprocess
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


def test_models_are_written(commands):
    (commands.folder / "m.glb").write_bytes((SAMPLES / "broken/N804-scale-not-positive.glb").read_bytes())
    ran = tex.run("pack-normals", ["m.glb", "-o", "fixed.glb", "--y", "up"], check=True)
    assert ran.code == 0
    before, after = (tex.read_model(commands.folder / name) for name in ("m.glb", "fixed.glb"))
    assert [each["name"] for each in after["maps"]] == [each["name"] for each in before["maps"]]
    assert [each["bytes"] for each in after["images"]] != [each["bytes"] for each in before["images"]]


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


@pytest.mark.parametrize("words", [["-o", "-"], ["-o-"], ["--output", "-"], ["--output=-"], ["-o", "/dev/stdout"],
                                   ["--output=/dev/fd/1"], ["-o/proc/self/fd/1"]], ids=" ".join)
def test_nothing_reaches_the_standard_streams_of_the_host(words, commands, capfd):
    commands("bake-normals", SAMPLES / "waves.png", "--bumpiness", "20", "-o", "w.dds")
    ran = tex.run("bake-normals", [SAMPLES / "waves.png", "--bumpiness", "20", *words])
    assert (ran.code, ran.err, ran.results) == (0, "", [])
    assert ran.out_bytes == commands.bytes("w.dds")
    assert ran.out.encode(errors="surrogateescape") == ran.out_bytes
    assert capfd.readouterr() == ("", "")


def test_documents_do_not_reach_the_streams_either(commands, capfd):
    commands("bake-normals", SAMPLES / "waves.png", "-o", "w.dds")
    ran = tex.run("check-normals", ["w.dds", "--sarif=/dev/stdout"], json=False)
    assert ran.code == 0 and '"runs"' in ran.out
    assert '"runs"' in tex.run("check-normals", ["w.dds", "--sarif", "/dev/stderr"]).err
    (commands.folder / "normals.toml").write_text('version = 1\n[[rule]]\nmatch = "*.png"\nsteps = [ { bake = {} } ]\n')
    plan = tex.run("build-normals", ["--plan", "-"], json=False)
    assert plan.code == 0 and plan.out.startswith("{"), plan.err
    for name in tex.commands():
        tex.run(name, ["--help"])
    assert capfd.readouterr() == ("", "")


def test_check_raises_what_the_command_said(commands):
    assert tex.run("bake-normals", [SAMPLES / "waves.png", "-o", "w.dds"], check=True).code == 0
    with pytest.raises(tex.RunError, match="bake-normals: exit status 3\n.*none.png") as caught:
        tex.run("bake-normals", ["none.png", "-o", "x.dds"], check=True)
    assert caught.value.ran.code == 3
    again = pickle.loads(pickle.dumps(caught.value))
    assert str(again) == str(caught.value)


def test_arguments_are_those_of_subprocess(commands):
    for wrong in ("w.png", b"w.png", Path("w.png"), None, 3, ["a", None], [3], [["a"]]):
        with pytest.raises(TypeError, match="arguments: expected"):
            tex.run("bake-normals", wrong)
        if isinstance(wrong, list):
            with pytest.raises(TypeError):
                subprocess.run(["true", *wrong], check=True)
    with pytest.raises(TypeError, match="command: expected str"):
        tex.run(None)
    with pytest.raises(ValueError, match="null byte"):
        tex.run("bake-normals", ["a\0b"])
    with pytest.raises(ValueError, match="did you mean 'bake-normals'"):
        tex.run("bake-normal")


def test_names_need_not_be_utf8(commands):
    for name in ("a\udcff.png", "b.png"):
        (commands.folder / name).write_bytes((SAMPLES / "waves.png").read_bytes())
    for pattern in ("*.png", b"*.png"):
        ran = tex.run("bake-normals", [pattern, "--out-dir", "out\udcfe", "--name", "{stem}.dds"])
        assert (ran.code, len(ran.results)) == (0, 2), ran.err
    assert sorted(path.name for path in (commands.folder / "out\udcfe").iterdir()) == ["a\udcff.dds", "b.dds"]
    assert tex.run("bake-normals", [b"a\xff.png", "-o", "x.dds"]).code == 0
