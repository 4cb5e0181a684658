#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# npm.sh: tests the package that samples/packaging/npm.sh has made: installed in an empty folder, with the bytes of
# build/release.
#
#     tests/npm.sh [SETS [--cli]]    SETS: how many random sets of options, and command lines: 500 if none is given;
#                                    --cli: tests/cli, too
#
# The last line is "npm: N passed, M failed, K skipped". Exits 77 without a package, a release or node 20. The functions
# for glTF-Transform are skipped where npm's registry cannot be reached.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

package=$(find build/npm -maxdepth 1 -name 'libtex-*.tgz' 2>/dev/null | head -n 1)
if [ -z "$package" ] || [ ! -x build/release/bake-normals ] || ! command -v npm >/dev/null; then
    echo 'npm: not run: needs a package of samples/packaging/npm.sh, build/release, node and npm'
    exit 77
fi
package=$PWD/$package build=$PWD/build/release
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
npm install --silent --no-audit --no-fund --offline --prefix "$folder" "$package"

# The functions for glTF-Transform, beside the peers that they need.
gltf() {
    mkdir "$folder/gltf"
    npm install --silent --no-audit --no-fund --prefix "$folder/gltf" "$package" gltf-validator@2.0.0-dev.3.10 \
        @gltf-transform/{core,extensions,functions}@4.5.1 sharp@0.35.5 >"$folder/gltf.log" 2>&1 ||
        { echo 'npm: 0 passed, 0 failed, 1 skipped'; return 0; }
    cp tests/npm_gltf.mjs "$folder/gltf"
    (cd "$folder/gltf" && node npm_gltf.mjs "$build" "$OLDPWD/samples")
}

{
    node tests/npm.mjs "$folder/node_modules/libtex" build/release samples "${1:-500}" || true
    tests/npm_commands.sh "$folder" "$@" || true
    gltf || true
} | tee "$folder/log"
# Each of them ends with its counts.
awk '/^npm: [0-9]+ passed/ { parts++; passed += $2; failed += $4; skipped += $6 }
     END {
         if (parts < 3) failed++
         printf "npm: %d passed, %d failed, %d skipped\n", passed, failed, skipped
         exit failed > 0
     }' "$folder/log"
