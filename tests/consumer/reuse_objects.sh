#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# reuse_objects.sh COMPILER ARGUMENT...: a compiler launcher that takes the objects of libtex from the build folder
# TEX_OBJECTS, so that a test can build a project that adds libtex without compiling libtex again. All else is compiled.
set -euo pipefail
output='' dependencies=''
arguments=("$@")
for ((k = 0; k + 1 < $#; ++k)); do
    case ${arguments[k]} in
    -o) output=${arguments[k + 1]} ;;
    -MF) dependencies=${arguments[k + 1]} ;;
    esac
done
here=CMakeFiles/tex_objects.dir/
ready=$TEX_OBJECTS/$here${output##*"$here"}
if [[ $output != *"$here"* || ! -e $ready ]]; then exec "$@"; fi
cp "$ready" "$output"
[ -z "$dependencies" ] || : >"$dependencies"
