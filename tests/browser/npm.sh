#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# npm.sh: the package of samples/packaging/npm.sh in Chromium: as it is, bundled by esbuild, and built by Vite, each in
# the page and in a worker. The bytes are those of bake-normals.
#
#     tests/browser/npm.sh [BUILD]    default: build/release
#
# The last line is "npm_browser: N passed, M failed". Exits 77 without a package, npm or Chromium.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
package=$(find "$PWD/build/npm" -maxdepth 1 -name 'libtex-*.tgz' 2>/dev/null | head -n 1)
if [ -z "$package" ] || ! command -v chromium >/dev/null || ! command -v npm >/dev/null; then
    echo 'npm_browser: not run: needs a package of samples/packaging/npm.sh, npm and chromium'
    exit 77
fi
build=$(cd "${1:-build/release}" && pwd)
server=$PWD/tests/browser/serve.py port=8619
scratch=$(mktemp -d)
browser=
trap '[ -z "$browser" ] || kill "$browser" 2>/dev/null || true; wait; rm -rf "$scratch"' EXIT
cp -r tests/browser/npm "$scratch/source"
cp samples/bricks.png "$scratch"
cd "$scratch"
"$build/bake-normals" bricks.png -o native.dds --format bc5 --bumpiness 6 --mips all --quiet
npm install --silent --no-audit --no-fund --prefix . "$package" esbuild@0.28.2 vite@8.4.0

passed=0 failed=0
# check WHAT FOLDER: opens a folder's page in the browser.
check() {
    rm -f "$2"/*.dds
    cp bricks.png "$2"
    (
        until (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do sleep 0.1; done
        exec chromium --headless --no-sandbox --disable-gpu --user-data-dir="$scratch/profile" \
            "http://127.0.0.1:$port/" 2>"$scratch/log"
    ) &
    browser=$!
    if (cd "$2" && timeout 120 python3 "$server" "$port") && cmp native.dds "$2/page.dds" &&
        cmp native.dds "$2/worker.dds"; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "npm_browser: FAILED: $1"
        tail -n 5 "$scratch/log"
    fi
    kill "$browser" 2>/dev/null || true
    wait "$browser" 2>/dev/null || true
    browser=
}

# One ES module with the WebAssembly beside it. (Import maps do not reach workers.)
mkdir plain
cp source/* node_modules/libtex/index.js node_modules/libtex/tex.wasm plain
mv plain/index.js plain/libtex.js
sed -i "s|'libtex'|'./libtex.js'|" plain/make.js
check 'as it is' plain

# esbuild leaves the address of the WebAssembly as it is, relative to the bundle.
mkdir esbuild
cp source/index.html node_modules/libtex/tex.wasm esbuild
node_modules/.bin/esbuild source/page.js source/worker.js --bundle --minify --format=esm --outdir=esbuild \
    --log-level=warning
check 'esbuild' esbuild

printf '%s\n' 'export default { worker: { format: "es" }, build: { outDir: "../vite", assetsInlineLimit: 0 } };' \
    >source/vite.config.js
(cd source && ln -s ../node_modules node_modules && ../node_modules/.bin/vite build --logLevel warn)
check 'Vite' vite
echo "npm_browser: $passed passed, $failed failed"
[ "$failed" -eq 0 ]
