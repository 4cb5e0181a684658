#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compiles every source and every private header alone, without code, and prints what fails.

    tests/alone.py BUILD [COMPILER [UNITY_BUILD]]

BUILD is a folder that CMake has configured without unity builds and with compile_commands.json. Unity builds hide a
missing include, because another source of the folder has it; so do precompiled headers, which this script leaves out. A
header whose source includes it first has been compiled alone with it. So have the sources that UNITY_BUILD, a folder
that was built without precompiled headers, does not put together with others: they are left out.
"""

import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Sources and headers of other systems, and what each instruction set includes again.
OTHER_SYSTEMS = re.compile(r"_(windows|bsd|other)\.(cpp|h)$|_off\.(cpp|h)$")
INCLUDE = re.compile(r'^#include ["<]([^">]+)[">]', re.MULTILINE)


def flags_of(command):
    """The flags of a compile command that decide what the source means: not the output, nor how the code is made."""
    words = shlex.split(command)
    words = words[next(i for i, word in enumerate(words) if "++" in word.rsplit("/", 1)[-1]) + 1:]
    flags, skip = [], 0
    for i, word in enumerate(words):
        if skip:
            skip -= 1
        elif word in ("-o", "-MF", "-MT", "-MQ", "-include", "-Xclang", "-include-pch"):
            skip = 1
        elif word == "-c":
            skip = 1  # the source
        elif not re.match(r"-O|-g|-M|-Winvalid-pch|-fpch", word):
            flags.append(word)
    # One instruction set stands for all: their code is the same text.
    return [*flags, "-DHWY_COMPILE_ONLY_SCALAR", "-fsyntax-only", "-Werror"]


def compile_alone(compiler, flags, path, text=None):
    if "clang" in compiler:
        flags = [flag for flag in flags if flag != "-Wno-restrict"]
    # The text of a header's check is read from standard input, so that the header is not the main file.
    arguments = ["-x", "c++", "-"] if text else [str(path)]
    run = subprocess.run([compiler, *flags, *arguments], input=text, capture_output=True, text=True, cwd=ROOT)
    return None if run.returncode == 0 else run.stderr


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    compiler = sys.argv[2] if len(sys.argv) > 2 else "c++"
    commands = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        source = pathlib.Path(entry["file"])
        if source.is_relative_to(ROOT) and not source.is_relative_to(build):
            commands.setdefault(source.relative_to(ROOT), flags_of(entry["command"]))
    compiled = set()
    if len(sys.argv) > 3:
        unity = json.loads((pathlib.Path(sys.argv[3]) / "compile_commands.json").read_text())
        compiled = {pathlib.Path(entry["file"]) for entry in unity}
    jobs = [(path, flags, None) for path, flags in commands.items()
            if path.parts[0] in ("libtex", "tools") and ROOT / path not in compiled]

    for header in sorted([*ROOT.glob("libtex/src/**/*.h"), *ROOT.glob("tools/**/*.h")]):
        path = header.relative_to(ROOT)
        if OTHER_SYSTEMS.search(path.name):
            continue
        source = path.with_suffix(".cpp")
        name = path.relative_to("libtex/src" if path.parts[0] == "libtex" else "tools").as_posix()
        if source in commands:
            first = INCLUDE.search((ROOT / source).read_text())
            if first and first.group(1) in (name, path.name):
                continue
        near = [flags for other, flags in commands.items() if other.parent == path.parent]
        near = near or [flags for other, flags in commands.items() if other.parts[0] == path.parts[0]]
        # Sources of one folder may be in several programs: those that see the most folders see those of the header. A
        # header has functions that nobody calls here.
        flags = max(near, key=lambda words: sum(word == "-isystem" or word.startswith("-I") for word in words))
        jobs.append((path, [*flags, "-Wno-unused-function"], f'#include "{name}"\n'))

    with concurrent.futures.ThreadPoolExecutor(int(os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", os.cpu_count()))) as pool:
        errors = list(pool.map(lambda job: compile_alone(compiler, job[1], ROOT / job[0], job[2]), jobs))
    failed = 0
    for (path, _, _), error in zip(jobs, errors):
        if error:
            failed += 1
            print(f"{path} does not compile alone:\n{error}")
    print(f"{compiler}: {len(jobs) - failed} files compile alone, {failed} do not")
    return 1 if failed else 0


sys.exit(main())
