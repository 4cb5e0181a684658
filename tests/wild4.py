#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# wild4.py BUILD [--files]: what check-normals finds in ../shared/data/wild4, beside the verdicts of labels.tsv.
#
# The first table has a row for each rule: in how many files it was found when the verdicts were made ("before") and is
# found now, how many of these were judged false, and how many pictures without a verdict have it now alone. The second
# has the files by kind, separately for the half that sets thresholds (the first byte of the SHA-256 of the name is
# even) and for the half that is held out; "class" counts the files that --classify puts where the verdict does. With
# --files, all files whose errors, warnings or classes differ follow.
#
# The exit status is 1 if a map has an error that its verdict calls false, if a map without a verdict has an error that
# it did not have, if a picture that is no normal map has none, or if a safe repair would change a sound map. Where the
# data are missing, it says so and passes.
import collections
import hashlib
import json
import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
COLUMNS = ["files", "error", "warning", "wrong", "class"]
# Maps with a fault that safe repairs undo: a constant blue, z from 0 to 1, the sRGB curve.
FAULTY = {
    "normal/urho3d_Kachujin_normal.png",
    "normal/usdwg_r_normal_map_reversed_x_0_bias_z.png",
    "normal/ogre_floor_bump.PNG",
}
DATA = os.path.join(os.path.dirname(ROOT), "shared", "data", "wild4")


def labels():
    with open(os.path.join(DATA, "labels.tsv"), encoding="utf-8") as file:
        names = next(file).rstrip("\n").split("\t")
        for line in file:
            yield dict(zip(names, line.rstrip("\n").split("\t")))


def findings_now(build, files):
    with tempfile.NamedTemporaryFile("w", suffix=".txt") as names:
        names.write("".join(os.path.join(DATA, file) + "\n" for file in files))
        names.flush()
        command = [os.path.join(build, "check-normals"), "--json", "--files-from", names.name]
        output = subprocess.run(command, capture_output=True, text=True, check=False).stdout
    found, classes = {}, {}
    for line in output.splitlines():
        report = json.loads(line)
        if "input" in report:
            file = os.path.relpath(report["input"], DATA)
            found[file] = {finding["id"] + finding["severity"][0] for finding in report["findings"]}
            classes[file] = report.get("kind", "unknown")
    return found, classes


def changed_by_safe_repairs(build, files):
    with tempfile.NamedTemporaryFile("w", suffix=".txt") as names:
        names.write("".join(os.path.join(DATA, file) + "\n" for file in files))
        names.flush()
        command = [os.path.join(build, "repair-normals"), "--dry-run", "--json", "--files-from", names.name]
        output = subprocess.run(command, capture_output=True, text=True, check=False).stdout
    changed = {}
    for line in output.splitlines():
        report = json.loads(line)
        if report.get("repairs"):
            changed[os.path.relpath(report["input"], DATA)] = ", ".join(step["text"] for step in report["repairs"])
    return changed


def is_tune(file):
    return hashlib.sha256(os.path.basename(file).encode()).digest()[0] % 2 == 0


def main():
    if not os.path.isdir(DATA):
        print("skipped: there is no ../shared/data/wild4")
        return 0
    rows = list(labels())
    now, classes = findings_now(sys.argv[1], [row["file"] for row in rows])
    rules = collections.defaultdict(collections.Counter)
    kinds = collections.defaultdict(collections.Counter)
    bad, changed = [], []
    for row in rows:
        file, verdict = row["file"], row["verdict"]
        before = set(row["findings of 3bb4925e"].split())
        after = {finding for finding in now.get(file, set()) if finding[-1] != "n"}
        is_picture = verdict.startswith("must be an error")
        false = {part.split()[0] for part in verdict.split(";") if " false" in part or " wrong words" in part}
        for finding in before | after:
            rule = rules[finding]
            rule["before"] += finding in before
            rule["now"] += finding in after
            rule["false before"] += finding[:-1] in false and finding in before
            rule["false now"] += finding[:-1] in false and finding in after
            rule["new"] += not is_picture and finding in after and finding not in before
        has_error = any(finding[-1] == "e" for finding in after)
        part = kinds["picture" if is_picture else row["kind"], "tune" if is_tune(file) else "held out"]
        part["files"] += 1
        part["error"] += has_error
        is_normal = classes.get(file, "unknown") in ("normals", "object-space", "one-colour", "unknown")
        part["class"] += is_normal != is_picture or is_picture and classes.get(file) == "one-colour"
        if "--files" in sys.argv and is_normal == is_picture:
            print(f"class: {file} {classes.get(file)}  ({verdict})")
        part["warning"] += any(finding[-1] == "w" for finding in after)
        wrong = is_picture and not has_error or any(
            finding[-1] == "e" and (finding[:-1] in false or finding not in before) for finding in after
            if not is_picture and row["kind"] != "data")
        part["wrong"] += wrong
        if wrong:
            bad.append(file)
        if before != after:
            changed.append((file, before, after, verdict))
    columns = ["before", "now", "false before", "false now", "new"]
    print(f"{'finding':10}" + "".join(f"{name:>14}" for name in columns))
    for finding in sorted(rules):
        print(f"{finding:10}" + "".join(f"{rules[finding][name]:14}" for name in columns))
    print(f"\n{'kind':22}" + "".join(f"{name:>10}" for name in COLUMNS))
    for kind in sorted(kinds):
        part = kinds[kind]
        print(f"{kind[0] + ', ' + kind[1]:22}" +
              "".join(f"{part[name]:10}" for name in COLUMNS))
    if "--files" in sys.argv:
        print()
        for file, before, after, verdict in changed:
            print(f"{file}: {' '.join(sorted(before)) or '-'} -> {' '.join(sorted(after)) or '-'}  ({verdict})")
    for file in bad:
        print("wrong:", file, " ".join(sorted(now.get(file, set()))))
    maps = [row["file"] for row in rows if row["kind"] in ("normal", "labpbr")]
    changed = changed_by_safe_repairs(sys.argv[1], maps)
    faulty = len(changed.keys() & FAULTY)
    print(f"safe repairs change {len(changed)} of {len(maps)} maps, of which {faulty} have the fault")
    harmed = sorted(changed.keys() - FAULTY)
    for file in harmed:
        print("changed:", file, changed[file])
    return 1 if bad or harmed else 0


if __name__ == "__main__":
    sys.exit(main())
