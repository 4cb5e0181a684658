#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# manual.sh: writes man/*.md, the manual as Markdown, from the templates man/*.in. tests/lint.sh fails if they differ.
#
#     tests/manual.sh [FOLDER]    default: man
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
out=${1:-man}
page=$(mktemp)
trap 'rm -f "$page"' EXIT
for source in man/*.in; do
    cmake -D IN="$source" -D OUT="$page" -P man/assemble.cmake
    # The last line names the system on which it was made.
    mandoc -T markdown "$page" | sed '$d' >"$out/$(basename "$source" .in).md"
done
