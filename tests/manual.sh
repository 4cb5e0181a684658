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
# Between backticks Markdown decodes no entities, and mandoc's quotes around them would be part of the text.
code_spans() {
    awk 'BEGIN { FS = OFS = "`" } NF % 2 { for (k = 2; k < NF; k += 2) {
            gsub(/&lt;/, "<", $k); gsub(/&gt;/, ">", $k); gsub(/&#34;/, "\"", $k); gsub(/&#45;/, "-", $k)
            if ($(k - 1) ~ /\047$/ && $(k + 1) ~ /^\047/) { sub(/\047$/, "", $(k - 1)); sub(/^\047/, "", $(k + 1)) }
        } } { print }'
}
for source in man/*.in; do
    cmake -D IN="$source" -D OUT="$page" -P man/assemble.cmake
    # The last line names the system on which it was made.
    mandoc -T markdown "$page" | sed '$d' | code_spans >"$out/$(basename "$source" .in).md"
done
