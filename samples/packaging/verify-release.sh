#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# verify-release.sh FOLDER [--key PUBLIC_KEY] [--clone CLONE] [--rebuild]: checks a release that release.sh made,
# without trust in the machine that made it:
#
#     always      SHA256SUMS names every file and agrees with it; the SBOM names the same files and sums; packages and
#                 sources state the same version
#     --key       the signature of SHA256SUMS, by minisign or signify
#     --clone     the sources are those of the commit that the SBOM names, in a clone that you trust: bit for bit
#     --rebuild   with --clone: everything is made again from that commit, and has the same sums, in any folder. It
#                 needs the compiler and the packages of the release, which the SBOM lists
set -euo pipefail
export LC_ALL=C
fail() { echo "verify-release.sh: $*" >&2; exit 1; }

[ $# -ge 1 ] || fail 'usage: verify-release.sh FOLDER [--key PUBLIC_KEY] [--clone CLONE] [--rebuild]'
folder=$(cd "$1" && pwd)
shift
key='' clone='' rebuild=no
while [ $# -gt 0 ]; do
    case $1 in
    --key) key=${2:?}; shift 2 ;;
    --clone) clone=$(cd "${2:?}" && pwd); shift 2 ;;
    --rebuild) rebuild=yes; shift ;;
    *) fail "unknown option $1" ;;
    esac
done
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$folder"

# -- the sums, and who vouches for them -----------------------------------------------------------------------
[ -e SHA256SUMS ] || fail 'there is no SHA256SUMS'
if [ -n "$key" ]; then
    if [ -e SHA256SUMS.minisig ]; then
        minisign -V -q -p "$key" -m SHA256SUMS || fail 'the signature is wrong'
    elif [ -e SHA256SUMS.sig ]; then
        signify=$(command -v signify-openbsd || command -v signify) || fail 'signify is not installed'
        "$signify" -V -q -p "$key" -m SHA256SUMS || fail 'the signature is wrong'
    else
        fail 'there is no signature'
    fi
else
    echo 'verify-release.sh: note: without --key, nobody vouches for SHA256SUMS'
fi
sha256sum --quiet --strict --check SHA256SUMS || fail 'a file is not the one of SHA256SUMS'
sed 's/^[0-9a-f]*  //' SHA256SUMS >"$scratch/named"
find . -type f ! -name 'SHA256SUMS*' -printf '%P\n' | sort | diff "$scratch/named" - >/dev/null ||
    fail 'SHA256SUMS does not name all files, or names others'

# -- the files agree with each other --------------------------------------------------------------------------
sbom=$(ls libtex-*.spdx.json)
version=${sbom#libtex-}
version=${version%.spdx.json}
commit=$(python3 - "$sbom" SHA256SUMS <<'END'
import json
import sys

document = json.load(open(sys.argv[1], encoding="utf-8"))
sums = dict(reversed(line.split()) for line in open(sys.argv[2], encoding="utf-8"))
files = {file["fileName"][2:]: file["checksums"][0]["checksumValue"] for file in document["files"]}
sums.pop(sys.argv[1])
if files != sums:
    sys.exit("verify-release.sh: the SBOM does not name the files and sums of SHA256SUMS")
print(document["packages"][0]["sourceInfo"].split()[-1])
END
)
archive=libtex-$version.tar.gz
[ -e "$archive" ] || fail "there is no $archive"
tar -xzOf "$archive" "libtex-$version/CMakeLists.txt" >"$scratch/CMakeLists.txt"
grep -q "^project(libtex VERSION $version " "$scratch/CMakeLists.txt" || fail "the sources are not of version $version"
for package in *.deb; do
    [ -e "$package" ] || continue
    [[ $(dpkg-deb --field "$package" Version) == "$version"-* ]] || fail "$package is not of version $version"
done

# -- the sources are those of the commit ----------------------------------------------------------------------
if [ -n "$clone" ]; then
    git -C "$clone" archive --format=tar --prefix="libtex-$version/" "$commit" | gzip -9 -n >"$scratch/$archive"
    cmp "$archive" "$scratch/$archive" || fail "the sources are not those of commit $commit"
fi
if [ "$rebuild" = yes ]; then
    [ -n "$clone" ] || fail '--rebuild needs --clone'
    git clone --quiet --no-hardlinks "$clone" "$scratch/clone"
    git -C "$scratch/clone" checkout --quiet "$commit"
    options=()
    if ! ls ./*.deb >/dev/null 2>&1; then options=(--source-only); fi
    "$scratch/clone/samples/packaging/release.sh" "${options[@]}" "$version" "$scratch/again" >/dev/null
    diff SHA256SUMS "$scratch/again/SHA256SUMS" || fail 'what was made again has other sums'
fi
echo "libtex $version, commit $commit: $(wc -l <SHA256SUMS) files are right"
