#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""judge.py: says what is seen in the pictures of cases.json, in the current folder; see page.js.

A bump lit from above is light in its upper half and dark in its lower one; a dent is the opposite. From the left, the
same holds for the left and the right half. The judge looks for the bump in the four corners of its square, since a
picture that lies upside down or is mirrored has it in another one, and measures halves around its centre. It adds
"seen", "right", and the halves to each case, and writes verdicts.json. It fails if another thing is seen than a case
wants.

A picture that is right and upright is also compared with that of preview-normals for the same file, in ours: "agrees"
is the share of pixels, under both lights, that are within 3 codes of it. How bright a light is is each engine's own
matter, so its picture is first multiplied by one factor, in linear light, that makes the plane around the bump equal;
a tone mapping that cannot be turned off is undone before.

Spheres are compared with the one that has a PNG, pixel by pixel under both lights: "apart" is the mean and the 99th
percentile of the differences in codes of 255. Files of UASTC must be "as with the PNG", and what has no normal map must
not.
"""

import json
import math
import pathlib
import statistics
import struct
import sys

import models
from cases import AS_PICTURE

CENTRE = (0.266, 0.281)  # of the bump, from the corner that it is in, as a share of the square
RADIUS = 0.18
LEAST = 12  # codes of 255 between halves that count as a difference
CODES = 3
# What does not encode its colours as sRGB: (engine, words of the place).
LINEAR = [("babylon", "own geometry"), ("phaser", "image"), ("filament", "")]
AS_MEAN, AS_MOST = 2, 12  # codes of 255 between spheres: their mean, and that of all but 1 % of the pixels
CORNERS = {"upper left": (0, 0), "upper right": (1, 0), "lower left": (0, 1), "lower right": (1, 1)}


def halves(rows, corner):
    """The means of the bump's top, bottom, left and right halves."""
    height, width = len(rows), len(rows[0])
    at_x, at_y = (abs(far - share) for far, share in zip(CORNERS[corner], CENTRE))
    found = {"top": [], "bottom": [], "left": [], "right": []}
    for j, row in enumerate(rows):
        y = (j + 0.5) / height - at_y
        for i, code in enumerate(row):
            x = (i + 0.5) / width - at_x
            if math.hypot(x, y) < RADIUS:
                found["top" if y < 0 else "bottom"].append(code)
                found["left" if x < 0 else "right"].append(code)
    return [statistics.fmean(codes) for codes in found.values()]


def unevenness(rows, corner):
    """How far a quarter of the square is from the codes of the plane around the bump."""
    (far_x, far_y), height, width = CORNERS[corner], len(rows) // 2, len(rows[0]) // 2
    plane = statistics.median(code for row in rows for code in row)
    return sum(abs(code - plane) for row in rows[far_y * height:(far_y + 1) * height]
               for code in row[far_x * width:(far_x + 1) * width])


def look_at(above, left):
    """What is seen in one square: words, the corner, and the four halves under the light that tells them apart."""
    apart = {corner: unevenness(above, corner) + unevenness(left, corner) for corner in CORNERS}
    corner = max(apart, key=apart.get)
    top, bottom, side, other = halves(above, corner)
    _, _, left_half, right_half = halves(left, corner)
    numbers = [round(n) for n in (top, bottom, left_half, right_half)]
    if max(max(row) for row in above + left) < LEAST:
        return "black", corner, numbers
    if statistics.median(code for row in above for code in row) < LEAST:
        return "dark where the map is flat", corner, numbers

    def sign(difference):
        return (difference > LEAST) - (difference < -LEAST)
    y, x, across = sign(top - bottom), sign(left_half - right_half), sign(side - other)
    words = {(1, 1): "bump", (-1, -1): "dent", (1, -1): "x wrong", (-1, 1): "y wrong", (0, 0): "flat",
             (1, 0): "x flat", (0, 1): "y flat", (-1, 0): "y wrong, x flat", (0, -1): "x wrong, y flat"}[y, x]
    if across != 0 and 4 * abs(side - other) > abs(top - bottom):
        degrees = math.degrees(math.atan2(side - other, top - bottom))
        words = f"turned by {abs(degrees):.0f} degrees"
    if words in ("bump", "dent") and not 0.8 < (top + bottom + 1) / (left_half + right_half + 1) < 1.25:
        words += ", all of which leans"
    return words, corner, numbers


def linear(code):
    c = code / 255
    return c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4


def without_tones(light):
    """Before the tone mapping that Cesium always applies, Khronos PBR Neutral, below its shoulder."""
    return light + 0.04 if light >= 0.04 else math.sqrt(light / 6.25)


def encoded(light):
    light = min(max(light, 0), 1)
    return 255 * (12.92 * light if light <= 0.0031308 else 1.055 * light ** (1 / 2.4) - 0.055)


