#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# release.sh BUILD: samples/packaging/release.sh makes the same release of two clones, and verify-release.sh accepts it,
# and nothing that was changed. The sources alone: packages are built by the test consumer.packages.
set -euo pipefail
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
scratch=$1/release-test
fail() { echo "release.sh: $*" >&2; exit 1; }
if ! git -C "$source" rev-parse HEAD >/dev/null 2>&1; then
    echo 'release.sh: the sources are not a clone: nothing was tried'
    exit 0
fi
rm -rf "$scratch"
mkdir -p "$scratch"
version=$(sed -n 's/^project(libtex VERSION \([0-9.]*\) .*/\1/p' "$source/CMakeLists.txt")
# The files of the working folder, committed or not, as a commit of a clone.
git clone --quiet --shared "$source" "$scratch/one"
(cd "$source" && git ls-files -z --cached --others --exclude-standard |
    while read -r -d '' file; do if [ -e "$file" ]; then printf '%s\0' "$file"; fi; done |
    tar --null -T - -cf -) | tar -C "$scratch/one" -xf -
(
    cd "$scratch/one"
    export GIT_AUTHOR_DATE='2026-01-01T00:00:00Z' GIT_COMMITTER_DATE='2026-01-01T00:00:00Z'
    git add -A
    git -c user.name=test -c user.email=test@example.org commit --quiet --allow-empty -m 'A release for a test'
)
git clone --quiet "$scratch/one" "$scratch/two"
make=samples/packaging/release.sh verify=$scratch/one/samples/packaging/verify-release.sh
for clone in one two; do "$scratch/$clone/$make" --source-only "$version" "$scratch/made-$clone" >/dev/null; done
diff -r "$scratch/made-one" "$scratch/made-two" || fail 'two clones make different releases'
"$verify" "$scratch/made-one" --clone "$scratch/two" --rebuild >/dev/null

# refused WHY COMMAND...: the command fails.
refused() {
    local why=$1
    shift
    ! "$@" >/dev/null 2>&1 || fail "accepted: $why"
}
refused 'another version' "$scratch/one/$make" --source-only 9.9.9 "$scratch/other"
echo >>"$scratch/two/README.md"
refused 'a clone with changes' "$scratch/two/$make" --source-only "$version" "$scratch/other"
[ ! -e "$scratch/other" ] || fail 'a refused release left files'
for file in "libtex-$version.tar.gz" SHA256SUMS "libtex-$version.spdx.json"; do
    cp -r "$scratch/made-one" "$scratch/changed"
    printf 'x' >>"$scratch/changed/$file"
    refused "a changed $file" "$verify" "$scratch/changed"
    rm -r "$scratch/changed"
done
cp -r "$scratch/made-one" "$scratch/changed"
touch "$scratch/changed/more.deb"
refused 'a file without a sum' "$verify" "$scratch/changed"
