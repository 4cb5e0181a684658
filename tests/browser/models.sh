#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# models.sh: models that pack-normals writes again, without anything asked of it, are the same picture in three.js.
#
#     tests/browser/models.sh BUILD FOLDER...
#
# Every .glb and .gltf in the folders that has a normal map is written twice: in its own form, and in the other one.
# Each is drawn by three.js in Chromium, from three sides, beside the original, and no code may differ, unless the old
# map was KTX2. Khronos' validator may find no error or warning that it does not find in the original.
# Prints what each model shows, and counts; exits with 1 if a model fails, and with 77 if npm or chromium is missing.
# tests/bench/MODELS.md has the last result.
set -euo pipefail
tests=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
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
npm install --silent --prefix modules three@0.187.0 gltf-validator@2.0.0-dev.3.10 ||
    { echo "$0: npm cannot install three"; exit 77; }
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
    for made in "$k"/own.* "$k"/glb/other.glb "$k"/gltf/other.gltf; do
        [ -e "$made" ] || continue
        entries+=("$(python3 -c 'import json, sys, urllib.parse as u
print(json.dumps([sys.argv[1] + sys.argv[4] + " as " + sys.argv[3], u.quote(sys.argv[2]), u.quote(sys.argv[3])]))' \
            "$model" "$k/in/folder/$(basename "$model")" "$made" "$kind")")
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
other=$(grep -v ' (of KTX2) as ' result | grep -c 'codes differ' || true)
invalid=$(grep -c 'more errors' valid || true)
models=$(sed -n 's/ as [0-9]*\/.*//p' result | sort -u | wc -l)
echo "$models models with normal maps, ${#entries[@]} outputs: $same the same, $other differ, $empty show nothing," \
    "$unloaded are not loaded; $invalid have more errors than the original; $refused refused, $plain without maps"
[ "$other" -eq 0 ] && [ "$invalid" -eq 0 ]
