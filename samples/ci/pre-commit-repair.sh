#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# .git/hooks/pre-commit: repairs staged normal maps. It undoes what the texels prove, in the files of the working tree,
# and then refuses the commit, so that somebody looks at the maps and stages them again. repair-normals is in the Debian
# package libtex-tools. pre-commit.sh checks without changing anything; run it, too, where the direction of green is
# required, which repair-normals does not know.
set -eu
list=$(mktemp)
trap 'rm -f "$list"' EXIT
# The names of pre-commit.sh, without types that lose something each time.
set --
for type in dds ktx2 png exr tga tif tiff bmp; do
    for end in '[_-]n' '[_-]nm' '[_-]nrm' '[_-]nor' '[_-]norm' 'normal*'; do set -- "$@" ":(icase)*$end.$type"; done
done
git diff --cached --name-only -z --diff-filter=ACMR -- "$@" >"$list"
[ -s "$list" ] || exit 0
if ! xargs -0 git diff --quiet -- <"$list"; then
    echo 'A staged normal map has changes that are not staged: stage or stash them.' >&2
    exit 1
fi
repaired=0
# shellcheck disable=SC2016  # the inner shell expands it
xargs -0 -n 1 sh -c 'exec repair-normals --quiet "./$0" -o "./$0"' <"$list" || repaired=1
if ! xargs -0 git diff --quiet -- <"$list"; then
    xargs -0 git diff --name-only -- <"$list" | sed 's/$/: repaired; look at it, then git add and commit again/' >&2
    repaired=1
fi
exit $repaired
