#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tables.py FOLDER CHROMIUM: prints RESULTS.md from FOLDER/<engine>/verdicts.json.

Beside each are "packages", what drew it, "newest", its newest release on npm, and "day".
"""

import json
import pathlib
import sys

import cases
import judge
import models

NAMES = {"three": "three.js", "babylon": "Babylon.js", "playcanvas": "PlayCanvas", "phaser": "Phaser",
         "cesium": "Cesium", "filament": "filament", "model-viewer": "model-viewer", "godot": "Godot",
         "blender": "Blender"}


def row(cells):
    return "| " + " | ".join(cells) + " |"


def table(head, rows):
    return "\n".join([row(head), "|" + "---|" * len(head), *map(row, rows)]) + "\n"


def cell(case):
    """What is seen, in a table: "right", or what is wrong, with the halves."""
    if not case["halves_of"]:
        said = case["said"].splitlines()[0] if case["said"] else ""
        return f"refused: {said[:60]}" if said else "refused"
    numbers = "; ".join(" ".join(map(str, four)) for four in case["halves_of"])
    seen = case["seen"].replace("|", "and")
    agrees = f", {case['agrees']:g} %" if "agrees" in case else ""
    return (f"right{agrees} ({numbers})" if case["right"] else f"**{seen}** ({numbers})")


def files_table(engine, found):
    places = [place for place, _ in cases.PLACES[engine]]
    rows = []
    for name in cases.FILES:
        cells = {case["place"]: cell(case) for case in found if case["table"] == "files" and case["name"] == name}
        if cells:
            rows.append([name, *(cells[place] for place in places)])
    return table(["file", *places], rows)


def spheres_table(found):
    engines = [engine for engine in NAMES if any(case["table"] == "spheres" for case in found[engine])]
    rows = []
    for name in models.SPHERES:
        if name == models.PICTURE:
            continue
        ones = [next(case for case in found[engine] if case["table"] == "spheres" and case["name"] == name)
                for engine in engines]
        rows.append([name, *(("" if one["right"] else "**wrong** ") + ", ".join(map(str, one["apart"] or ["refused"]))
                             for one in ones)])
    return table(["normal map", *(NAMES[engine] for engine in engines)], rows)


def models_table(found):
    engines = [engine for engine in NAMES if any(case["table"] == "models" for case in found[engine])]
    rows = []
    for kind in models.kinds():
        cells = []
        for engine in engines:
            case = next(case for case in found[engine]
                        if case["table"] == "models" and (case["name"], case["place"]) == (kind.name, kind.tangents))
            cells.append("right" if case["right"] else f"**{case['seen'].replace('|', 'and')}**")
        wanted = kind.corner + (", a dent" if kind.dent else "")
        rows.append([kind.name, {"": "none", "map": "for these UVs"}.get(kind.tangents, f"for {kind.tangents}"),
                     "" if wanted == "upper left" else wanted, *cells])
    return table(["kind of glTF", "TANGENT", "where", *(NAMES[engine] for engine in engines)], rows)


# Why pictures that are right are not those of preview-normals.
REASONS = {
    "model-viewer": "it has no lamps: the light is a disc in an environment picture, blurred for a rough surface",
}


def pixels_table(found):
    """The best of each engine's pictures of the PNG with green up, beside that of preview-normals."""
    rows = []
    for engine, name in NAMES.items():
        ours = [case for case in found[engine] if "agrees" in case and
                (case["name"] in ("PNG, +Y", "plain", "no highlights"))]
        best = max(ours, key=lambda case: case["agrees"])
        where = best["place"] if best["table"] == "files" else f"glTF, {best['name']}"
        rows.append([name, where, f"{best['agrees']:g} %", "" if best["agrees"] >= 99 else REASONS.get(engine, "?")])
    return table(["engine", "surface", "pixels within 3 codes", "why not"], rows)


def main():
    folder, chromium = pathlib.Path(sys.argv[1]), sys.argv[2]
    missing = [engine for engine in NAMES if not (folder / engine / "day").exists()]
    if missing:
        sys.exit(f"RESULTS.md stays as it is until these have been drawn: {', '.join(missing)}")
    found = {engine: json.loads((folder / engine / "verdicts.json").read_text(encoding="utf-8"))["cases"]
             for engine in NAMES}

    def said(engine, name):
        return (folder / engine / name).read_text(encoding="utf-8").strip()
    print(f"""# What engines draw

Made by `tests/engines/engines.sh`, in {chromium.split(" built")[0]} with SwiftShader; Godot with llvmpipe, Blender with
Cycles, both of Debian sid.

A bump in the upper left corner of a map is lit from above and from the left. "right" is a bump in the right corner
that is light in its upper half under the first light and in its left half under the second; numbers are the means of
the top, bottom, left and right halves, in codes of 255. "y wrong" is lit from below instead, "x wrong" from the right,
and a dent from both.

""" + table(["engine", "packages", "newest on npm that day", "drawn on"],
            [[NAMES[engine], *(said(engine, name) for name in ("packages", "newest", "day"))] for engine in NAMES]))
    print("## Files\n\nIn the default settings of each engine, except for those that a column names. Models have no "
          "TANGENT\nif the column does not say so; the texture replaces the normal map of the model's material.\n")
    for engine in NAMES:
        if cases.PLACES[engine]:
            print(f"### {NAMES[engine]}\n\n" + files_table(engine, found[engine]))
    print("## The same pixels\n\nThe share of pixels, under both lights, that are within 3 codes of 255 of the picture "
          "that preview-normals\nmakes of the same file, as the tables above have it beside \"right\"; here the best of "
          "PNG, +Y. Each picture is first\nmultiplied by one factor, in linear light, that makes the plane around the "
          "bump equal, and Cesium's tone\nmapping is undone. A square whose bump is not in the upper left corner is not "
          "compared.\n\n" + pixels_table(found))
    print("## What Godot bakes\n\nImage.bump_map_to_normal_map() with a scale of 1:\n\n" + said("godot", "baked.txt") +
          "\n")
    print('## Models\n\nA square with a map of +Y in PNG. "where" is the corner in which the bump must be seen, if '
          "it is another one.\n\n" + models_table(found))
    print("## Spheres\n\nA sphere of glTF with details.png, the normals of samples/bricks.png, and the one that "
          "pack-normals has made of it\n(KHR_texture_basisu): how far each is from the picture of that with the PNG, "
          "in codes of 255, the mean and\nthe 99th percentile of its pixels under both lights. UASTC must be within "
          f"{judge.AS_MEAN} and {judge.AS_MOST}, a sphere without a map not.\n\n" + spheres_table(found), end="")


if __name__ == "__main__":
    main()
