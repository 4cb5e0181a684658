#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# models.sh: models that pack-normals writes again, without anything asked of it, are the same picture in engines.
#
#     tests/browser/models.sh [--engine three|babylon] [--lods] BUILD FOLDER...      default: three
#
# Every .glb and .gltf in the folders that has a normal map is written twice: in its own form, and in the other one.
# Each is drawn by the engine in Chromium, from three sides, beside the original, and no code may differ, unless the old
# map was KTX2. Khronos' validator may find no error or warning that it does not find in the original.
# --lods: models are simplified by gltfpack, too, and transfer-normals makes maps for them, which must be drawn without
# an error.
# Prints what each model shows, and counts; exits with 1 if a model fails, and with 77 if npm or chromium is missing.
# Packages stay in BUILD/models. tests/bench/MODELS.md has the last result.
set -euo pipefail
tests=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
engine=three lods=
while :; do
    case ${1:-} in
        --engine) engine=$2; shift 2 ;;
        --lods) lods=yes; shift ;;
        *) break ;;
    esac
done
build=$(realpath "$1")
shift
folders=()
for folder in "$@"; do folders+=("$(realpath "$folder")"); done
for program in npm node chromium python3; do
    command -v "$program" >/dev/null || { echo "$0: no $program here"; exit 77; }
done
export PATH=$build:$PATH
scratch=$(mktemp -d)
browser=
trap '[ -z "$browser" ] || kill "$browser" || true; wait; rm -rf "$scratch"' EXIT
cd "$scratch"
packages=(three@0.187.0 gltf-validator@2.0.0-dev.3.10 esbuild@0.28.2)
[ "$engine" = three ] ||
    packages+=(@babylonjs/core@9.35.0 @babylonjs/loaders@9.28.0 babylonjs-gltf2interface@9.28.0)
[ -z "$lods" ] || packages+=(gltfpack@1.3.0)
mkdir -p "$build/models"
npm install --silent --no-audit --no-fund --legacy-peer-deps --prefix "$build/models" "${packages[@]}" ||
    { echo "$0: npm cannot install ${packages[*]}"; exit 77; }
ln -s "$build/models" modules
cp "$tests/browser/models_$engine.js" "$tests/engines/babylon-ktx2.js" modules/
modules/node_modules/.bin/esbuild "modules/models_$engine.js" --bundle --format=esm --outfile=draw.js \
    --log-level=error --external:fs --external:path
ln -s modules/node_modules/three/examples/jsm/libs/basis basis
cp "$tests/browser/models.html" .
entries=() plain=0 refused=0 k=0
while IFS= read -r model; do
    k=$((k + 1))
    [ "$(head -c 40 "$model" | grep -c 'git-lfs')" -eq 0 ] || continue
    mkdir -p "$k/in" "$k/glb" "$k/gltf"
    form=${model##*.}
    form=${form,,}
    if ! pack-normals "$model" -o "$k/own.$form" --no-sync --quiet >"$k/log" 2>&1; then
        if grep -q 'no material uses a normal map' "$k/log"; then plain=$((plain + 1)); else
            refused=$((refused + 1))
            sed "s/^/refused: /" "$k/log" | tail -n 1
        fi
        continue
    fi
    for other in glb gltf; do
        [ "$other" = "$form" ] || pack-normals "$model" -o "$k/$other/other.$other" --no-sync --quiet >"$k/log" 2>&1 ||
            { refused=$((refused + 1)); sed "s/^/refused as $other: /" "$k/log" | tail -n 1; }
    done
    ln -s "$(dirname "$model")" "$k/in/folder"
    # A GPU decodes other blocks than those of the file, with the levels of the file.
    kind=
    ! grep -qa KHR_texture_basisu "$model" || kind=' (of KTX2)'
    if [ -n "$lods" ]; then
        if ! { node modules/node_modules/gltfpack/cli.js -si 0.25 -kn -km -i "$model" -o "$k/low.glb" &&
            transfer-normals "$k/low.glb" "$model" -o "$k/lod.glb" --no-sync --quiet; } >"$k/log" 2>&1; then
            sed "s|^|no LOD of $model: |" "$k/log" | tail -n 1
        fi
    fi
    for made in "$k"/own.* "$k"/glb/other.glb "$k"/gltf/other.gltf "$k"/lod.glb; do
        [ -e "$made" ] || continue
        from=$k/in/folder/$(basename "$model")
        [ "$made" != "$k/lod.glb" ] || { from=$k/low.glb kind=' (LOD)'; }
        entries+=("$(python3 -c 'import json, sys, urllib.parse as u
print(json.dumps([sys.argv[1] + sys.argv[4] + " as " + sys.argv[3], u.quote(sys.argv[2]), u.quote(sys.argv[3])]))' \
            "$model" "$from" "$made" "$kind")")
    done
done < <(find "${folders[@]}" -type f \( -iname '*.glb' -o -iname '*.gltf' \) | sort)
(IFS=,; echo "[${entries[*]}]") >files.json
node "$tests/browser/models_valid.mjs" files.json >valid || true
(
    until (exec 3<>/dev/tcp/127.0.0.1/8618) 2>/dev/null; do sleep 0.1; done
    exec chromium --headless --no-sandbox --disable-gpu --use-gl=angle --use-angle=swiftshader \
        --enable-unsafe-swiftshader --user-data-dir="$scratch/profile" http://127.0.0.1:8618/models.html 2>log
) &
browser=$!
timeout "${MODELS_SECONDS:-1800}" python3 "$tests/browser/serve.py" 8618 || { cat log; exit 1; }
cat result valid
same=$(grep -c 'the same picture$' result || true)
empty=$(grep -c 'nothing is seen$' result || true)
unloaded=$(grep -c 'is not loaded: ' result || true)
other=$(grep -v -e ' (of KTX2) as ' -e ' (LOD) as ' result | grep -c 'codes differ' || true)
drawn=$(grep ' (LOD) as ' result | grep -c -e 'codes differ' -e 'the same picture' || true)
invalid=$(grep -c 'more errors' valid || true)
models=$(sed -n 's/\( (LOD)\)\{0,1\} as [0-9]*\/.*//p' result | sort -u | wc -l)
echo "$models models with normal maps, ${#entries[@]} outputs: $same the same, $other differ, $empty show nothing," \
    "$unloaded are not loaded; ${lods:+$drawn LODs are drawn; }$invalid have more errors than the original;" \
    "$refused refused, $plain without maps"
lost=$(grep ' (LOD) as ' result | grep -v 'as the original' | grep -c -e 'is not loaded' -e 'nothing is seen' || true)
[ "$other" -eq 0 ] && [ "$invalid" -eq 0 ] && [ "$lost" -eq 0 ]
