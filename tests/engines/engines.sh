#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# engines.sh: engines of the web draw a bump with our files, kinds of glTF, and a sphere with UASTC as with its PNG, lit
# from above and from the left.
#
#     tests/engines/engines.sh [--build BUILD] [--gate] [ENGINE...]    default: build/release, all engines
#
# Prints what each shows, and what is right. The verdicts are kept in BUILD/engines/results; once all engines have some,
# tests/engines/RESULTS.md is written again, with the day of each. Godot and Blender are those of Debian sid (sid.sh).
# --gate draws two files on three.js and Babylon.js and fails unless it sees what it must: PNG and, packed, BC5 on
# three.js; PNG with and without the settings of the recipe on Babylon.js.
#
# Needs npm, chromium and python3; exits with 77 if one of them, or the registry of npm, is missing. Packages stay
# in BUILD/engines. An engine is a page, <engine>.js, that esbuild bundles; cases.py says what it draws, judge.py what
# is seen.
set -euo pipefail
tests=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$tests/../../build/release gate=
while :; do
    case ${1:-} in
        --build) build=$2; shift 2 ;;
        --gate) gate=yes; shift ;;
        *) break ;;
    esac
done
build=$(realpath "$build")
export PATH=$build:$PATH
declare -A packages=(
    [three]=three@0.187.0
    [babylon]="@babylonjs/core@9.35.0 @babylonjs/loaders@9.28.0 babylonjs-gltf2interface@9.28.0"
    [playcanvas]=playcanvas@2.23.3
    [phaser]=phaser@4.2.1
    [cesium]=cesium@1.145.0
    [filament]=filament@1.53.4
    [model-viewer]=@google/model-viewer@4.4.0
    [godot]="" [blender]="" # of Debian sid: see sid.sh
)
order=(three babylon playcanvas phaser cesium filament model-viewer godot blender)
[ $# -gt 0 ] || set -- "${order[@]}"
[ -z "$gate" ] || set -- three babylon
for program in npm chromium python3; do
    command -v "$program" >/dev/null || { echo "$0: no $program here"; exit 77; }
done

# Installs a package if it is not there in this version.
place=$build/engines
mkdir -p "$place"
wanted=(esbuild@0.28.2)
for engine in "$@"; do
    [ -n "${packages[$engine]+is}" ] || { echo "$0: no engine $engine; one of ${order[*]}"; exit 2; }
    read -ra more <<<"${packages[$engine]}"
    wanted+=("${more[@]}")
    case $engine in babylon | playcanvas | model-viewer) wanted+=("${packages[three]}") ;; esac # its transcoder
done
missing=()
for package in "${wanted[@]}"; do
    grep -qs "\"version\": \"${package##*@}\"" "$place/node_modules/${package%@*}/package.json" || missing+=("$package")
done
[ "${#missing[@]}" -eq 0 ] ||
    timeout 300 npm install --silent --no-audit --no-fund --legacy-peer-deps --prefix "$place" "${missing[@]}" ||
    { echo "$0: npm cannot install ${missing[*]}"; exit 77; }

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
bake="--bumpiness $(python3 "$tests/bump.py") --wrap clamp --no-sync --quiet" all_levels="--mips all"
python3 "$tests/cases.py" --commands | while read -r command; do
    command=${command//\$bake/$bake}
    eval "${command//\$all/$all_levels}"
done
bake-normals "$tests/../../samples/bricks.png" -o details.png --bumpiness 8 --no-sync --quiet
if [ -z "$gate" ]; then # our pictures of the same files, under the lights of cases.py
    mkdir ours
    for file in map*.* *.dds *.ktx2; do
        for light in above:0,0.6,0.8 left:-0.6,0,0.8; do
            preview-normals "$file" -o "ours/$file.${light%:*}.bmp" --camera 0,0,0 --size 128 --light "${light#*:}" \
                --tint 0.6 --specular 0 --ambient 0 --no-legend --no-sync --quiet
        done
    done
fi
python3 "$tests/models.py" map.png details.png models
mirrored=models/node-scale-1-1-1-converted-t-map.glb
mv "$mirrored" mirrored.glb
convert-normals mirrored.glb -o "$mirrored" --tangents mikktspace --no-sync --quiet
for basis in models/KHR-texture-basisu-t-map.glb models/sphere-uastc.glb; do
    mv "$basis" plain.glb
    pack-normals plain.glb -o "$basis" --format uastc --no-sync --quiet
done

# Draws the cases.json of this folder with an engine.
draw() {
    case $1 in godot | blender) "$tests/sid.sh" "$place/sid" "$1"; return ;; esac
    cp "$tests/$1.js" "$tests/page.js" "$tests/babylon-ktx2.js" "$place"
    "$tests/page.sh" "$place" "$1"
}

# Keeps the verdicts of an engine, what drew them, and when.
keep() {
    local name=${packages[$1]%% *} now
    mkdir -p "$place/results/$1"
    cp verdicts.json "$place/results/$1"
    [ ! -e baked.txt ] || cp baked.txt "$place/results/$1"
    if [ -n "$name" ]; then
        now=$(timeout 60 npm view "${name%@*}" version || echo unknown)
        echo "${packages[$1]}"
    else
        now="that of Debian sid"
        "$tests/sid.sh" "$place/sid" --version "$1"
    fi >"$place/results/$1/packages"
    printf '%s\n' "$now" >"$place/results/$1/newest"
    date +%Y-%m-%d >"$place/results/$1/day"
}

failed=0
for engine in "$@"; do
    mkdir "$engine"
    ln -s "$PWD"/*.png "$PWD"/*.dds "$PWD"/*.ktx2 "$PWD"/*.exr "$PWD"/models "$engine"
    [ -n "$gate" ] || ln -s "$PWD/ours" "$engine"
    cd "$engine"
    python3 "$tests/cases.py" ${gate:+--gate} "$engine"
    echo "== ${packages[$engine]:-$engine}"
    status=0
    draw "$engine" || status=$?
    if [ "$status" -eq 0 ]; then python3 "$tests/judge.py" || status=$?; fi
    case $status in
        0) [ -n "$gate" ] || keep "$engine" ;;
        77) echo "$engine: not drawn" ;;
        *) failed=1 ;;
    esac
    cd ..
done
# Each engine's last verdicts: a run of one engine brings its columns up to date.
if [ -z "$gate" ] && [ "$failed" -eq 0 ]; then
    if python3 "$tests/tables.py" "$place/results" "$(chromium --version 2>/dev/null)" >RESULTS.md; then
        cp RESULTS.md "$tests/RESULTS.md"
    fi
fi
[ -z "${KEEP:-}" ] || cp -r "$scratch" "$KEEP"
exit "$failed"
