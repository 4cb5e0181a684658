#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# windows.sh: makes build/windows/libtex-VERSION-windows-x86_64.zip, with the commands, their manuals, samples, licences
# and an SPDX document, for Windows 10 and later, of any folder, for any user.
#
#     samples/packaging/windows.sh
#
# Debian 12 is where it is made, with mingw-w64. Libraries come as Debian's source packages, which are cross-built here
# (windows/libraries.sh); zlib is Debian's own package for mingw-w64. Nothing is installed but missing packages.
#
# Windows gives no file two names without rights, so that all commands are in one library, bin/libtex-commands.dll, and
# each has a small program that calls it. Everything else is inside of that: the programs need only what is part of
# Windows. OpenColorIO, OpenImageIO, Assimp and Draco are left out, and messages say so.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
# shellcheck source=.ci/packages.sh
. .ci/packages.sh

work=$PWD/build/windows
prefix=$work/libraries
cross=$PWD/build/mingw  # as deep as other build folders, so that ccache knows what they have compiled
mirror=${MIRROR:-http://deb.debian.org/debian}
toolchain=$PWD/samples/packaging/windows/toolchain.cmake
export TEX_PREFIX=$prefix
need_packages g++-mingw-w64-x86-64-posix libz-mingw-w64-dev nasm cmake ninja-build pkg-config make dpkg-dev \
    nlohmann-json3-dev libtomlplusplus-dev python3
launcher=
if command -v ccache >/dev/null; then
    launcher=ccache
    export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
# shellcheck source=samples/packaging/windows/libraries.sh
. samples/packaging/windows/libraries.sh

build_libtex() {
    PKG_CONFIG_LIBDIR=$prefix/lib/pkgconfig cmake -G Ninja -S . -B "$cross" -DCMAKE_TOOLCHAIN_FILE="$toolchain" \
        -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DTEX_STATIC=ON -DTEX_OCIO=OFF -DTEX_OIIO_READER=OFF \
        -DTEX_MESH_READER=OFF -DTEX_PYTHON=OFF -DTEX_OIIO=OFF -DBUILD_TESTING=OFF -DCMAKE_INSTALL_LIBDIR=lib \
        -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_STANDARD_LIBRARIES="-L$prefix/lib $others" \
        >"$work/libtex.log" 2>&1 || { tail -n 20 "$work/libtex.log" >&2; return 1; }
    # What the linker has taken from where (--trace) stays from the run that linked.
    cmake --build "$cross" | tee -a "$cross/linked.log" \
        >>"$work/libtex.log" || { tail -n 20 "$work/libtex.log" >&2; return 1; }
}
# Libraries of libraries, which CMake's packages of shared libraries do not name, and those of Windows.
others='-lIex-3_1 -lIlmThread-3_1 -lImath-3_1 -lzstd -ljpeg -ldeflate -lz -ladvapi32 -lshell32 -Wl,--trace'

# The tree of the archive, in $stage.
install_libtex() {
    local documents=$stage/share/doc/libtex
    rm -rf "$stage"
    cmake --install "$cross" --prefix "$stage" --component tools --strip >/dev/null
    rm -rf "$stage/share/man"
    mkdir -p "$documents/man"
    cp -r README.md CHANGELOG.md LICENSE samples "$documents"
    cp man/*.md "$documents/man"
    rm -r "$documents/samples/packaging"
    cmake -D DOCUMENTS="$documents" -P man/readme.cmake
    find "$documents" -name '__pycache__' -prune -exec rm -r {} +
    python3 samples/packaging/portable/inventory.py --system windows-x86_64 --version "$version" \
        --sources "$work/sources" --date "$date" --trace "$cross/linked.log" --out "$documents"
}

# The same input gives the same archive: sorted, with the time of the last commit.
make_archive() {
    python3 - "$stage" "$1" "$date" <<'PY'
import pathlib, sys, time, zipfile
stage, archive, date = pathlib.Path(sys.argv[1]), sys.argv[2], time.gmtime(int(sys.argv[3]))[:6]
with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as out:
    for path in sorted(stage.rglob("*"), key=lambda path: path.as_posix()):
        if path.is_file():
            entry = zipfile.ZipInfo(f"{stage.name}/{path.relative_to(stage).as_posix()}", date)
            entry.compress_type, entry.external_attr, entry.create_system = zipfile.ZIP_DEFLATED, 0o100644 << 16, 3
            out.writestr(entry, path.read_bytes())
PY
}

version=$(sed -n 's/^project(libtex VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
date=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct)}
name=libtex-$version-windows-x86_64
stage=$work/$name
fetch_sources
build_windows_libraries
build_libtex
install_libtex
make_archive "$work/$name.zip.new"
mv "$work/$name.zip.new" "$work/$name.zip"
ls -l "$work/$name.zip"
