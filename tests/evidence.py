#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""evidence.py BUILD [XML...]: writes tests/EVIDENCE.md: what was tested, how, and when. Numbers come from the build folder
BUILD (ctest), from the files of the clone, and from the results that the gate and the nightly run left as JUnit files."""

import json
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]

# Who judges: what none of the tests' authors wrote.
JUDGES = [
    ("formulas of kernels and filters", "plain loops in double precision, `tests/reference`"),
    ("decoders of BC, EAC and ASTC", "Mesa, libsquish, libastcenc, OpenImageIO"),
    ("files: DDS, PNG, EXR, TGA, BMP, TIFF and others", "OpenImageIO, libpng, OpenEXR, ImageMagick"),
    ("KTX2", "Khronos' validator and three.js, by hand (`tests/ktx.sh`, `tests/browser/three.sh`)"),
    ("tangents", "the reference implementation of MikkTSpace, meshoptimizer"),
    ("rays", "Embree and Blender's Cycles, by hand (`tests/bench/RAYS.md`, `tests/blender_bake.sh`)"),
    ("shading and previews", "Mesa; Blender, Godot and three.js by hand (`tests/engines`)"),
    ("tex_c.h", "the C++ verbs, byte for byte; samples in C, Rust and Python print one sum, and in C# where mono is installed"),
]

# What is not shown by a test here, so that nobody has to look for it.
OPEN = [
    "Mutation testing: by hand alone. Of 98 single mistakes in the code that one review named, tests kill 85; 11 are equal "
    "in effect, and 2 are reads past an end that only a sanitizer sees. No tool has tried the rest.",
    "Fuzzing: the nightly run gives each target a minute by default (`FUZZ_SECONDS`). Longer runs are recorded by hand: on "
    "26 November 2026, tga (2.5 million inputs), bmp (0.5), raw (4.8), grid (3.2: HGT, ESRI grids, BIL), gltf (0.2: JSON, "
    "GLB, data URIs, extensions) and meshopt (3.4) had 20 minutes each on a busy machine, without a finding; rays had 70 minutes twice at the lowest "
    "priority, linked by hand from the sources that it needs: 132,454 inputs with the instruction sets of the processor, "
    "114,029 with one lane.",
    "Draco: `tests/fuzz/draco.py` sends damaged buffers through the reader program, without feedback of coverage and "
    "without sanitizers: 37,808 models in 20 minutes on 26 November 2026, of which 5,096 were read, 9 took longer than "
    "their two seconds, and all others were refused in one sentence.",
    "GPUs: block decoders were compared with software renderers, not with graphics cards.",
    "The Windows and macOS builds: none.",
]


def run(*words):
    return subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=True).stdout


def tests_by_label(build):
    """The number of tests of ctest with each label."""
    found = json.loads(run("ctest", "--test-dir", build, "--show-only=json-v1"))
    labels = Counter()
    for test in found["tests"]:
        values = [p["value"] for p in test.get("properties", []) if p["name"] == "LABELS"]
        labels[values[0][0] if values else "none"] += 1
    return labels


def results(paths):
    """The sums of JUnit files: (name, time, tests, failures, skipped)."""
    for path in paths:
        suite = ElementTree.parse(path).getroot()
        tests, failed, skipped, disabled = (int(suite.get(key) or 0) for key in
                                            ("tests", "failures", "skipped", "disabled"))
        yield Path(path).stem, (suite.get("timestamp") or "")[:10], tests, failed, skipped + disabled


def bytes_matrix():
    """The files of which the bytes are fixed: by the commands, and by libtex."""
    golden = ROOT / "tests/golden"
    commands = len((golden / "commands.txt").read_text(encoding="utf-8").splitlines())
    files = len(list(golden.glob("*.dds.txt"))) + len(list(golden.glob("*.ktx2.txt")))
    return commands, files


def nightly():
    text = (ROOT / "tests/NIGHTLY.md").read_text(encoding="utf-8")
    return re.search(r"^\| step .*?(?=\n\n|\Z)", text, re.S | re.M).group(0).strip()


def main():
    build = str(Path(sys.argv[1]).resolve())
    date, commit = run("git", "log", "-1", "--format=%cs %h").split()
    labels = tests_by_label(build)
    targets = sorted(path.name[:-9] for path in (ROOT / "tests/fuzz").glob("*_fuzz.cpp"))
    corpus = Counter(path.relative_to(ROOT / "tests/fuzz/corpus").parts[0]
                     for path in (ROOT / "tests/fuzz/corpus").rglob("*") if path.is_file())
    commands, files = bytes_matrix()
    rows = list(results(sys.argv[2:]))
    text = f"""# Evidence

What was tested, how, and when: made by `tests/evidence.py` at {commit} ({date}). [CONTRIBUTING.md](../CONTRIBUTING.md#test)
says how to run all of it; the figures of speed are in [bench/RESULTS.md](bench/RESULTS.md).

## Tests

{sum(labels.values())} tests of ctest, and a step of the nightly run for what takes longer.

| tier | tests |
|---|--:|
""" + "".join(f"| {label} | {count} |\n" for label, count in sorted(labels.items())) + """
## Who judges

| what | beside |
|---|---|
""" + "".join(f"| {what} | {judge} |\n" for what, judge in JUDGES) + f"""
Real maps and meshes, which nobody here made, are beside the clone (`../shared/data`). Thresholds of check-normals are set
on half of them and reported on the other half.

## The same bytes

The commands make {commands} outputs of the samples, whose hashes are in `tests/golden/commands.txt`; {files} files of
libtex are fixed byte for byte. A test makes them on each instruction set of the processor (AVX2 in the gate, all in the
nightly run), with 1, 2, 3 and 8 threads; the nightly run repeats it with clang, and on arm64 under QEMU.

Three exceptions: heights that OpenColorIO converted; EXR inputs compressed with DWAA or DWAB, on processors without AVX;
and the compression of PNG, EXR, TIFF, TGA, BMP and JPEG outputs, with another build of the encoding library.

## Fuzzing

{len(targets)} targets; every normal run replays {sum(corpus.values())} files, under the address and undefined-behaviour
sanitizers in the gate.

| target | files |
|---|--:|
""" + "".join(f"| {target} | {corpus.get(target, 0) or ''} |\n" for target in targets) + """
## The nightly run

""" + nightly() + "\n"
    if rows:
        text += "\n## Last results\n\n| step | date | tests | failed | skipped |\n|---|---|--:|--:|--:|\n"
        text += "".join(f"| {name} | {when} | {tests} | {failed} | {skipped} |\n"
                        for name, when, tests, failed, skipped in rows)
    text += "\n## Not shown\n\n" + "".join(f"* {line}\n" for line in OPEN)
    (ROOT / "tests/EVIDENCE.md").write_text(text, encoding="utf-8")


main()
