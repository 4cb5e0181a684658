#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# npm_commands.sh: tests `npx libtex COMMAND` of an installed package beside the commands of build/release: outputs,
# messages, exit codes, what is out of reach, and signals.
#
#     tests/npm_commands.sh FOLDER [SETS [--cli]]    FOLDER: where npm has installed the package; SETS: random command
#                                                    lines, 500 if none is given; --cli: tests/cli, too
#
# The last line is "npm: N passed, M failed, K skipped".
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
installed=$(realpath "$1")
native=$PWD/build/release samples=$PWD/samples
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
passed=0 failed=0 skipped=0
# check WHAT COMMAND...: one test.
check() {
    local what=$1
    shift
    if "$@"; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "npm: FAILED: $what"; fi
}

# The commands by the names that scripts know. npx itself is asked once: it takes half a second.
mkdir "$scratch/bin"
for command in tools/*-normals.cpp; do
    command=$(basename "$command" .cpp)
    printf '#!/bin/sh\nexec node "%s" %s "$@"\n' "$installed/node_modules/libtex/cli.js" "$command" \
        >"$scratch/bin/$command"
done
chmod +x "$scratch"/bin/*
web() { "$scratch/bin/$1" "${@:2}"; }

by_npx() {
    [ "$(cd "$installed" && npx --no -- libtex bake-normals --version)" = "$("$native/bake-normals" --version)" ]
}
# What portable archives make on each system, but for what the reader programs write and read.
same_outputs() {
    sed -E '/container (tiff|jpeg)|from-(tif|jpg)/d' tests/portable_outputs.sh >"$scratch/outputs.sh"
    sh "$scratch/outputs.sh" "$native" "$samples" "$scratch/native" >"$scratch/native.sums" &&
        sh "$scratch/outputs.sh" "$scratch/bin" "$samples" "$scratch/web" >"$scratch/web.sums" &&
        [ "$(wc -l <"$scratch/web.sums")" -gt 60 ] && diff "$scratch/native.sums" "$scratch/web.sums"
}
# said COMMAND ARGUMENT...: the same exit code and the same words on both streams.
said() {
    local status_a=0 status_b=0 file
    (cd samples && "$native/$1" "${@:2}") >"$scratch/a.out" 2>"$scratch/a.err" </dev/null || status_a=$?
    (cd samples && web "$@") >"$scratch/b.out" 2>"$scratch/b.err" </dev/null || status_b=$?
    [ "$status_a" -eq "$status_b" ] || { echo "exit codes: $status_a, $status_b"; return 1; }
    for file in "$scratch"/[ab].{out,err}; do sed -i 's/,"seconds":[-+.e0-9]*//' "$file"; done
    diff "$scratch/a.out" "$scratch/b.out" && diff "$scratch/a.err" "$scratch/b.err"
}
every_help() {
    local command
    for command in "$scratch"/bin/*; do said "$(basename "$command")" --help || return 1; done
}
by_pipe() {
    local options=(- -o - --format bc5 --container dds --quiet) sum
    sum=$("$native/bake-normals" "${options[@]}" <samples/waves.png | sha256sum)
    [ "$(web bake-normals "${options[@]}" <samples/waves.png | sha256sum)" = "$sum" ] &&
        [ "$(web bake-normals "${options[@]}" <samples/waves.png | web check-normals - --json | head -c 1)" = '{' ]
}
# Neighbours of what arguments and lists of them name are within reach. A list from standard input opens nothing.
no_further() {
    local status=0
    mkdir -p "$scratch/far/secret" "$scratch/far/near"
    cp samples/y_axis.png "$scratch/far/secret"
    echo "$scratch/far/secret/y_axis.png" >"$scratch/far/near/list"
    (
        cd "$scratch/far/near"
        web check-normals --files-from list --quiet >"$scratch/said" 2>&1 || status=$?
        [ "$status" -eq 1 ] || { cat "$scratch/said"; return 1; }
        status=0
        web check-normals --files-from - --quiet <list >"$scratch/said" 2>&1 || status=$?
        [ "$status" -ge 2 ] && grep -qi 'capabilities insufficient' "$scratch/said"
    )
}
devices_stay() {
    mknod "$scratch/null" c 1 3 2>/dev/null || { skipped=$((skipped + 1)); return 0; }
    web bake-normals samples/waves.png -o "$scratch/null" --format bc5 --container dds --quiet && [ -c "$scratch/null" ]
}
rights_stay() {
    cp samples/waves.png "$scratch/heights.png"
    touch "$scratch/target.png" && chmod 640 "$scratch/target.png"
    ln -sf target.png "$scratch/link.png"
    web bake-normals "$scratch/heights.png" -o "$scratch/link.png" --format rgb8 --quiet &&
        [ "$(stat -c %a "$scratch/target.png")" = 640 ] && [ -s "$scratch/target.png" ] && [ -L "$scratch/link.png" ]
}
# A signal ends the command as it ends the native one, and leaves no file. $1: the signal, $2: seconds.
ends_by() {
    local status=0
    mkdir -p "$scratch/stopped"
    (trap - INT; exec node -e '
        const { spawn } = require("node:child_process");
        const [program, signal, after, ...rest] = process.argv.slice(1);
        const child = spawn(program, rest, { stdio: "ignore" });
        setTimeout(() => child.kill(signal), 1000 * after);
        child.on("exit", (code, by) => { console.log(by ?? code); });' \
        "$scratch/bin/bake-normals" "$1" "$2" "$scratch/large.png" -o "$scratch/stopped/a.dds" --format bc7 \
        --effort best) >"$scratch/said" || status=$?
    if [ "$(cat "$scratch/said")" = "$1" ] && [ -z "$(ls -A "$scratch/stopped")" ]; then return 0; fi
    cat "$scratch/said"
    ls -A "$scratch/stopped"
    return 1
}

check 'npx finds the command' by_npx
check 'help of all commands' every_help
check 'the same outputs' same_outputs
check 'an unknown option' said bake-normals waves.png --kernle sobel
check 'a missing file' said check-normals absent.png
check 'a file in place of a folder' said bake-normals waves.png -o waves.png/x.png
check 'a damaged file' said check-normals broken/N101-unreadable.dds
check 'findings' said check-normals y_axis.png --require y=up
check 'a report' said check-normals waves.png bricks.png --json
check 'a folder that does not exist' said bake-normals waves.png -o /absent/folder/a.png
check 'many files' said check-normals 'broken/**/N[12]*.dds' --require mips=full
check 'standard streams' by_pipe
check 'folders that are not named are closed' no_further
check 'a device stays' devices_stay
check 'rights and links stay' rights_stay
"$native/scale-normals" samples/bricks.png --scale 1 -o "$scratch/large.png" --extent 4096 --quiet 2>/dev/null ||
    /usr/bin/convert -size 4096x4096 plasma:fractal -colorspace gray "$scratch/large.png"
check 'SIGINT' ends_by SIGINT 2
check 'SIGTERM at the start' ends_by SIGTERM 0.4

check 'random command lines' node tests/npm_sets.mjs "$native" "$scratch/bin" samples "${2:-500}"

# The tests of the commands, but those named in npm_exceptions.txt, which says how far this has been tried. An hour or
# more, because each command starts node.
if [ "${3:-}" = --cli ]; then
    except=$(sed -n 's/^\([^ #]\+\).*/\1/p' tests/npm_exceptions.txt | paste -sd:)
    TEX_PROGRAMS=$scratch/bin "$native/cli_tests" --gtest_filter="-$except" >"$scratch/cli.log" 2>&1 || true
    grep -E '^\[  (FAILED|PASSED) ' "$scratch/cli.log" || true
    passed=$((passed + $(grep -c '^\[       OK \]' "$scratch/cli.log" || true)))
    skipped=$((skipped + $(grep -c '^\[  SKIPPED \].*ms)' "$scratch/cli.log" || true)))
    failed=$((failed + $(grep -c '^\[  FAILED  \].*ms)' "$scratch/cli.log" || true)))
fi
echo "npm: $passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
