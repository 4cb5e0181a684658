# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash disable=SC2154
# The libraries inside the portable archive for which Debian has no static archive: fetched as Debian source packages,
# checked by apt against the release's signed index, and built into $prefix. Sourced by portable.sh, which sets $work
# (where sources and builds lie), $prefix, $mirror, $hardening (flags of the compiler), $toolchain_options (of CMake)
# and $tool (prefix of the names of compilers).

# Of Debian 12: what the packages of Debian 12 link. Its own tar archive alone comes of OpenColorIO and pystring, since
# Debian's changes to them concern only packaging; of OpenColorIO the next patch release, because mirrors lost 2.1.2.
sources=(imath openexr libisal onetbb highway fmtlib tiff yaml-cpp libpng1.6)
bare_sources=(opencolorio pystring)
# Linked from Debian's static archives. Whoever passes on the archive must offer these sources, too (LGPL 2.1).
lgpl_sources=(glibc libseccomp)

# apt_in RELEASE ARGUMENT...: apt-get with lists of its own, so that nothing of this system is touched.
apt_in() {
    local release=$1 state=$work/apt/$1
    shift
    mkdir -p "$state/lists/partial" "$state/cache/archives/partial"
    touch "$state/status"
    [ -e "$state/sources.list" ] || echo "deb-src $mirror $release main" >"$state/sources.list"
    apt-get -q -o "Dir::State::Lists=$state/lists" -o "Dir::State::status=$state/status" -o "Dir::Cache=$state/cache" \
        -o "Dir::Etc::SourceList=$state/sources.list" -o Dir::Etc::SourceParts=/dev/null \
        -o APT::Sandbox::User=root "$@"
}

# Leaves each source package in $work/sources/NAME-VERSION.
fetch_sources() {
    [ ! -e "$work/sources/complete" ] || return 0
    rm -rf "$work/sources"
    mkdir -p "$work/sources"
    local file
    (
        cd "$work/sources"
        apt_in bookworm update
        apt_in trixie update
        apt_in bookworm source "${sources[@]}"
        apt_in trixie source --tar-only --download-only "${bare_sources[@]}"
        mkdir -p "$work/lgpl-sources"
        (cd "$work/lgpl-sources" && apt_in bookworm source --download-only "${lgpl_sources[@]}")
        for file in opencolorio*.orig.tar.* pystring*.orig.tar.*; do tar -xf "$file"; done
        touch complete
    ) >"$work/sources.log" 2>&1 || { tail -n 5 "$work/sources.log" >&2; return 1; }
}
source_of() { find "$work/sources" -maxdepth 1 -type d -iname "$1-*" | head -n 1; }

# with_cmake NAME OPTION...: builds and installs one of the sources, once.
with_cmake() {
    local name=$1 build=$work/build/$1
    shift
    [ ! -e "$build/installed" ] || return 0
    if ! (
        cmake -G Ninja -S "$(source_of "$name")" -B "$build" "${toolchain_options[@]}" -DCMAKE_BUILD_TYPE=Release \
            -DBUILD_SHARED_LIBS=OFF \
            -DCMAKE_INSTALL_PREFIX="$prefix" -DCMAKE_INSTALL_LIBDIR=lib -DCMAKE_PREFIX_PATH="$prefix" \
            -DCMAKE_POSITION_INDEPENDENT_CODE=ON -DCMAKE_C_FLAGS="$hardening" -DCMAKE_CXX_FLAGS="$hardening" \
            -DCMAKE_CXX_VISIBILITY_PRESET=hidden -DCMAKE_VISIBILITY_INLINES_HIDDEN=ON -DBUILD_TESTING=OFF "$@" &&
            cmake --build "$build" --target install
    ) >"$build.log" 2>&1; then
        tail -n 20 "$build.log" >&2
        return 1
    fi
    touch "$build/installed"
}

