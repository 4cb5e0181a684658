#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# .git/hooks/pre-commit: refuses a commit whose normal maps have errors. Checks the staged contents of the staged files.
# check-normals is in the Debian package libtex-tools.
set -eu
staged=$(mktemp -d)
trap 'rm -rf "$staged"' EXIT
git diff --cached --name-only -z --diff-filter=ACMR -- '*_n.dds' '*_n.ktx2' '*_n.png' '*_n.exr' '*_n.tga' '*_n.tif' |
    git checkout-index -z --stdin --prefix="$staged/"
find "$staged" -type f -print0 >"$staged.list"
trap 'rm -rf "$staged" "$staged.list"' EXIT
[ -s "$staged.list" ] || exit 0
check-normals --require y=up --quiet --files-from "$staged.list"
