// SPDX-License-Identifier: Apache-2.0
// node uastc.mjs MODULES BIN FILE...: UASTC by direction beside Basis Universal, as transcoders show it.
// MODULES is a node_modules folder with three (0.187) and ktx2-encoder (0.6.0), which are not needed otherwise; BIN has
// the commands. Prints mean angles in degrees of the texels that three's basis_transcoder.wasm gives for each target.
// Fails if its RGBA32 differs from what libtex decodes, or an angle from that of compare-normals --as.

import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { pathToFileURL } from "node:url";

const [modules, bin, ...files] = process.argv.slice(2);
const basis = join(modules, "three/examples/jsm/libs/basis/basis_transcoder");
const loaded = { exports: {} };
new Function("module", "exports", "require", "__filename", "__dirname", readFileSync(basis + ".js", "utf8") +
    "\nmodule.exports = BASIS;")(loaded, loaded.exports, createRequire(import.meta.url), basis + ".js", ".");
const transcoder = await loaded.exports({ wasmBinary: readFileSync(basis + ".wasm") });
transcoder.initializeBasis();
const { encodeToKTX2 } = await import(pathToFileURL(join(modules, "ktx2-encoder/dist/node/index.js")));
const scratch = mkdtempSync(join(tmpdir(), "uastc-"));

const run = (command, ...args) => execFileSync(join(bin, command), args, { encoding: "utf8", stdio: "pipe" });

function read(path) {
    const bytes = readFileSync(path);
    const at = (offset) => bytes.readUInt32LE(offset);
    const offset = Number(bytes.readBigUInt64LE(80)), length = Number(bytes.readBigUInt64LE(88));
    return { width: at(20), height: at(24), marks: bytes.subarray(at(56), at(56) + at(60)),
             texels: bytes.subarray(offset, offset + length) };
}

// A file of one level, with the marks of a file of x, y and z in R, G and B.
function write(path, format, like, texels) {
    const head = Buffer.alloc(104), align = Buffer.alloc((16 - ((104 + like.marks.length) % 16)) % 16);
    Buffer.from([0xab, 0x4b, 0x54, 0x58, 0x20, 0x32, 0x30, 0xbb, 0x0d, 0x0a, 0x1a, 0x0a]).copy(head);
    [format, 1, like.width, like.height, 0, 0, 1, 1, 0, 0, 0, 104, like.marks.length].forEach(
        (value, k) => head.writeUInt32LE(value, 12 + 4 * k));
    const offset = 104 + like.marks.length + align.length;
    [offset, texels.length, texels.length].forEach((value, k) => head.writeBigUInt64LE(BigInt(value), 80 + 8 * k));
    writeFileSync(path, Buffer.concat([head, like.marks, align, Buffer.from(texels)]));
}

const kModifiers = [[2, 8], [5, 17], [9, 29], [13, 42], [18, 60], [24, 80], [33, 106], [47, 183]];

// Puts the four by four colours of each block in rows of RGB.
function decode(blocks, { width, height }, colour) {
    const rgb = Buffer.alloc(3 * width * height), across = Math.ceil(width / 4);
    for (let n = 0; 8 * n < blocks.length; ++n) {
        for (let k = 0; k < 16; ++k) {
            const x = 4 * (n % across) + (k % 4), y = 4 * Math.floor(n / across) + (k >> 2);
            if (x < width && y < height) rgb.set(colour(blocks.subarray(8 * n, 8 * n + 8), k), 3 * (y * width + x));
        }
    }
    return rgb;
}

function etc1(b, k) {
    const flip = b[3] & 1, diff = b[3] & 2, x = k % 4, y = k >> 2, half = flip ? y >> 1 : x >> 1, at = 4 * x + y;
    const index = (((b[4] << 8) | b[5]) >> at & 1) * 2 + (((b[6] << 8) | b[7]) >> at & 1);
    const size = kModifiers[half ? (b[3] >> 2) & 7 : b[3] >> 5][index & 1], modifier = index & 2 ? -size : size;
    return [0, 1, 2].map((c) => {
        const step = ((b[c] & 7) ^ 4) - 4, code = diff ? (b[c] >> 3) + (half ? step : 0) : 0;
        const base = diff ? (code << 3) | (code >> 2) : 17 * (half ? b[c] & 15 : b[c] >> 4);
        return Math.min(Math.max(base + modifier, 0), 255);
    });
}

