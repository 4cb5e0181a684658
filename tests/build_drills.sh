#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# build_drills.sh: kills build-normals at random moments, runs it twice at once, and makes the same tree in many ways.
#
#     tests/build_drills.sh [KILLS [BUILD]]    default: 100 build/release
#
# After every SIGKILL, each output must be whole: the old one, the new one or none. After the kills, one run must make
# all outputs right and leave no other file. Then two builders work on one tree and one cache at once. At last the tree
# is made with 1, 2 and 8 threads, as 1, 3 and 7 shards, from the cache, and by GNU parallel if it is installed; the
# bytes must be equal. Then build_drills.py makes five random trees for each kill. A short version is in ctest.
#
# Last result: November 26, 2026, 2 processors, release: 100 of 130 runs killed, 49 outputs right, nothing else left;
# two builders right; all ways gave the same bytes, with GNU parallel too; 500 random trees lost nothing. 96 s, busy.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
kills=${1:-100}
build=$(cd "${2:-build/release}" && pwd)
samples=$PWD/samples drills=$PWD/tests/build_drills.py
export PATH=$build:$PATH
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
RANDOM=1
fail() { echo "build_drills: $*" >&2; exit 1; }

# -- a tree, and what it becomes ------------------------------------------------------------------------------------
mkdir -p "$scratch/tree/art/deep" "$scratch/expected"
cd "$scratch/tree"
for ((k = 0; k < 24; ++k)); do
    inputs=("$samples"/{bricks,hemisphere,ramp,waves}.png)
    cp "${inputs[k % 4]}" "art/$([ $((k % 2)) -eq 0 ] || echo deep/)h$k.png"
done
cp "$samples/waves.png" grain.png
cat >normals.toml <<'MANIFEST'
version = 1
[defaults]
out-dir = "out"
[[rule]]
match = "grain.png"
steps = [ { bake = { bumpiness = 2 } } ]
[[rule]]
match = "art/**/*.png"
steps = [ { bake = { bumpiness = 4 } }, { blend = { detail = "out/grain.dds", tiling = 4 } } ]
outputs = [ { name = "{dir}/{stem}_n.dds" }, { format = "bc5", y = "down", name = "{dir}/{stem}_ue.ktx2" } ]
MANIFEST
start=$(date +%s%N)
build-normals --quiet --no-sync
span=$((($(date +%s%N) - start) / 1000000)) # milliseconds
span=$((span < 900 ? span : 900))
mv out "$scratch/expected"
expected=$scratch/expected/out
outputs=$(find "$expected" -type f | wc -l)
fresh() { rm -rf out reports plan.jsonl .normals.toml.state ../cache; }
same() { diff -r "$expected" out >/dev/null || fail "$1: the outputs differ from those of one run"; }
# No file but the inputs, the outputs and the state.
nothing_else() {
    local found
    found=$(find . -type f ! -path './out/*' ! -path './art/*' ! -name grain.png ! -name normals.toml \
        ! -name .normals.toml.state)
    [ -z "$found" ] || fail "$1: is left: $found"
}

# -- killed at random moments ------------------------------------------------------------------------------------------
# The runs of the second half cannot use nameless files, as on NFS, if the test library exists.
killed=0 runs=0 preload=
fresh
while [ "$killed" -lt "$kills" ]; do
    if [ $((2 * killed)) -ge "$kills" ] && [ -z "$preload" ] && [ -e "$build/faults.so" ]; then
        preload=$build/faults.so
        fresh
    fi
    # There is something to do: outputs are lost, and often the cache.
    [ $((RANDOM % 4)) -eq 0 ] || rm -rf ../cache
    [ $((RANDOM % 4)) -eq 0 ] || rm -rf out
    [ $((RANDOM % 4)) -gt 0 ] || rm -f .normals.toml.state
    [ ! -d out ] || find out -type f -name "*$((RANDOM % 10))_*" -delete
    LD_PRELOAD=$preload TEX_FAULT_NO_TMPFILE=1 build-normals --quiet --no-sync --cache ../cache &
    sleep "$(printf '0.%03d' $((RANDOM % span)))"
    if kill -KILL $! 2>/dev/null; then killed=$((killed + 1)); fi
    wait $! 2>/dev/null || true
    runs=$((runs + 1))
    while read -r name; do
        cmp -s "out/$name" "$expected/$name" || fail "half of $name after kill $killed"
    done < <(if [ -d out ]; then cd out && find . -type f ! -name '.*.tex-tmp*'; fi)
done
LD_PRELOAD=$preload TEX_FAULT_NO_TMPFILE=1 build-normals --quiet --no-sync --cache ../cache
same "after $killed kills"
nothing_else "after $killed kills"
[ "$(build-normals)" = "0 made, 25 up to date" ] || fail "a second run makes something"
echo "$killed of $runs runs killed: all $outputs outputs right after one more run, nothing else left"

# -- two at once ------------------------------------------------------------------------------------------------------
for ((k = 0; k < (kills < 10 ? 2 : 10); ++k)); do
    rm -rf out .normals.toml.state
    [ $((k % 2)) -eq 0 ] || rm -rf ../cache
    build-normals --quiet --no-sync --cache ../cache --threads 2 &
    first=$!
    build-normals --quiet --no-sync --cache ../cache --threads 2 || fail "one of two builders ends with status $?"
    wait "$first" || fail "one of two builders ends with status $?"
    same "two builders at once"
    nothing_else "two builders at once"
    [ "$(build-normals)" = "0 made, 25 up to date" ] || fail "two builders have left a wrong state"
done
echo "two builders at once on one tree and one cache: right"

# -- the same bytes --------------------------------------------------------------------------------------------------
for threads in 1 2 8; do
    fresh
    build-normals --quiet --no-sync --threads "$threads"
    same "$threads threads"
done
for shards in 1 3 7; do
    fresh
    build-normals --plan plan.jsonl --quiet
    for ((k = 1; k <= shards; ++k)); do
        build-normals --plan plan.jsonl --shard "$k/$shards" --report "reports/$k.jsonl" --quiet --no-sync &
    done
    wait
    build-normals --plan plan.jsonl --merge reports/*.jsonl || fail "$shards shards are not complete"
    same "$shards shards"
done
fresh
build-normals --quiet --no-sync --cache ../cache
rm -rf out .normals.toml.state
[ "$(build-normals --no-sync --cache ../cache)" = "0 made, 0 up to date, 25 from the cache" ] || fail "the cache misses"
same "the cache"
ways="1, 2 and 8 threads; 1, 3 and 7 shards; the cache"
if command -v parallel >/dev/null; then
    fresh
    bash "$samples/farm/parallel.sh" : 5 >/dev/null
    same "GNU parallel"
    ways+="; GNU parallel"
fi
echo "the same bytes: $ways"

# -- random trees: links, odd names, documents that are inputs, damaged caches -----------------------------------------
python3 "$drills" $((5 * kills)) "$build"
