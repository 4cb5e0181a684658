# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash disable=SC2154
# The libraries inside the WebAssembly: Debian's source packages, fetched and checked as for the portable archive
# (portable/libraries.sh), cross-built with Debian's clang into $prefix. Sourced by npm.sh, which sets $work (where
# sources and builds lie), $prefix, $mirror and $toolchain.

# shellcheck source=samples/packaging/portable/libraries.sh
. samples/packaging/portable/libraries.sh
# JSON, TOML and fmt are headers.
sources=(imath openexr libisal highway libpng1.6 libdeflate libzstd zlib)
bare_sources=()
lgpl_sources=()
llvm="llvm-toolchain-19"
toolchain_options=(-DCMAKE_TOOLCHAIN_FILE="$toolchain")
here=samples/packaging/npm
# The flags of toolchain.cmake.
wasm_flags=(--target=wasm32-wasi -isystem "$PWD/$here/one_thread" -O2 -msimd128 -fwasm-exceptions
    -mllvm -wasm-enable-sjlj -fvisibility=hidden -D_WASI_EMULATED_SIGNAL -D_WASI_EMULATED_MMAN
    -D_WASI_EMULATED_PROCESS_CLOCKS -D_WASI_EMULATED_GETPID)
hardening="${wasm_flags[*]}"
position=(-DCMAKE_POSITION_INDEPENDENT_CODE=OFF)
small=(-DCMAKE_C_FLAGS_RELEASE="-Os -DNDEBUG" -DCMAKE_CXX_FLAGS_RELEASE="-Os -DNDEBUG")

# The source of LLVM is 160 MB, of which three folders are needed.
fetch_llvm() {
    [ ! -e "$work/sources/$llvm/complete" ] || return 0
    mkdir -p "$work/sources/$llvm"
    (
        cd "$work/sources/$llvm"
        apt_in bookworm source --download-only "$llvm"
        tar -xJf "$llvm"_*.orig.tar.xz --strip-components=1 --wildcards \
            '*/libcxx/src' '*/libcxx/LICENSE.TXT' '*/libcxxabi/src' '*/libcxxabi/include' '*/libunwind/src' \
            '*/libunwind/include'
        rm "$llvm"_*.orig.tar.xz
        touch complete
    ) >"$work/llvm.log" 2>&1 || { tail -n 5 "$work/llvm.log" >&2; return 1; }
}

