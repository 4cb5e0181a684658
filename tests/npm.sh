#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# npm.sh: tests the package that samples/packaging/npm.sh has made: installed in an empty folder, with the bytes of
# build/release.
#
#     tests/npm.sh [SETS]    the number of random sets of options, 500 if none is given
#
# The last line is "npm: N passed, M failed, K skipped". Exits 77 without a package, a release or node 20.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

package=$(find build/npm -maxdepth 1 -name 'libtex-*.tgz' 2>/dev/null | head -n 1)
if [ -z "$package" ] || [ ! -x build/release/bake-normals ] || ! command -v npm >/dev/null; then
    echo 'npm: not run: needs a package of samples/packaging/npm.sh, build/release, node and npm'
    exit 77
fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
npm install --silent --no-audit --no-fund --offline --prefix "$scratch" "$PWD/$package"
node tests/npm.mjs "$scratch/node_modules/libtex" build/release samples "${1:-500}"
