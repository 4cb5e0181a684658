#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# release.sh [--source-only] VERSION [FOLDER]: makes what a release consists of, from the commit that is checked out in
# a clean clone, in FOLDER (by default build/release-VERSION):
#
#     libtex-VERSION.tar.gz        the sources; the same bytes wherever it is made
#     *.deb                        the Debian packages, built from that archive, not from the clone
#     libtex-*.tar.xz, tex-*.whl   the archives for every Linux on x86-64 and arm64, and the wheel, by portable.sh
#     libtex-*.zip                 the archive for Windows, by windows.sh
#     libtex-VERSION.abi           the binary interface of libtex.so, if abidw (abigail-tools) is installed
#     libtex-VERSION.spdx.json     what it is made of (SPDX 2.3)
#     SHA256SUMS                   of all of these
#     SHA256SUMS.minisig, .sig     if MINISIGN_KEY or SIGNIFY_KEY names a secret key
#
# --source-only leaves the packages and archives out. verify-release.sh checks the folder without trust in this machine.
# Dates in files are that of the commit (SOURCE_DATE_EPOCH).
set -euo pipefail
export LC_ALL=C TZ=UTC
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
here=$PWD
fail() { echo "release.sh: $*" >&2; exit 1; }

source_only=no
if [ "${1:-}" = --source-only ]; then source_only=yes; shift; fi
case $# in 1 | 2) ;; *) fail 'usage: release.sh [--source-only] VERSION [FOLDER]' ;; esac
version=$1
out=${2:-$here/build/release-$version}

# -- what is released -----------------------------------------------------------------------------------------
[ -z "$(git status --porcelain)" ] || fail 'the clone has changes: commit or remove them'
stated=$(sed -n 's/^project(libtex VERSION \([0-9.]*\) .*/\1/p' CMakeLists.txt)
[ "$version" = "$stated" ] || fail "CMakeLists.txt states version $stated, not $version"
[ "$source_only" = yes ] || grep -q "^## \[$version\] - 20" CHANGELOG.md ||
    fail "CHANGELOG.md has no [$version] with a date"
grep -q "^libtex ($version-" libtex/debian/changelog || fail "libtex/debian/changelog does not begin with $version"
[ ! -e "$out" ] || fail "$out exists"
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
export SOURCE_DATE_EPOCH
commit=$(git rev-parse HEAD)

# Made beside its place: a folder with this name is complete.
work=$out.unfinished
rm -rf "$work"
mkdir -p "$work/made"
trap 'rm -rf "$work"' EXIT

# -- the sources ----------------------------------------------------------------------------------------------
archive=libtex-$version.tar.gz
git archive --format=tar --prefix="libtex-$version/" HEAD | gzip -9 -n >"$work/made/$archive"

# -- what is built from them ----------------------------------------------------------------------------------
built=()
if [ "$source_only" = no ]; then
    tar -C "$work" -xzf "$work/made/$archive"
    cd "$work/libtex-$version"
    cmake --preset debian >"$work/log" || { cat "$work/log"; exit 1; }
    cmake --build --preset debian
    (cd build/debian && cpack -B "$work/packages" >"$work/log") || { cat "$work/log"; exit 1; }
    mv "$work"/packages/*.deb "$work/made"
    samples/packaging/portable.sh --wheel
    samples/packaging/portable.sh --arm64
    samples/packaging/windows.sh
    mv build/portable*/libtex-*.tar.xz build/portable/tex-*.whl build/windows/libtex-*.zip "$work/made"
    if command -v abidw >/dev/null; then
        (cd "$here" && tests/abi.sh --write "$work/made/libtex-$version.abi")
    fi
    cd "$here"
    mapfile -t built < <(cd "$work/made" && find . -type f ! -name "$archive" -printf '%P\n' | sort)
fi

# -- what describes them --------------------------------------------------------------------------------------
python3 samples/packaging/sbom.py "$version" "$commit" "$SOURCE_DATE_EPOCH" "$work/made" "$archive" "${built[@]}"
(cd "$work/made" && sha256sum -- * >"$work/SHA256SUMS" && mv "$work/SHA256SUMS" .)
if [ -n "${MINISIGN_KEY:-}" ]; then
    minisign -S -s "$MINISIGN_KEY" -t "libtex $version $commit" -m "$work/made/SHA256SUMS"
fi
if [ -n "${SIGNIFY_KEY:-}" ]; then
    signify=$(command -v signify-openbsd || command -v signify) || fail 'signify is not installed'
    "$signify" -S -s "$SIGNIFY_KEY" -m "$work/made/SHA256SUMS"
fi
mkdir -p "$(dirname "$out")"
mv "$work/made" "$out"
echo "libtex $version, commit $commit:"
cat "$out/SHA256SUMS"
