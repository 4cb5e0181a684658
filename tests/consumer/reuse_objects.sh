#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# reuse_objects.sh COMPILER ARGUMENT...: a compiler launcher that takes the objects of libtex from the build folder
# TEX_OBJECTS, so that a test can build a project that adds libtex without compiling libtex again. All else is compiled,
# unless TEX_OBJECTS_OF is "all": then the project is libtex itself, and every object of that build folder is taken.
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
if [ "${TEX_OBJECTS_OF:-libtex}" = all ] && [ -n "$output" ]; then
    ready=$TEX_OBJECTS/$output
elif [[ $output == *"$here"* ]]; then
    ready=$TEX_OBJECTS/$here${output##*"$here"}
else
    exec "$@"
fi
[ -e "$ready" ] || exec "$@"
cp "$ready" "$output"
[ -z "$dependencies" ] || : >"$dependencies"
