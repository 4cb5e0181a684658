#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# recipes.sh: follows each recipe of normal-maps-engines(7) for the engines that run here, from an empty folder.
#
#     tests/engines/recipes.sh [--build BUILD] [ENGINE...]    default: build/release, all nine engines
#
# In the folder are a height map, bricks.png, and a white albedo.png. The commands of the section run as the manual
# prints them, the engine is installed anew, and a page, recipes/<engine>.js, which has a camera, a light and a plane,
# gets the lines of the manual where it says RECIPE. Engines of models alone draw a model that refers to the file for
# glTF; Godot and Blender do what their recipes say in sid.sh and blender.py. What is seen must be the bump, lit from
# above and from the left. The last line is "recipes: N passed, M failed, K skipped". Exits with 77 without npm or a
# browser.
set -euo pipefail
tests=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
manual=$tests/../../man/normal-maps-engines.7.in build=$tests/../../build/release
if [ "${1:-}" = --build ]; then build=$2; shift 2; fi
build=$(realpath "$build")
export PATH=$build:$PATH
[ $# -gt 0 ] || set -- three babylon playcanvas phaser cesium filament model-viewer godot blender
for program in npm chromium python3; do
    command -v "$program" >/dev/null || { echo "$0: no $program here"; exit 77; }
done
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# Runs the commands of a section; after the first for glTF there is a model that refers to its file.
follow() {
    local command
    while read -r command; do
        echo "\$ $command"
        eval "$command" || { echo "failed: $command"; return 1; }
        if [ -e gltf/bricks.png ] && [ ! -e scene.glb ]; then
            python3 "$tests/models.py" gltf/bricks.png models
            cp models/plain-t-map.glb scene.glb
        fi
    done < <(python3 "$tests/recipes.py" "$manual" --commands "$1")
}

install() { timeout 300 npm install --silent --no-audit --no-fund --legacy-peer-deps esbuild@0.28.2 "$@"; }

# recipe ENGINE SECTION PACKAGES PLACE MAP MODEL...
recipe() {
    local engine=$1 packages
    read -ra packages <<<"$3"
    follow "$2"
    python3 "$tests/recipes.py" --cases "$engine" "${@:4}" >cases.json
    case $engine in
        godot | blender) "$tests/sid.sh" "$build/engines/sid" "$engine" || return ;;
        *)
            install "${packages[@]}"
            cp "$tests/page.js" .
            if [ -e "$tests/recipes/$engine.js" ]; then
                python3 "$tests/recipes.py" "$manual" --fill "$2" "$tests/recipes/$engine.js" >main.js
            else
                cp "$tests/$engine.js" main.js
            fi
            mkdir drawn && cp cases.json drawn && cd drawn
            ln -s "$OLDPWD"/*/ "$OLDPWD"/*.png "$OLDPWD"/*.glb . 2>/dev/null || true
            "$tests/page.sh" .. main
            ;;
    esac
    python3 "$tests/judge.py"
}

follow_recipe() {
    case $1 in
        three) recipe three THREE.JS three@0.187.0 picture '' '' packed '' '' ;;
        babylon) recipe babylon BABYLON.JS @babylonjs/core@9.35.0 picture '' '' ;;
        playcanvas) recipe playcanvas PLAYCANVAS playcanvas@2.23.3 picture '' '' ;;
        phaser) recipe phaser PHASER phaser@4.2.1 picture '' '' ;;
        cesium) recipe cesium GLTF cesium@1.145.0 scene '' scene.glb fixed '' fixed.glb ;;
        filament) recipe filament GLTF filament@1.53.4 scene '' scene.glb fixed '' fixed.glb ;;
        model-viewer)
            recipe model-viewer GLTF '@google/model-viewer@4.4.0 three@0.183.0' scene '' scene.glb fixed '' fixed.glb ;;
        godot) recipe godot GODOT '' imported godot/bricks.png '' ;;
        blender) recipe blender BLENDER '' picture blender/bricks.png '' ;;
        *) echo "$0: no engine $1"; return 2 ;;
    esac
}

passed=0 failed=0 skipped=0
for engine in "$@"; do
    mkdir "$scratch/$engine" && cd "$scratch/$engine"
    python3 "$tests/bump.py" >/dev/null
    mv bump.png bricks.png
    python3 -c 'import struct, zlib
def chunk(kind, data): return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
rows = zlib.compress(128 * (b"\0" + 3 * 128 * b"\x99"))
open("albedo.png", "wb").write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 128, 128, 8, 2, 0, 0, 0)) +
                               chunk(b"IDAT", rows) + chunk(b"IEND", b""))'
    echo "== $engine"
    status=0
    (set -e; follow_recipe "$engine") || status=$?
    case $status in
        0) passed=$((passed + 1)) ;;
        77) skipped=$((skipped + 1)) ;;
        *) failed=$((failed + 1)); echo "FAILED: the recipe of $engine" ;;
    esac
done
echo "recipes: $passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
