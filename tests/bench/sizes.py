#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Which file for what: bytes to download, bytes in the memory of the GPU and the angle to the source, by format.

    tests/bench/sizes.py BUILD MAP...

Prints a row for each format, means over the maps: download and memory in bits a texel of the base level (with all
levels, which pictures get when they are loaded), mean angle and the angle that 99.9 % of the texels keep, in degrees.
The table of normal-maps-migrate(7) is that of ../shared/data/normal/detail_water_512.png, brick_512.jpg,
aluminium_745.png and panels_tangent_512_rgba.png, pairs/Bricks102/normal_GL.jpg and LeatherPartsMat_Normal.png of the
flight helmet in mesh. Rows of basis_universal need node and npm, which fetches ktx2-encoder (basis_universal as
WebAssembly) and three's transcoder.
"""

import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

BUILD = pathlib.Path(sys.argv[1]).resolve()
MAPS = [pathlib.Path(name).resolve() for name in sys.argv[2:]]
KTX2 = ["--mips", "all", "--supercompress", "zstd:19"]
RGBA8 = 32.0 * 4 / 3  # what a GPU makes of a picture
# Row: name, extension, options, bits a texel in memory.
ROWS = [
    ("PNG, 8 bits", ".png", ["--format", "rgb8"], RGBA8),
    ("WebP", ".webp", ["--format", "rgb8"], RGBA8),
    ("JPEG, quality 95", ".jpg", [], RGBA8),
    ("BC5", ".ktx2", ["--format", "bc5", *KTX2], 8 * 4 / 3),
    ("BC5, --rdo-mean 0.5", ".ktx2", ["--format", "bc5", "--rdo-mean", "0.5", *KTX2], 8 * 4 / 3),
    ("DXT5nm", ".ktx2", ["--format", "dxt5nm", *KTX2], 8 * 4 / 3),
    ("EAC RG11", ".ktx2", ["--format", "eac-rg11", *KTX2], 8 * 4 / 3),
    ("ASTC 4x4", ".ktx2", ["--format", "astc-4x4", *KTX2], 8 * 4 / 3),
    ("ASTC 6x6", ".ktx2", ["--format", "astc-6x6", *KTX2], 128 / 36 * 4 / 3),
    ("ASTC 6x6, --rdo-mean 0.5", ".ktx2", ["--format", "astc-6x6", "--rdo-mean", "0.5", *KTX2], 128 / 36 * 4 / 3),
    ("UASTC", ".ktx2", ["--format", "uastc", *KTX2], 8 * 4 / 3),
    ("UASTC, --rdo-mean 0.5", ".ktx2", ["--format", "uastc", "--rdo-mean", "0.5", *KTX2], 8 * 4 / 3),
]

UASTC = """
import { readFileSync, writeFileSync } from 'node:fs';
import { encodeToKTX2 } from 'ktx2-encoder';
import BASIS from './transcoder.cjs';
const [png, ktx2, pixels, level] = process.argv.slice(2);
const bytes = readFileSync(png);
const width = Number(process.argv[6]), height = Number(process.argv[7]);
const made = await encodeToKTX2(new Uint8Array(bytes), {
  isUASTC: true, isNormalMap: true, isPerceptual: false, isSetKTX2SRGBTransferFunc: false, generateMipmap: true,
  needSupercompression: true, uastcLDRQualityLevel: Number(level),
  imageDecoder: async () => ({ width, height, data: new Uint8Array(readFileSync(pixels)) }),
});
writeFileSync(ktx2, made);
const basis = await BASIS({ wasmBinary: readFileSync('node_modules/three/examples/jsm/libs/basis/basis_transcoder.wasm') });
basis.initializeBasis();
const file = new basis.KTX2File(new Uint8Array(made));
file.startTranscoding();
const rgba32 = 13;
const texels = new Uint8Array(file.getImageTranscodedSizeInBytes(0, 0, 0, rgba32));
file.transcodeImage(texels, 0, 0, 0, rgba32, 0, -1, -1);
writeFileSync(ktx2 + '.rgba', texels);
"""


def run(*command, **more):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, **more).stdout


def angles(source, made):
    report = json.loads(run(BUILD / "compare-normals", source, made, "--json"))
    return report["degrees"]["mean"], report["degrees"]["p99.9"]


def main():
    scratch = pathlib.Path(tempfile.mkdtemp(prefix="tex-sizes-"))
    os.chdir(scratch)
    has_uastc = shutil.which("npm") is not None
    if has_uastc:
        run("npm", "install", "--silent", "ktx2-encoder@0.6.0", "three@0.187.0")
        shutil.copy("node_modules/three/examples/jsm/libs/basis/basis_transcoder.js", "transcoder.cjs")
        pathlib.Path("uastc.mjs").write_text(UASTC)
    totals = {}
    for source in MAPS:
        run(BUILD / "pack-normals", source, "-o", "source.png", "--format", "rgb8", "--normalize", "--quiet")
        extent = json.loads(run(BUILD / "pack-normals", "source.png", "-o", "x.png", "--json", "--quiet"))["extent"]
        texels = extent[0] * extent[1]

        def add(name, size, memory, found):
            totals.setdefault(name, []).append((8 * size / texels, memory, *found))

        for name, extension, options, memory in ROWS:
            made = "made" + extension
            run(BUILD / "pack-normals", "source.png", "-o", made, "--quiet", *options)
            add(name, os.path.getsize(made), memory, angles("source.png", made))
        if has_uastc:
            run(BUILD / "pack-normals", "source.png", "-o", "pixels.dds", "--format", "rgba8", "--dds-header", "dx10",
                "--mips", "none", "--quiet")
            pathlib.Path("pixels").write_bytes(pathlib.Path("pixels.dds").read_bytes()[148:])
            for level in (0, 2):
                run("node", "uastc.mjs", "source.png", "u.ktx2", "pixels", level, *extent)
                head = pathlib.Path("pixels.dds").read_bytes()[:148]
                pathlib.Path("u.dds").write_bytes(head + pathlib.Path("u.ktx2.rgba").read_bytes())
                add(f"UASTC, level {level} (basis_universal)", os.path.getsize("u.ktx2"), 8 * 4 / 3,
                    angles("source.png", "u.dds"))
    print(f"{'':34}{'download':>10}{'memory':>9}{'mean':>8}{'99.9 %':>8}")
    for name, rows in totals.items():
        mean = [math.fsum(column) / len(rows) for column in zip(*rows)]
        print(f"{name:34}{mean[0]:10.1f}{mean[1]:9.1f}{mean[2]:8.2f}{mean[3]:8.2f}")
    shutil.rmtree(scratch)


main()
