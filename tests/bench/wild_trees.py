#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# wild_trees.py BUILD [REPOSITORY]: build-normals --init on the files of ../shared/data/wild4, each repository a tree.
#
# Every file lies where its repository has it. For each tree: how many files --classify puts into the class of their
# verdict (normals, or not), how many rules --init writes, whether check-normals with its baseline is green, whether the
# manifest builds without an error, and whether the check is green after that, too: the folder then has the outputs.
# Files without a verdict about their class (random vectors) are in the tree and do not count; one colour may be either.
# The classes are also counted by the halves of wild4.py. The exit status is 1 if a manifest does not build, the first
# check is not green, or less than 98 % of the files are in the right class. Where the data are missing, it says so and
# passes.
import collections
import hashlib
import json
import os
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
DATA = os.path.join(os.path.dirname(ROOT), "shared", "data", "wild4")
NORMALS = ("normals", "object-space", "one-colour")


def labels():
    with open(os.path.join(DATA, "labels.tsv"), encoding="utf-8") as file:
        names = next(file).rstrip("\n").split("\t")
        for line in file:
            yield dict(zip(names, line.rstrip("\n").split("\t")))


def is_right(row, kind):
    if row["verdict"].startswith("must be an error"):
        return kind not in ("normals", "object-space", "unknown")
    return kind in NORMALS


def is_tune(file):
    return hashlib.sha256(os.path.basename(file).encode()).digest()[0] % 2 == 0


def run(build, folder, command, *arguments):
    return subprocess.run([os.path.join(build, command), *arguments], cwd=folder, capture_output=True, text=True,
                          check=False)


def kinds_of(build, folder):
    kinds = {}
    for line in run(build, folder, "check-normals", "--classify", "--json", ".").stdout.splitlines():
        report = json.loads(line)
        if "input" in report:
            kinds[os.path.normpath(report["input"])] = report.get("kind", "unknown")
    return kinds


def judge(build, name, rows, halves):
    right = judged = 0
    with tempfile.TemporaryDirectory() as folder:
        placed = {}
        for row in rows:
            path = row["origin"].split(" ", 1)[1]
            path = os.path.normpath(path if path not in placed else os.path.join("again", path))
            placed[path] = row
            os.makedirs(os.path.dirname(os.path.join(folder, path)), exist_ok=True)
            shutil.copyfile(os.path.join(DATA, row["file"]), os.path.join(folder, path))
        kinds = kinds_of(build, folder)
        for path, row in placed.items():
            if row["verdict"].startswith("not judged"):
                continue
            fits = is_right(row, kinds.get(path, "missing"))
            judged += 1
            right += fits
            half = halves[is_tune(row["file"])]
            half["files"] += 1
            half["right"] += fits
            if not fits:
                print(f"class: {row['file']} is {kinds.get(path, 'missing')} ({row['verdict'] or row['kind']})")
        init = run(build, folder, "build-normals", "--init")
        steps = {"init": init}
        if init.returncode == 0:
            steps["check"] = run(build, folder, "check-normals", ".", "--baseline", "normals-baseline.json")
            steps["build"] = run(build, folder, "build-normals")
            steps["again"] = run(build, folder, "check-normals", ".", "--baseline", "normals-baseline.json")
        for step, ran in steps.items():
            if ran.returncode != 0:
                print(f"{name}: {step} ends with {ran.returncode}: {ran.stderr.strip()[:2000]}{ran.stdout[-600:]}")
        rules = 0
        if init.returncode == 0:
            with open(os.path.join(folder, "normals.toml"), encoding="utf-8") as manifest:
                rules = manifest.read().count("[[rule]]")
    good = all(ran.returncode == 0 for step, ran in steps.items() if step != "again")
    words = {step: "yes" if ran.returncode == 0 else "no" for step, ran in steps.items()}
    print(f"{name:38}{len(rows):7}{f'{right}/{judged}':>12}{rules:7}{words.get('check', '-'):>8}"
          f"{words.get('build', '-'):>8}{words.get('again', '-'):>14}", flush=True)
    return right, judged, good


def main():
    if not os.path.isdir(DATA):
        print("skipped: there is no ../shared/data/wild4")
        return 0
    build = os.path.abspath(sys.argv[1])
    trees = collections.defaultdict(list)
    for row in labels():
        if " " in row["origin"]:
            trees[row["origin"].split(" ", 1)[0]].append(row)
    print(f"{'tree':38}{'files':>7}{'right':>12}{'rules':>7}{'green':>8}{'builds':>8}{'green, built':>14}")
    halves = {True: collections.Counter(), False: collections.Counter()}
    results = [judge(build, name, trees[name], halves) for name in sorted(trees)
               if len(sys.argv) < 3 or sys.argv[2] == name]
    right, judged = sum(result[0] for result in results), sum(result[1] for result in results)
    for is_first, half in halves.items():
        print(f"{'tune' if is_first else 'held out'}: {half['right']} of {half['files']} in the right class")
    return 0 if all(result[2] for result in results) and right >= 0.98 * judged else 1


if __name__ == "__main__":
    sys.exit(main())
