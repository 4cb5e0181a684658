#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# long_runs.sh: bakes thousands of textures in one process, and runs many processes in one folder.
#
#     tests/long_runs.sh [TEXTURES [PROCESSES [BUILD]]]    default: 10000 64 build/release
#
# One bake-normals bakes TEXTURES height maps, the samples in turn. Meanwhile the script samples its memory and
# descriptors. Then PROCESSES processes write into one folder at once, four for each output. Prints the slope of the
# memory, in kB per 1000 textures, over the second half of the run. Fails if the slope is more than 3000 (a process
# keeps the names of its files, for --depfile), if the number of descriptors grows, if an output differs from the output
# of a single process, or if any other file is left.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
textures=${1:-10000} processes=${2:-64}
build=$(cd "${3:-build/release}" && pwd)
samples=$PWD/samples
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
fail() { echo "long_runs: $*" >&2; exit 1; }

# -- one process ----------------------------------------------------------------------------------------------
inputs=("$samples"/{hemisphere,ramp,strip,waves}.png)
mkdir in out
for ((k = 0; k < textures; ++k)); do ln -s "${inputs[k % ${#inputs[@]}]}" "in/$k.png"; done
(cd in && printf 'in/%s\n' *) >list
: >report  # it is read, perhaps before the process has begun
"$build/bake-normals" --files-from list --out-dir out --threads 2 --no-sync --json --quiet >report &
process=$!
while [ -r "/proc/$process/status" ]; do
    done=$(wc -l <report)
    rss=$(sed -n 's/^VmRSS:[[:space:]]*\([0-9]*\) kB/\1/p' "/proc/$process/status" 2>/dev/null || true)
    descriptors=$(find "/proc/$process/fd" -mindepth 1 2>/dev/null | wc -l || true)
    if [ -n "$rss" ] && [ "$done" -gt 0 ]; then echo "$done $rss $descriptors"; fi
    sleep 0.05
done >watched
wait "$process" || fail "bake-normals ends with status $?"
[ "$(find out -name '*.dds' | wc -l)" -eq "$textures" ] || fail "outputs are missing"
[ "$(find out -mindepth 1 | wc -l)" -eq "$textures" ] || fail "something is left beside the outputs"
[ "$(cat out/*.dds | sha256sum)" = "$(for name in out/*.dds; do
    k=${name#out/}
    k=${k%.dds}
    if [ ! -e "one$((k % 4)).dds" ]; then
        "$build/bake-normals" "in/$((k % 4)).png" -o "one$((k % 4)).dds" --no-sync --quiet
    fi
    cat "one$((k % 4)).dds"
done | sha256sum)" ] || fail "an output is not what its input makes alone"
# Least squares over the second half: memory in kB as a function of thousands of textures.
awk -v textures="$textures" '
    { if ($2 > peak) peak = $2; if (NR == 1 || $3 < fewest) fewest = $3; if ($3 > most) most = $3 }
    $1 >= textures / 2 && $1 < textures { n++; x += $1 / 1000; y += $2; xx += $1 * $1 / 1e6; xy += $1 / 1000 * $2 }
    END {
        slope = n > 2 && n * xx > x * x ? (n * xy - x * y) / (n * xx - x * x) : 0
        printf "%d textures in one process: at most %d kB, %d to %d descriptors", textures, peak, fewest, most
        if (textures >= 5000) printf ", %+.0f kB per 1000 textures (%d moments of the second half)", slope, n
        print ""
        exit textures >= 5000 && slope > 3000 || most > 40
    }' watched || fail "memory or descriptors grow"

# -- many processes --------------------------------------------------------------------------------------------
mkdir together
running=()
for ((k = 0; k < processes; ++k)); do
    # Half of them cannot use nameless files, if the test library exists.
    preload=
    if [ $((k % 2)) -eq 1 ] && [ -e "$build/faults.so" ]; then preload=$build/faults.so; fi
    pair=("${inputs[k / 4 % 4]}" "${inputs[(k / 4 + 1) % 4]}")
    LD_PRELOAD=$preload TEX_FAULT_NO_TMPFILE=1 "$build/bake-normals" \
        "${pair[@]}" --out-dir together --name "$((k / 4))_{stem}.dds" --no-sync --quiet &
    running+=($!)
done
for process in "${running[@]}"; do wait "$process" || fail "one of many processes ends with status $?"; done
for name in together/*; do
    stem=${name##*_}
    "$build/bake-normals" "$samples/${stem%.dds}.png" -o alone.dds --no-sync --quiet
    cmp -s alone.dds "$name" || fail "$name is not whole"
done
groups=$(((processes + 3) / 4))
[ "$(find together -mindepth 1 | wc -l)" -eq $((2 * groups)) ] ||
    fail "files are missing in the folder of many, or temporaries are left"
outputs=$(find together -name '*.dds' | wc -l)
echo "$processes processes at once in one folder: $outputs outputs, all whole, nothing else"
