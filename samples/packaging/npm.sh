#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# npm.sh: makes build/npm/libtex-VERSION.tgz, the npm package of the commands and of the JavaScript module: WebAssembly,
# for node 20 and later, on every system, without a native part or an install script. `npm publish` takes it as it is.
#
#     samples/packaging/npm.sh
#
# Debian 12 is where it is made, with Debian's clang 19 for WebAssembly. Libraries come as Debian's source packages,
# which are cross-built here (npm/libraries.sh). Nothing is installed but missing packages.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
# shellcheck source=.ci/packages.sh
. .ci/packages.sh

work=$PWD/build/npm
prefix=$work/libraries
wasm=$PWD/build/wasm  # as deep as other build folders, so that ccache knows what they have compiled
mirror=${MIRROR:-http://deb.debian.org/debian}
toolchain=$PWD/samples/packaging/npm/toolchain.cmake
tool=
export TEX_PREFIX=$prefix
need_packages "${wasm_packages[@]}" cmake ninja-build pkg-config dpkg-dev xz-utils nlohmann-json3-dev libfmt-dev \
    libtomlplusplus-dev python3
if ! command -v node >/dev/null || [ "$(node -p 'parseInt(process.versions.node)')" -lt 20 ]; then
    echo "$0: needs node 20 or later" >&2
    exit 1
fi
launcher=
if command -v ccache >/dev/null; then
    launcher=ccache
    export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
# shellcheck source=samples/packaging/npm/libraries.sh
. samples/packaging/npm/libraries.sh

build_libtex() {
    cmake --preset wasm -DCMAKE_EXE_LINKER_FLAGS="-L$prefix/lib -Wl,--trace" >"$work/libtex.log" 2>&1 ||
        { tail -n 20 "$work/libtex.log" >&2; return 1; }
    # What the linker has taken from where (--trace) stays from the run that linked.
    cmake --build --preset wasm | tee -a "$wasm/linked.log" \
        >>"$work/libtex.log" || { tail -n 20 "$work/libtex.log" >&2; return 1; }
}

# The tree of the package, in $stage.
fill_package() {
    rm -rf "$stage"
    mkdir -p "$stage"
    cp "$wasm/libtex/web/tex.wasm" libtex/web/*.js libtex/web/*.d.ts libtex/web/README.md LICENSE CHANGELOG.md "$stage"
    cp "$wasm/tools/web/commands.wasm" tools/web/*.js "$stage"
    local commands
    commands=$(printf '%s\n' tools/*-normals.cpp | sed 's|tools/\(.*\)[.]cpp|"\1"|' | paste -sd,)
    sed "s/@VERSION@/$version/; s/@COMMANDS@/${commands//,/, }/" libtex/web/package.json.in >"$stage/package.json"
    node --input-type=module -e '
        import { readFileSync, writeFileSync } from "node:fs";
        const { declarations } = await import(process.argv[1] + "/node.js");
        const text = readFileSync("libtex/web/index.d.ts.in", "utf8");
        writeFileSync(process.argv[1] + "/index.d.ts", text.replace("@OPTIONS@\n", declarations()));' "$stage"
    python3 samples/packaging/portable/inventory.py --system wasm32 --version "$version" --sources "$work/sources" \
        --date "$date" --trace "$wasm/linked.log" --out "$stage"
}

version=$(sed -n 's/^project(libtex VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
date=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct)}
stage=$work/package
fetch_sources
fetch_llvm
build_wasm_libraries
build_libtex
fill_package
# The same input gives the same archive: sorted, without names of users, with the time of the last commit.
tar -C "$work" --sort=name --owner=0 --group=0 --numeric-owner --mtime="@$date" --format=ustar -cf - package |
    gzip -9n >"$work/libtex-$version.tgz.new"
mv "$work/libtex-$version.tgz.new" "$work/libtex-$version.tgz"
ls -l "$work/libtex-$version.tgz"