# ISA-L's makefile for systems without autoconf. It dispatches by processor at run time.
with_isal_makefile() {
    local build=$work/build/libisal
    [ ! -e "$build/installed" ] || return 0
    rm -rf "$build"
    cp -r "$(source_of libisal)" "$build"
    local target=()
    if [ -n "$tool" ]; then target=(arch=aarch64 host_cpu=aarch64 CC="${tool}gcc" AR="${tool}ar"); fi
    make -C "$build" -f Makefile.unx -j "$(nproc)" lib isa-l.h CFLAGS_="$hardening -fPIC" \
        CFLAGS_aarch64="$hardening -fPIC" "${target[@]}" >"$build.log" 2>&1 ||
        { tail -n 20 "$build.log" >&2; return 1; }
    mkdir -p "$prefix/lib/pkgconfig" "$prefix/include/isa-l"
    cp "$build"/bin/isa-l.a "$prefix/lib/libisal.a"
    cp "$build"/include/*.h "$prefix/include/isa-l"
    cp "$build/isa-l.h" "$prefix/include"
    printf '%s\n' "prefix=$prefix" 'Name: libisal' 'Description: ISA-L' 'Version: 2.30.0' \
        "Libs: -L\${prefix}/lib -lisal" "Cflags: -I\${prefix}/include" >"$prefix/lib/pkgconfig/libisal.pc"
    touch "$build/installed"
}

build_libraries() {
    mkdir -p "$work/build" "$prefix/lib/pkgconfig"
    with_isal_makefile
    with_cmake imath -DPYTHON=OFF
    with_cmake openexr -DOPENEXR_BUILD_TOOLS=OFF -DOPENEXR_INSTALL_EXAMPLES=OFF -DOPENEXR_INSTALL_TOOLS=OFF \
        -DBUILD_TESTING=OFF
    with_cmake onetbb -DTBB_TEST=OFF -DTBBMALLOC_BUILD=OFF -DTBB_STRICT=OFF -DTBB_DISABLE_HWLOC_AUTOMATIC_SEARCH=ON
    with_cmake highway -DHWY_ENABLE_TESTS=OFF -DHWY_ENABLE_EXAMPLES=OFF -DHWY_ENABLE_CONTRIB=OFF
    with_cmake fmtlib -DFMT_TEST=OFF -DFMT_DOC=OFF
    # Without JBIG, whose library is under the GPL.
    with_cmake tiff -Djbig=OFF -Dtiff-tools=OFF -Dtiff-tests=OFF -Dtiff-contrib=OFF -Dtiff-docs=OFF -Dcxx=OFF \
        -DCMAKE_FIND_LIBRARY_SUFFIXES=.a
    # Debian's static archive cannot be linked into a module, which the wheel needs.
    with_cmake libpng1.6 -DPNG_SHARED=OFF -DPNG_TESTS=OFF
    with_cmake yaml-cpp -DYAML_CPP_BUILD_TESTS=OFF -DYAML_CPP_BUILD_TOOLS=OFF
    with_pystring
    # Its sources lean on a header that GCC 12 no longer brings with others.
    with_cmake opencolorio -DCMAKE_CXX_FLAGS="$hardening -include cstring" -DOCIO_BUILD_APPS=OFF \
        -DOCIO_BUILD_TESTS=OFF -DOCIO_BUILD_GPU_TESTS=OFF -DOCIO_BUILD_PYTHON=OFF -DOCIO_BUILD_DOCS=OFF \
        -DOCIO_INSTALL_EXT_PACKAGES=NONE -DOCIO_WARNING_AS_ERROR=OFF -Dyaml-cpp_STATIC_LIBRARY=ON \
        -Dexpat_STATIC_LIBRARY=ON -Dpystring_STATIC_LIBRARY=ON -DImath_STATIC_LIBRARY=ON \
        -DCMAKE_FIND_LIBRARY_SUFFIXES=.a
}

# pystring has no CMake files: it is one source.
with_pystring() {
    local build=$work/build/pystring
    [ ! -e "$build/installed" ] || return 0
    mkdir -p "$build" "$prefix/include/pystring"
    # shellcheck disable=SC2086  # flags are words
    "${tool}g++" $hardening -O2 -fPIC -c "$(source_of pystring)/pystring.cpp" -o "$build/pystring.o"
    rm -f "$prefix/lib/libpystring.a"
    "${tool}ar" rcs "$prefix/lib/libpystring.a" "$build/pystring.o"
    cp "$(source_of pystring)/pystring.h" "$prefix/include/pystring"
    touch "$build/installed"
}