// A decoder for each target: VkFormat, and the texels or blocks of it.
const kTargets = [
    ["RGBA32", 13, 37, (blocks) => blocks], ["ASTC", 10, 157, (blocks) => blocks], ["BC7", 6, 145, (blocks) => blocks],
    ["BC1", 2, 131, (blocks) => blocks], ["ETC1", 0, 23, (blocks, like) => decode(blocks, like, etc1)],
];

// The angles of a file in each target, and its texels.
function judge(path, like, reference) {
    const file = new transcoder.KTX2File(new Uint8Array(readFileSync(path)));
    if (!file.isValid() || !file.startTranscoding()) throw new Error(path + ": not for the transcoder");
    let texels;
    const angles = kTargets.map(([name, target, format, convert]) => {
        const blocks = new Uint8Array(file.getImageTranscodedSizeInBytes(0, 0, 0, target));
        if (!file.transcodeImage(blocks, 0, 0, 0, target, 0, -1, -1)) throw new Error(path + ": " + name);
        if (name === "RGBA32") texels = blocks;
        const shown = join(scratch, name + ".ktx2");
        write(shown, format, like, convert(blocks, like));
        const report = JSON.parse(run("compare-normals", "--json", reference, shown));
        if (name !== "RGBA32") {
            const own = JSON.parse(run("compare-normals", "--json", reference, path, "--as", name.toLowerCase()));
            const kRounding = name === "ASTC" ? 2e-3 : 1e-6; // what ASTC decodes to is rounded to 16 bits
            for (const figure of ["mean", "p99.9", "max"]) {
                if (Math.abs(own.degrees[figure] - report.degrees[figure]) > kRounding) {
                    console.error(`${path}: --as ${name.toLowerCase()} is not what the transcoder makes`);
                    process.exitCode = 1;
                }
            }
        }
        return report.degrees.mean;
    });
    file.close();
    file.delete();
    return { angles, texels };
}

console.log("| map | encoder | " + kTargets.map(([name]) => name).join(" | ") + " | bytes |");
console.log("|---" .repeat(3 + kTargets.length) + "|");
for (const path of files) {
    const reference = join(scratch, "reference.ktx2");
    run("pack-normals", path, "-o", reference, "--format", "rgba8", "--mips", "1");
    const like = read(reference);
    const row = (name, made) => {
        const { angles, texels } = judge(made, like, reference);
        const cells = angles.map((angle) => angle.toFixed(3)).join(" | ");
        console.log(`| ${basename(path)} | ${name} | ${cells} | ${readFileSync(made).length} |`);
        return texels;
    };
    const made = join(scratch, "made.ktx2");
    const image = { width: like.width, height: like.height, data: new Uint8Array(like.texels) };
    const theirs = await encodeToKTX2(like.texels, { isUASTC: true, uastcLDRQualityLevel: 2, isNormalMap: true,
        isPerceptual: false, isSetKTX2SRGBTransferFunc: false, generateMipmap: false, needSupercompression: true,
        enableRDO: false, imageDecoder: async () => image });
    writeFileSync(made, theirs);
    row("ktx2-encoder level 2", made);
    for (const effort of ["fast", "normal", "best"]) {
        run("pack-normals", reference, "-o", made, "--format", "uastc", "--effort", effort, "--mips", "1");
        const texels = row("libtex " + effort, made);
        write(join(scratch, "RGBA32.ktx2"), 37, like, texels);
        const differs = JSON.parse(run("compare-normals", "--json", made, join(scratch, "RGBA32.ktx2"))).degrees.max;
        if (differs !== 0) {
            console.error(path + ": RGBA32 is not what libtex decodes");
            process.exitCode = 1;
        }
    }
}
rmSync(scratch, { recursive: true });
