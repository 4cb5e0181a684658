#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# portable.sh: makes build/portable/libtex-VERSION-linux-x86_64.tar.xz, with the commands, the reader of TIFF and JPEG,
# manuals, completions, samples, licences and an SPDX document. It runs on any Linux, from any folder, for any user.
#
#     samples/packaging/portable.sh [--wheel]    with --wheel, also a wheel of the Python module, for Python 3.11
#     samples/packaging/portable.sh --arm64      build/portable-arm64/libtex-VERSION-linux-aarch64.tar.xz, cross-built
#
# Debian 12 is where it is made. Libraries come from Debian: as static archives of its packages, or, where it has none,
# as its source packages, which are built here (portable/libraries.sh). Nothing is installed but missing packages.
#
# The programs are static, with the C library. Then no system is too old or too new, nor without glibc (Alpine), and the
# reader's filter of system calls meets the calls of one C library, not those of whichever is installed. All commands
# are one program, bin/build-normals; the other names are links to it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
# shellcheck source=.ci/packages.sh
. .ci/packages.sh

wheel=OFF
processor=x86_64
case ${1:-} in
    '') ;;
    --wheel) wheel=ON ;;
    --arm64) processor=aarch64 ;;
    *) echo "$0: unknown argument $1: --wheel or --arm64" >&2; exit 2 ;;
esac
if [ "$(uname -m)" != x86_64 ]; then
    echo "$0: makes the archives on x86-64" >&2
    exit 2
fi
suffix=
if [ "$processor" = aarch64 ]; then suffix=-arm64; fi
work=$PWD/build/portable$suffix
prefix=$work/libraries
static=$PWD/build/static$suffix  # as deep as other build folders, so that ccache knows what they have compiled
mirror=${MIRROR:-http://deb.debian.org/debian}
toolchain_options=() # what CMake needs to know to cross-build
tool=                 # the prefix of the names of compilers
hardening='-D_FORTIFY_SOURCE=2 -fstack-protector-strong'
# shellcheck source=samples/packaging/portable/libraries.sh
. samples/packaging/portable/libraries.sh

# What is linked as Debian's own static archive, and headers.
static_packages=(
    zlib1g-dev libdeflate-dev libzstd-dev libjpeg62-turbo-dev libseccomp-dev liblzma-dev libwebp-dev
    liblerc-dev libexpat1-dev nlohmann-json3-dev libtomlplusplus-dev
)
if [ "$wheel" = ON ]; then need_packages pybind11-dev python3-dev python3-numpy; fi
need_packages g++ cmake ninja-build pkg-config make nasm dpkg-dev xz-utils python3 "${static_packages[@]}"
if [ "$processor" = aarch64 ]; then
    # shellcheck source=samples/packaging/portable/arm64_root.sh
    . samples/packaging/portable/arm64_root.sh
    need_packages g++-aarch64-linux-gnu qemu-user-static
    mkdir -p "$work"
    arm64_root "$work/root" libc6-dev libstdc++-12-dev "${static_packages[@]}" >"$work/root.log" 2>&1 ||
        { tail -n 5 "$work/root.log" >&2; exit 1; }
    rm -rf "$work"/root/usr/lib/aarch64-linux-gnu/cmake/expat-* # names the library by its place on a system
    export TEX_SYSROOT=$work/root TEX_PREFIX=$prefix
    export PKG_CONFIG_LIBDIR=$prefix/lib/pkgconfig:$TEX_SYSROOT/usr/lib/aarch64-linux-gnu/pkgconfig
    toolchain_options=(-DCMAKE_TOOLCHAIN_FILE="$PWD/samples/packaging/portable/aarch64.cmake")
    tool=aarch64-linux-gnu-
fi
if command -v ccache >/dev/null; then
    export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi

build_libtex() {
    # Libraries of libraries, which CMake's packages of shared libraries do not name. The linker takes what is needed.
    local others='-lyaml-cpp -lpystring -l:libexpat.a -lwebp -lLerc -llzma -lzstd -ljpeg -ldeflate'
    others+=' -lImath-3_1 -l:libz.a -Wl,--trace'
    PKG_CONFIG_PATH=$prefix/lib/pkgconfig cmake --preset release -B "$static" "${toolchain_options[@]}" \
        -DTEX_STATIC=ON -DTEX_OIIO_READER=OFF -DTEX_MESH_READER=OFF -DBUILD_TESTING=OFF -DTEX_PYTHON=$wheel \
        -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_INSTALL_LIBDIR=lib \
        -DCMAKE_CXX_STANDARD_LIBRARIES="-L$prefix/lib $others" \
        -DPNG_PNG_INCLUDE_DIR="$prefix/include" -DPNG_LIBRARY_RELEASE="$prefix/lib/libpng.a" \
        -DTIFF_LIBRARY="$prefix/lib/libtiff.a" -DTIFF_INCLUDE_DIR="$prefix/include" \
        >"$work/libtex.log" 2>&1 || { tail -n 20 "$work/libtex.log" >&2; return 1; }
    # What the linker has taken from where (--trace) stays from the run that linked.
    cmake --build "$static" | tee -a "$static/linked.log" \
        >>"$work/libtex.log" || { tail -n 20 "$work/libtex.log" >&2; return 1; }
}

# The tree of the archive, in $stage.
install_libtex() {
    local documents=$stage/share/doc/libtex file
    rm -rf "$stage"
    cmake --install "$static" --prefix "$stage" --component tools --strip >/dev/null
    mkdir -p "$documents"
    cp -r README.md CHANGELOG.md LICENSE samples "$documents"
    rm -r "$documents/samples/packaging"
    cmake -D DOCUMENTS="$documents" -P man/readme.cmake
    find "$documents" -name '__pycache__' -prune -exec rm -r {} +
    find "$stage/share/man" -name '*.[0-9]' -exec gzip -9n {} +
    python3 samples/packaging/portable/inventory.py --system "linux-$processor" --version "$version" \
        --sources "$work/sources" --date "$date" --trace "$static/linked.log" --out "$documents"
    chmod -R u=rwX,go=rX "$stage"
}

# A wheel with the module, what it links, and the reader, from the same objects.
make_wheel() {
    rm -f "$work"/tex-*.whl
    (cd libtex/python && TEX_BUILD=$static TEX_NOTICES=$stage/share/doc/libtex/licences /usr/bin/python3 -B -c '
import sys, build_wheel
print(build_wheel.build_wheel(sys.argv[1]))' "$work")
}

version=$(sed -n 's/^project(libtex VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
date=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct)}
name=libtex-$version-linux-$processor
stage=$work/$name
fetch_sources
build_libraries
build_libtex
install_libtex
# The same input gives the same archive: sorted, without names of users, with the time of the last commit.
tar -C "$work" --sort=name --owner=0 --group=0 --numeric-owner --mtime="@$date" --format=ustar -cf - "$name" |
    xz -9e -T1 >"$work/$name.tar.xz.new"
mv "$work/$name.tar.xz.new" "$work/$name.tar.xz"
ls -l "$work/$name.tar.xz"
if [ "$wheel" = ON ]; then make_wheel; fi
