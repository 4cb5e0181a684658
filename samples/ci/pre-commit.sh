#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# .git/hooks/pre-commit: refuses a commit whose normal maps have errors. Checks the staged contents of the staged files.
# check-normals is in the Debian package libtex-tools. The repository's checks.toml and known.json are used if it has
# them: what the project demands, and the findings that it accepts (check-normals --baseline-write known.json).
set -eu
config=checks.toml
baseline=known.json
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/staged"
# What projects call normal maps; the end of the name decides, whatever its case.
set --
for type in dds ktx2 png exr tga tif tiff jpg jpeg webp bmp; do
    for end in '[_-]n' '[_-]nm' '[_-]nrm' '[_-]nor' '[_-]norm' 'normal*'; do set -- "$@" ":(icase)*$end.$type"; done
done
set -- "$@" ':(icase)*.glb'
git diff --cached --name-only -z --diff-filter=ACMR -- "$@" >"$work/list"
[ -s "$work/list" ] || exit 0
git checkout-index -z --stdin --prefix="$work/staged/" <"$work/list"
# Both stand beside the maps there as in the repository, so that their patterns and names fit.
git ls-files -z -- "$config" "$baseline" | git checkout-index -z --stdin --prefix="$work/staged/"
# In that folder, so that names and fixes are those of the repository.
cd "$work/staged"
set -- --quiet --files-from "$work/list"
if [ -f "$config" ]; then set -- --config "$config" "$@"; else set -- --require y=up "$@"; fi
if [ -f "$baseline" ]; then set -- --baseline "$baseline" "$@"; fi
check-normals "$@"
