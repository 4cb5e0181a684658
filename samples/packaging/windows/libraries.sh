# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash disable=SC2154
# The libraries inside the archive for Windows: Debian's source packages, fetched and checked as for the portable
# archive (portable/libraries.sh), cross-built with mingw-w64 into $prefix. Sourced by windows.sh, which sets $work
# (where sources and builds lie), $prefix, $mirror and $toolchain.

# shellcheck source=samples/packaging/portable/libraries.sh
. samples/packaging/portable/libraries.sh
# zlib comes as Debian's libz-mingw-w64-dev; JSON and TOML are headers.
sources=(imath openexr libisal onetbb highway fmtlib tiff libpng1.6 libdeflate libzstd libjpeg-turbo)
bare_sources=()
lgpl_sources=()
hardening='-D_WIN32_WINNT=0x0A00 -D_FILE_OFFSET_BITS=64 -Wa,-muse-unaligned-vector-move -O2'
tool=x86_64-w64-mingw32
toolchain_options=(-DCMAKE_TOOLCHAIN_FILE="$toolchain")

# with_objects NAME LIBRARY HEADERS... -- SOURCE...: compiles C sources without a build system, once.
with_objects() {
    local name=$1 library=$2 build=$work/build/$1 source headers=()
    shift 2
    [ ! -e "$build/installed" ] || return 0
    while [ "$1" != -- ]; do headers+=("$1"); shift; done
    shift
    rm -rf "$build"
    mkdir -p "$build" "$prefix/include" "$prefix/lib"
    for source in "$@"; do
        # shellcheck disable=SC2086  # flags are words
        echo "${launcher:-} $tool-gcc-posix $hardening -I$(source_of "$name") -I$(source_of "$name")/lib -c $source" \
            "-o $build/$(echo "${source#"$(source_of "$name")/"}" | tr / _).o"
    done | xargs -P 2 -I{} sh -c '{}' >"$build.log" 2>&1 || { tail -n 20 "$build.log" >&2; return 1; }
    rm -f "$prefix/lib/$library"
    $tool-ar rcs "$prefix/lib/$library" "$build"/*.o
    cp "${headers[@]}" "$prefix/include"
    touch "$build/installed"
}

pkgconfig() {  # NAME VERSION LIBRARY [SUBFOLDER OF HEADERS]
    mkdir -p "$prefix/lib/pkgconfig"
    printf '%s\n' "prefix=$prefix" "Name: $1" "Description: $1" "Version: $2" "Libs: -L\${prefix}/lib -l$3" \
        "Cflags: -I\${prefix}/include${4:+/$4}" >"$prefix/lib/pkgconfig/$1.pc"
}
version_of() { basename "$(source_of "$1")" | sed "s/^[^0-9]*[a-z]-//; s/+.*//"; }

# ISA-L's makefile for systems without autoconf knows mingw.
with_isal_for_windows() {
    local build=$work/build/libisal
    [ ! -e "$build/installed" ] || return 0
    rm -rf "$build"
    cp -r "$(source_of libisal)" "$build"
    make -C "$build" -f Makefile.unx -j 2 lib isa-l.h arch=mingw host_cpu=x86_64 units='igzip crc' \
        CC="$tool-gcc-posix" AR="$tool-ar" AS=nasm DEBUG= STRIP_CMD=true CFLAGS_mingw="$hardening" >"$build.log" 2>&1 ||
        { tail -n 20 "$build.log" >&2; return 1; }
    mkdir -p "$prefix/include/isa-l" "$prefix/lib"
    cp "$build"/bin/isa-l.a "$prefix/lib/libisal.a"
    cp "$build"/include/*.h "$prefix/include/isa-l"
    cp "$build/isa-l.h" "$prefix/include"
    pkgconfig libisal 2.30.0 isal
    touch "$build/installed"
}

build_windows_libraries() {
    mkdir -p "$work/build" "$prefix/lib/pkgconfig" "$prefix/include" "$prefix/share/cmake"
    cp -rp /usr/include/nlohmann /usr/include/toml++ "$prefix/include"
    cp -rp /usr/share/cmake/nlohmann_json "$prefix/share/cmake"
    local root
    with_cmake highway -DHWY_ENABLE_TESTS=OFF -DHWY_ENABLE_EXAMPLES=OFF -DHWY_ENABLE_CONTRIB=OFF
    with_cmake fmtlib -DFMT_TEST=OFF -DFMT_DOC=OFF
    with_isal_for_windows
    root=$(source_of libdeflate)
    with_objects libdeflate libdeflate.a "$root/libdeflate.h" -- "$root"/lib/*.c "$root"/lib/x86/*.c
    pkgconfig libdeflate 1.14 deflate
    root=$(source_of libzstd)
    hardening+=' -DZSTD_DISABLE_ASM' with_objects libzstd libzstd.a "$root"/lib/zstd.h "$root"/lib/zstd_errors.h -- \
        "$root"/lib/common/*.c "$root"/lib/compress/*.c "$root"/lib/decompress/*.c
    pkgconfig libzstd 1.5.4 zstd
    with_cmake libpng1.6 -DPNG_SHARED=OFF -DPNG_TESTS=OFF
    with_cmake imath -DPYTHON=OFF
    with_cmake openexr -DOPENEXR_BUILD_TOOLS=OFF -DOPENEXR_INSTALL_EXAMPLES=OFF \
        -DOPENEXR_INSTALL_TOOLS=OFF -DBUILD_TESTING=OFF
    # Its own idea of folders takes a relative one for one of the current folder.
    with_cmake libjpeg-turbo -DENABLE_SHARED=OFF -DWITH_TURBOJPEG=OFF \
        -DCMAKE_INSTALL_LIBDIR:PATH="$prefix/lib"
    with_cmake tiff -Djbig=OFF -Dlzma=OFF -Dwebp=OFF -Dlerc=OFF -Dtiff-tools=OFF -Dtiff-tests=OFF \
        -Dtiff-contrib=OFF -Dtiff-docs=OFF -Dcxx=OFF
    with_cmake onetbb -DTBB_TEST=OFF -DTBBMALLOC_BUILD=OFF -DTBB_STRICT=OFF \
        -DTBB_DISABLE_HWLOC_AUTOMATIC_SEARCH=ON
}