# compile_all NAME LIBRARY FLAG... -- SOURCE...: compiles sources without a build system, once.
compile_all() {
    local name=$1 library=$2 build=$work/build/$1 source compiler flags=()
    shift 2
    [ ! -e "$build/installed" ] || return 0
    while [ "$1" != -- ]; do flags+=("$1"); shift; done
    shift
    rm -rf "$build"
    mkdir -p "$build" "$prefix/lib"
    for source in "$@"; do
        case $source in
            *.c) compiler=clang-19 ;;
            *) compiler='clang++-19 -std=c++23' ;;
        esac
        echo "${launcher:-} $compiler ${wasm_flags[*]} ${flags[*]} -c $source" \
            "-o $build/$(echo "${source#"$work/sources/"}" | tr / _).o"
    done | xargs -P 2 -I{} sh -c '{}' >"$build.log" 2>&1 || { tail -n 20 "$build.log" >&2; return 1; }
    rm -f "$prefix/lib/$library"
    llvm-ar-19 rcs "$prefix/lib/$library" "$build"/*.o
    touch "$build/installed"
}

# The C++ library once more, from the sources of Debian's own package, whose build has no exceptions (a failed
# allocation ends it), no mutexes and no files. Its headers are used as they are, with another __config_site. Two parts
# are left out because they are large: the demangler (the name of an exception that nothing catches is printed as it is)
# and ryu/d2fixed.cpp, in whose place is digits.cpp.
with_cxx() {
    local root=$work/sources/$llvm source sources=()
    for source in "$root"/libcxx/src/{,filesystem/,ryu/}*.cpp "$root"/libcxxabi/src/*.cpp; do
        case $(basename "$source") in
            random_shuffle.cpp | legacy_pointer_safety.cpp | cxa_noexception.cpp | cxa_thread_atexit.cpp) continue ;;
            new.cpp | int128_builtins.cpp | cxa_demangle.cpp | d2fixed.cpp) continue ;;
        esac
        sources+=("$source")
    done
    compile_all cxx libc++.a -Os -I"$here/absent" -I"$root/libcxx/src" -I"$root/libcxxabi/include" \
        -I"$root/libunwind/include" -I"$root/libunwind/src" -D_LIBCPP_BUILDING_LIBRARY \
        -DLIBCXX_BUILDING_LIBCXXABI -D_LIBCXXABI_BUILDING_LIBRARY \
        -DLIBCXXABI_NON_DEMANGLING_TERMINATE -D_LIBCXXABI_HAS_NO_THREADS -D_LIBUNWIND_HAS_NO_THREADS \
        -D_LIBUNWIND_HIDE_SYMBOLS -DNDEBUG -w -- \
        "${sources[@]}" "$root/libunwind/src/Unwind-wasm.c" "$here"/{setjmp.c,realpath.c,digits.cpp}
    cp "$prefix/lib/libc++.a" "$prefix/lib/libc++abi.a"  # clang names both
}

pkgconfig() {  # NAME VERSION LIBRARY
    printf '%s\n' "prefix=$prefix" "Name: $1" "Description: $1" "Version: $2" "Libs: -L\${prefix}/lib -l$3" \
        "Cflags: -I\${prefix}/include" >"$prefix/lib/pkgconfig/$1.pc"
}

# Its inflater alone, in C, as for processors that it does not know.
with_isal_in_c() {
    local root
    root=$(source_of libisal)
    mkdir -p "$prefix/include/isa-l"
    cp "$root"/include/*.h "$prefix/include/isa-l"
    printf '#include <isa-l/%s>\n' crc.h crc64.h igzip_lib.h >"$prefix/include/isa-l.h"
    printf '#define ISAL_%s\n' 'MAJOR_VERSION 2' 'MINOR_VERSION 30' 'PATCH_VERSION 0' >>"$prefix/include/isa-l.h"
    compile_all libisal libisal.a -Os -I"$root/include" -I"$root/igzip" -w -- \
        "$root"/igzip/{igzip_inflate,igzip,hufftables_c}.c "$root"/igzip/adler32_base.c \
        "$root"/crc/{crc_base,crc_base_aliases}.c "$here/isal.c"
    pkgconfig libisal 2.30.0 isal
}

with_c_libraries() {
    local root
    root=$(source_of zlib)
    cp "$root/zlib.h" "$root/zconf.h" "$prefix/include"
    compile_all zlib libz.a -w -- \
        "$root"/{adler32,crc32,deflate,inffast,inflate,inftrees,trees,zutil,compress,uncompr}.c
    root=$(source_of libdeflate)
    cp "$root/libdeflate.h" "$prefix/include"
    compile_all libdeflate libdeflate.a -Os -I"$root" -w -- "$root"/lib/{adler32,crc32,deflate_compress}.c \
        "$root"/lib/{deflate_decompress,utils,zlib_compress,zlib_decompress}.c
    pkgconfig libdeflate 1.14 deflate
    root=$(source_of libzstd)
    # The way in which it looks for matches, and so its bytes, must be those of processors with vectors.
    sed -i 's/kHasSIMD128 = 0/kHasSIMD128 = 1/' "$root/lib/compress/zstd_compress.c"
    # libtex has no dictionaries: the functions that search them need not be linked.
    sed -Ei '/^ZSTD_blockCompressor ZSTD_selectBlock/,/^}/ s/_(dictMatchState|dedicatedDictSearch)//' \
        "$root/lib/compress/zstd_compress.c"
    cp "$root/lib/zstd.h" "$root/lib/zstd_errors.h" "$prefix/include"
    # It has two decoders for the same data; these macros keep the smaller one.
    compile_all libzstd libzstd.a -Os -DZSTD_DISABLE_ASM -DZSTD_LEGACY_SUPPORT=0 -DHUF_FORCE_DECOMPRESS_X1 \
        -DZSTD_FORCE_DECOMPRESS_SEQUENCES_SHORT -w -- "$root"/lib/common/*.c "$root"/lib/compress/*.c \
        "$root"/lib/decompress/*.c
    pkgconfig libzstd 1.5.4 zstd
}

# OpenEXR's headers and its exceptions without std::stringstream, which would link all of <locale>. $1: its sources.
without_streams() {
    local stream='std::stringstream' text='IEX_NAMESPACE::Text'
    ! grep -q "$text" "$1/Iex/IexMacros.h" || return 0
    sed -i -e "s/$stream/$text/" -e 's/ (_iex_\(append\|replace\)_s)/ (_iex_\1_s.str ())/' \
        -e "/^#include \"IexForward.h\"/r $here/iex_text.inc" "$1/Iex/IexMacros.h"
    sed -i -e '0,/^#include/s//#include <IexMacros.h>\n#include/' -e "s/$stream s;/$text s;/" \
        "$1"/OpenEXR/Imf{Header,ChannelListAttribute}.cpp
    sed -i -e "/StdOSStream oss;/{r $here/imf_bytes.inc" -e 'd}' "$1/OpenEXR/ImfHeader.cpp"
}

build_wasm_libraries() {
    mkdir -p "$work/build" "$prefix/lib/pkgconfig" "$prefix/include" "$prefix/share/cmake"
    cp -rp /usr/include/nlohmann "$prefix/include"
    cp -rp /usr/share/cmake/nlohmann_json "$prefix/share/cmake"
    cp -rp /usr/include/fmt /usr/include/toml++ "$prefix/include"
    mkdir -p "$prefix/lib/cmake/fmt"
    printf '%s\n' 'add_library(fmt::fmt INTERFACE IMPORTED)' \
        'target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY)' >"$prefix/lib/cmake/fmt/fmtConfig.cmake"
    with_cxx
    mkdir -p "$prefix/lib/cmake/TBB" # whose place headers in one_thread take
    printf 'add_library(TBB::tbb INTERFACE IMPORTED)\n' >"$prefix/lib/cmake/TBB/TBBConfig.cmake"
    with_c_libraries
    with_isal_in_c
    with_cmake libpng1.6 "${small[@]}" -DPNG_SHARED=OFF -DPNG_TESTS=OFF "${position[@]}" -DPNG_EXECUTABLES=OFF \
        -DPNG_HARDWARE_OPTIMIZATIONS=OFF -DM_LIBRARY=m -DPNG_BUILD_ZLIB=OFF
    # Floats of halves come from the bits, not from a table of 256 KB.
    with_cmake imath "${small[@]}" -DPYTHON=OFF "${position[@]}" -DIMATH_HALF_USE_LOOKUP_TABLE=OFF
    # OpenEXR 3.1's new core asks whether the setting is defined, not what it is.
    sed -i 's/^#ifdef ILM\(THREAD\|BASE\)_THREADING_ENABLED/#if ILMTHREAD_THREADING_ENABLED/' \
        "$(source_of openexr)"/src/lib/OpenEXRCore/*.[ch]
    without_streams "$(source_of openexr)/src/lib"
    with_cmake openexr "${small[@]}" -DOPENEXR_BUILD_TOOLS=OFF -DOPENEXR_INSTALL_EXAMPLES=OFF \
        -DOPENEXR_INSTALL_TOOLS=OFF -DOPENEXR_ENABLE_THREADING=OFF "${position[@]}"
    with_cmake highway -DHWY_ENABLE_TESTS=OFF -DHWY_ENABLE_EXAMPLES=OFF -DHWY_ENABLE_CONTRIB=OFF "${position[@]}"
}