def codes_of_bmp(path, side):
    """Red of a picture of 24 bits, whose rows begin at the bottom."""
    data = path.read_bytes()
    start, rows = struct.unpack_from("<I", data, 10)[0], []
    for row in range(side):
        rows.append(data[start + 3 * side * row + 2:start + 3 * side * (row + 1):3])
    return [code for row in reversed(rows) for code in row]


def agreement(case, engine, pictures, side):
    """The share of pixels, in percent, that are within CODES of our picture of the same file."""
    is_linear = any(engine == name and words in case["place"] and "PBR" not in case["place"] for name, words in LINEAR)
    light_of = [code / 255 if is_linear else linear(code) for code in range(256)]
    if engine == "cesium":
        light_of = [without_tones(light) for light in light_of]
    close = count = 0
    for light, picture in pictures.items():
        theirs = [light_of[code] for row in picture for code in row]
        ours = codes_of_bmp(pathlib.Path("ours") / f"{case['map'] or 'map.png'}.{light}.bmp", side)
        factor = linear(statistics.median(ours)) / max(statistics.median(theirs), 1e-6)
        close += sum(abs(encoded(factor * value) - code) <= CODES + 0.5 for value, code in zip(theirs, ours))
        count += len(ours)
    return round(100 * close / count, 1)


def judge(case, pictures):
    width = len(pictures["above"][0])
    squares = [(0, width, case["corner"])]
    if case["halves"]:  # the second is mirrored
        squares = [(0, width // 2, "upper left"), (width // 2, width, "upper right")]
    seen, numbers, right = [], [], True
    for first, end, corner in squares:
        words, found, four = look_at(*([row[first:end] for row in pictures[light]] for light in ("above", "left")))
        right = right and words == ("dent" if case["dent"] else "bump") and found == corner
        seen.append(words if found == corner or words in ("black", "flat") else f"{words} in the {found} corner")
        numbers.append(four)
    case.update(seen=seen[0] if len(set(seen)) == 1 else " | ".join(seen), right=right, halves_of=numbers)


def pictures_of(case, lights):
    """The codes under each light; none if the engine has drawn nothing."""
    files = [pathlib.Path(f"{case['id']}.{light}.grey") for light in lights]
    return {light: file.read_bytes() for light, file in zip(lights, files)} if all(f.exists() for f in files) else {}


def judge_sphere(case, codes, picture, side):
    def is_inside(k):
        return math.hypot(k % side + 0.5 - side / 2, k // side + 0.5 - side / 2) < side / 2 - 1
    apart = sorted(abs(codes[light][k] - picture[light][k]) for light in codes for k in range(side * side)
                   if is_inside(k))
    mean, most = statistics.fmean(apart), apart[len(apart) * 99 // 100]
    is_lit = min(max(light) for light in picture.values()) >= 4 * LEAST
    same = is_lit and mean <= AS_MEAN and most <= AS_MOST
    case.update(seen=AS_PICTURE if same else "not as with the PNG", right=same == (case["name"] != models.BARE),
                apart=[round(mean, 2), most])


def main():
    failed = False
    job = json.loads(pathlib.Path("cases.json").read_text(encoding="utf-8"))
    sphere = next((pictures_of(case, job["lights"]) for case in job["cases"]
                   if case["table"] == "spheres" and case["name"] == models.PICTURE), {})
    for case in job["cases"]:
        text = pathlib.Path(f"{case['id']}.txt")
        case["said"] = text.read_text(encoding="utf-8") if text.exists() else ""
        case.update(seen="refused", right=False, halves_of=[], apart=[])
        codes = pictures_of(case, job["lights"])
        if codes and case["table"] == "spheres":
            if sphere:
                judge_sphere(case, codes, sphere, job["side"])
        elif codes:
            rows = {light: [row[at:at + job["side"]] for at in range(0, len(row), job["side"])]
                    for light, row in codes.items()}
            judge(case, rows)
            if (case["right"] and case["corner"] == "upper left" and not case["dent"] and not case["halves"] and
                    pathlib.Path("ours").exists()):
                case["agrees"] = agreement(case, job["engine"], rows, job["side"])
        print(f"{case['table']:8}{case['name']:30}{case['place']:52}{'right' if case['right'] else 'WRONG':7}"
              f"{case['seen']:32}{case['halves_of'] or case['apart']} "
              f"{case.get('agrees', '')} {case['said'].splitlines()[0][:100] if case['said'] else ''}")
        if case.get("wanted", "") not in ("", case["seen"]):
            print(f"    wanted: {case['wanted']}")
            failed = True
    pathlib.Path("verdicts.json").write_text(json.dumps(job, indent=1), encoding="utf-8")
    sys.exit(failed)


if __name__ == "__main__":
    main()
