#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# .git/hooks/pre-commit: refuses a commit whose normal maps have errors. Checks the staged contents of the staged files.
# check-normals is in the Debian package libtex-tools.
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/staged"
git diff --cached --name-only -z --diff-filter=ACMR -- '*_n.dds' '*_n.ktx2' '*_n.png' '*_n.exr' '*_n.tga' '*_n.tif' \
    >"$work/list"
[ -s "$work/list" ] || exit 0
git checkout-index -z --stdin --prefix="$work/staged/" <"$work/list"
# In that folder, so that names and fixes are those of the repository.
cd "$work/staged"
check-normals --require y=up --quiet --files-from "$work/list"
