#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# platforms.sh: the README's two commands on other releases of Debian, each in a root of its own below build/platforms,
# which mmdebstrap makes (2 GB). The root has a clone of HEAD and, if it is here, ../shared. Needs root and mmdebstrap.
#
#     tests/platforms.sh [RELEASE...] [-- CTEST_OPTION...]    trixie, unless releases are named
#
# sid is only compiled: quickstart.sh alone. The last line is "platforms: N passed, M failed, K skipped". Exits 77
# without mmdebstrap, root or a mirror. A second run keeps the root and compiles what has changed. REMAKE=1 makes the
# roots again.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

releases=()
while [ $# -gt 0 ]; do
    if [ "$1" = -- ]; then shift; break; fi
    releases+=("$1")
    shift
done
[ "${#releases[@]}" -gt 0 ] || releases=(trixie)
mirror=${MIRROR:-http://deb.debian.org/debian}
ccache=$(ccache -k cache_dir 2>/dev/null || echo "$HOME/.cache/ccache")
if [ "$(id -u)" -ne 0 ] || ! command -v mmdebstrap >/dev/null; then
    echo 'platforms: not run: needs root and mmdebstrap'
    exit 77
fi

make_root() {
    rm -rf "$root" "$root.new"
    mkdir -p "$(dirname "$root")"
    # A mirror that stands still has an index of sid that is past its date. It must be signed all the same.
    mmdebstrap --quiet --variant=apt --include=ca-certificates,ccache,git \
        --aptopt='Acquire::Check-Valid-Until "false"' "$1" "$root.new" "$mirror" && mv "$root.new" "$root"
}

# Clones HEAD into the root, or brings the clone there up to date; files that are the same keep their times.
clone() {
    local tree=$root/tree/libtex
    if [ ! -d "$tree" ]; then
        mkdir -p "$root/tree"
        git clone -q --no-hardlinks . "$tree"
    fi
    git -C "$tree" fetch -q "$PWD" HEAD
    git -C "$tree" reset -q --hard FETCH_HEAD
}

# inside SCRIPT [ARGUMENT...]: runs a script in the root's clone. The mounts end with it.
inside() {
    mkdir -p "$root/tree/shared" "$root/ccache" "$ccache"
    # shellcheck disable=SC2016  # expanded in the shell that has the mounts
    unshare --mount --pid --fork --kill-child bash -euc '
        root=$1 ccache=$2 shared=$3
        mount -t proc proc "$root/proc"
        mount --rbind /dev "$root/dev"
        mount --rbind /sys "$root/sys"
        mount -t tmpfs tmpfs "$root/tmp"
        mount --bind "$ccache" "$root/ccache"
        if [ -d "$shared" ]; then mount --bind "$shared" "$root/tree/shared"; else rmdir "$root/tree/shared"; fi
        exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 CCACHE_DIR=/ccache CCACHE_BASEDIR=/tree \
            CCACHE_NOHASHDIR=1 CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime \
            CMAKE_CXX_COMPILER_LAUNCHER=ccache CTEST_PARALLEL_LEVEL="$(nproc)" CMAKE_BUILD_PARALLEL_LEVEL="$(nproc)" \
            chroot "$root" bash -euc "cd /tree/libtex; $4" "${@:4}"
    ' inside "$root" "$ccache" "$PWD/../shared" "$@"
}

attribute() { sed -n "/<testsuite /,/>/s/.*[[:space:]]$1=\"\([0-9]*\)\".*/\1/p" "$2" | head -n 1; }

passed=0
failed=0
skipped=0
for release in "${releases[@]}"; do
    root=$PWD/build/platforms/$release
    if [ -n "${REMAKE:-}" ] || [ ! -e "$root/etc/debian_version" ]; then
        make_root "$release" || { echo "platforms: not run: the mirror does not have $release"; exit 77; }
    fi
    clone
    echo "=== $release: samples/quickstart.sh"
    if inside 'samples/quickstart.sh'; then passed=$((passed + 1)); else failed=$((failed + 1)); continue; fi
    [ "$release" != sid ] || continue
    echo "=== $release: tests/run.sh $*"
    results=build/platforms.xml
    rm -f "$root/tree/libtex/$results"
    # shellcheck disable=SC2016
    inside 'tests/run.sh --output-junit "$PWD/$1" "${@:2}"' "$results" "$@" || true
    file=$root/tree/libtex/$results
    [ -e "$file" ] || { failed=$((failed + 1)); continue; }
    failures=$(attribute failures "$file")
    left=$(($(attribute skipped "$file") + $(attribute disabled "$file")))
    passed=$((passed + $(attribute tests "$file") - failures - left))
    failed=$((failed + failures))
    skipped=$((skipped + left))
    cp "$file" "build/platforms/$release.xml"
    sed -n "s/.*<testcase name=\"\([^\"]*\)\".*status=\"\(fail\|notrun\|disabled\)\".*/$release: \2: \1/p" "$file" |
        sort -u
done
echo "platforms: $passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
