#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tidy.sh: clang-tidy's checks for mistakes, safety and speed (.clang-tidy names them) on libtex and the commands; a finding is an error.
#
#     tests/tidy.sh [FILE...]    all sources of libtex and tools, or those named
#
# Needs clang-tidy-14. The commands to compile are those of the preset `fuzz`, which is clang's and sees each kernel once. All files take about 11 minutes of a processor.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
files=("$@")
if [ "${#files[@]}" -eq 0 ]; then mapfile -t files < <(find libtex/src tools -name '*.cpp' | sort); fi
[ -e build/fuzz/compile_commands.json ] || cmake --preset fuzz >/dev/null
# What it counts of headers of others goes to standard error.
printf '%s\0' "${files[@]}" | xargs -0 -n 1 -P "$(nproc)" clang-tidy-14 --quiet -p build/fuzz 2>/dev/null || { echo "tidy: findings" >&2; exit 1; }
