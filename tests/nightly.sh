#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# nightly.sh: what takes too long for the gate (.ci/run), by hand: at the latest before an issue is called done.
# NIGHTLY.md says when it last ran, on which commit, and with what result. The last line counts all tests.
#
#     tests/nightly.sh [STEP...]    all steps, or the named ones: alone extremes long scalar commands slurm arm64 tsan
#                                   tidy fuzz package abi readers engines platforms portable windows npm
#                                   release
#
# FUZZ_SECONDS is the time for each fuzzer (default: 60). MODELS is a folder with more glTF models for the step engines.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=.ci/packages.sh
. .ci/packages.sh
# shellcheck source=.ci/steps.sh
. .ci/steps.sh
begin "$PWD/build/nightly" "$@"

# The build that most steps use.
build_release() {
    cmake --preset release -DBUILD_TESTING=ON -DTEX_PYTHON=ON -DTEX_OIIO=ON >"$results/release.configure.log" ||
        { cat "$results/release.configure.log"; return 1; }
    cmake --build --preset release
}

# The tests that the gate leaves out, and the drills at their full length.
long() {
    local status=0
    ctest --preset release --output-junit "$results/longest.xml" -R "$longest" || status=1
    script drills tests/build_drills.sh 100 || status=1
    script long_runs tests/long_runs.sh || status=1
    return "$status"
}

# Repeats the release's tests of the library, with kernels of one lane.
scalar() {
    LD_PRELOAD="$PWD/build/release/target.so" TEX_TARGET=SCALAR \
        ctest --preset release --output-junit "$results/scalar.xml" -L unit -E "$judgements|$failures|Reader|Target"
}

# Under the sanitizers: the commands, the Python module, and the tests of the library that the gate leaves out. And the
# bytes that commands make if the other compiler has compiled them, on two instruction sets.
commands() {
    local status=0
    preset asan "cli_tests tex_python" -L 'cli|python' -E "$judgements" || status=1
    preset asan unit_tests -L unit -R "$judgements" || status=1
    preset clang "" -L cli -R 'Matrix.*(SCALAR|AVX2)' || status=1
    return "$status"
}

# script NAME COMMAND...: counts a script as one test.
script() {
    local name=$1 status=0
    shift
    "$@" || status=$?
    count "$name" 1 "$((status != 0))"
    return "$status"
}

# The kernels' tests and the matrix of bytes on arm64, under QEMU. Not run if the mirror has no packages for arm64.
arm64() {
    local status=0 counts
    tests/arm64.sh | tee "$results/arm64.log" || status=$?
    [ "$status" -ne 77 ] || return 0
    counts=$(sed -n 's/^arm64: \([0-9]*\) passed, \([0-9]*\) failed$/\1 \2/p' "$results/arm64.log")
    [ -n "$counts" ] || return 1
    count arm64 "$((${counts% *} + ${counts#* }))" "${counts#* }"
    return "$status"
}

# The tests that start threads, and the tests of commands that process many files at once.
tsan() {
    preset tsan "unit_tests bake-normals" -L unit -R 'Threads|Parallel|Cancel' -E RdoStream || return 1
    TSAN_OPTIONS="suppressions=$PWD/tests/tsan.supp" build/tsan/bake-normals samples/*.png --out-dir "$results/tsan" \
        --threads 4
}

# Builds textures on a Slurm cluster that it starts. Not run if none can be started. There is a second try, because
# Slurm gives up on a node or a job now and then if the machine is slow.
slurm() {
    local status=0
    tests/slurm.sh build/release || status=$?
    [ "$status" -eq 0 ] || [ "$status" -eq 77 ] || { status=0; tests/slurm.sh build/release || status=$?; }
    [ "$status" -ne 77 ] || return 0
    count slurm 1 "$((status != 0))"
    return "$status"
}

# Counts one test for each source; a source with findings counts as a failure.
tidy() {
    local ran failed
    tests/tidy.sh | tee "$results/tidy.log"
    ran=$(sed -n 's/^tidy: \([0-9]*\) sources.*/\1/p' "$results/tidy.log")
    failed=$(sed -n 's/^\([^ :]*\):.*: error: .*/\1/p' "$results/tidy.log" | sort -u | wc -l)
    [ -n "$ran" ] || return 1
    count tidy "$ran" "$failed"
    [ "$failed" -eq 0 ]
}

# Runs one fuzzer from its corpus for FUZZ_SECONDS. A finding is left in build/nightly.
fuzz_one() {
    local name
    name=$(basename "$1" _fuzz)
    mkdir -p "build/fuzz/corpus/$name"
    if "$1" -seed=1 -max_total_time="${FUZZ_SECONDS:-60}" -timeout=20 -rss_limit_mb=4096 -print_final_stats=1 \
        -verbosity=0 -artifact_prefix="$results/$name-" "build/fuzz/corpus/$name" "tests/fuzz/corpus/$name" \
        >"$results/fuzz-$name.log" 2>&1; then
        echo "fuzz $name: $(sed -n 's/^stat::number_of_executed_units: *//p' "$results/fuzz-$name.log") inputs"
    else
        { echo "fuzz $name: FAILED"; tail -n 40 "$results/fuzz-$name.log"; } | tee "$results/fuzz-$name.failed"
    fi
}

# Runs all fuzzers, one on each processor at a time.
fuzz() {
    cmake --preset fuzz >"$results/fuzz.configure.log" && cmake --build --preset fuzz || return 1
    local fuzzer ran=0 failed
    for fuzzer in build/fuzz/*_fuzz; do
        [ -x "$fuzzer" ] || continue
        ran=$((ran + 1))
        while [ "$(jobs -rp | wc -l)" -ge "$(nproc)" ]; do wait -n || true; done
        fuzz_one "$fuzzer" &
    done
    wait
    failed=$(find "$results" -name 'fuzz-*.failed' | wc -l)
    count fuzz "$ran" "$failed"
    script draco tests/fuzz/draco.py "${FUZZ_SECONDS:-60}" && [ "$failed" -eq 0 ]
}

# Makes the Debian packages from the objects of the release, installs them, uses each, and removes them without a trace.
# On your own machine this needs root.
package() {
    local debs packages=(libtex1 libtex-dev libtex-tools libtex-reader-oiio python3-libtex libtex-oiio) status=0
    ctest --preset release --output-junit "$results/package.xml" -R '^consumer[.]packages$' || return 1
    script headers tests/consumer/headers.sh build/release all || status=1
    mapfile -t debs < <(find build/release/consumer-packages -maxdepth 1 -name '*.deb')
    lintian --allow-root --fail-on error,warning "${debs[@]}" || status=1
    system_files >"$results/before.txt"
    as_root apt-get install -q -y --no-install-recommends "${debs[@]/#/./}" >"$results/apt.log" 2>&1 ||
        { cat "$results/apt.log"; return 1; }
    use_packages "$results/used" || status=1
    as_root apt-get purge -q -y "${packages[@]}" >>"$results/apt.log" 2>&1 || { cat "$results/apt.log"; status=1; }
    system_files >"$results/after.txt"
    diff "$results/before.txt" "$results/after.txt" || { echo 'gate: the packages left files'; status=1; }
    count installed-packages 1 "$status"
    return "$status"
}
system_files() { find /etc /opt /srv /usr /var/lib/dpkg/info 2>/dev/null | LC_ALL=C sort; }

# Uses what is in each of the installed packages, in the new folder $1.
use_packages() (
    set -e
    mkdir -p "$1"
    cp samples/bricks.png samples/bake_and_pack.cpp "$1"
    cd "$1"
    unset LD_LIBRARY_PATH PYTHONPATH
    /usr/bin/bake-normals --version
    /usr/bin/bake-normals bricks.png -o bricks.dds --bumpiness 12
    /usr/bin/bake-normals bricks.png -o bricks.tif --bumpiness 12 # through the reader process
    # shellcheck disable=SC2046  # flags are words
    g++ -std=c++20 bake_and_pack.cpp -o program $(pkg-config --cflags --libs libtex)
    ./program bricks.png program.dds
    cmp program.dds bricks.dds
    # As root, so that Python writes what it compiles.
    as_root /usr/bin/python3 -c 'import tex; assert tex.read_texture("bricks.dds").encoding == "dxt5nm"'
    OIIO_LIBRARY_PATH=$(dirname "$(dpkg -L libtex-oiio | grep '/tex[.]imageio[.]so$')")
    export OIIO_LIBRARY_PATH
    oiiotool bricks.tif --attrib tex:mips all -o bricks.ktx2
    iinfo -v bricks.ktx2 | grep -q 'tex:format'
)

# The binary interface of libtex.so beside that of the last tag.
abi() { counted abi tests/abi.sh; }

# What other programs read in files that leave it open, beside what the manual says of them.
readers() { counted readers /usr/bin/python3 tests/readers.py build/release; }

# Other programs with our files: Blender, Godot, engines of the web, Khronos' validator. Each installs what it needs, if
# it can.
engines() {
    local status=0
    script blender tests/blender.sh || status=1
    script blender_bake tests/blender_bake.sh || status=1
    script spheres tests/engines/spheres.sh || status=1
    script engines tests/engines/engines.sh || status=1
    script recipes tests/engines/recipes.sh || status=1
    script three tests/browser/three.sh || status=1
    script models tests/browser/models.sh build/release ../shared/data samples ${MODELS:+"$MODELS"} || status=1
    script ktx tests/ktx.sh || status=1
    return "$status"
}

# counted NAME COMMAND...: counts a script whose last line is "NAME: N passed, M failed[, K skipped]". 77: not run.
counted() {
    local name=$1 status=0 counts
    shift
    "$@" | tee "$results/$name.log" || status=$?
    [ "$status" -ne 77 ] || return 0
    counts=$(sed -n "s/^$name: \([0-9]*\) passed, \([0-9]*\) failed.*/\1 \2/p" "$results/$name.log" | tail -n 1)
    [ -n "$counts" ] || return 1
    count "$name" "$((${counts% *} + ${counts#* }))" "${counts#* }"
    return "$status"
}

# Both README commands on Debian 13, and the first of them on sid.
platforms() { counted platforms tests/platforms.sh trixie sid; }

# The archive for every Linux, on each release of Debian, and the one for arm64, under QEMU.
portable() {
    local status=0
    { samples/packaging/portable.sh --arm64 && counted portable tests/portable.sh --arm64; } || status=1
    [ ! -e "$results/portable.xml" ] || mv "$results/portable.xml" "$results/portable-arm64.xml"
    { samples/packaging/portable.sh && counted portable tests/portable.sh; } || status=1
    return "$status"
}

# The archive for Windows, under Wine.
windows() {
    samples/packaging/windows.sh && counted windows tests/windows.sh
}

# The npm package, in node and in a browser, and the page that runs the commands there.
npm_package() {
    local status=0
    samples/packaging/npm.sh || return 1
    counted npm tests/npm.sh || status=1
    counted npm_browser tests/browser/npm.sh || status=1
    counted web tests/browser/web.sh || status=1
    return "$status"
}

# Everything that a release consists of, made from two clones in folders with names of different lengths: an hour. The
# sums are equal, and the signature holds.
make_release_twice() (
    set -e
    unset CMAKE_CXX_COMPILER_LAUNCHER
    folder=$(mktemp -d)
    trap 'rm -rf "$folder"' EXIT
    version=$(sed -n 's/^project(libtex VERSION \([0-9.]*\) .*/\1/p' CMakeLists.txt)
    minisign -G -W -p "$folder/key.pub" -s "$folder/key" >/dev/null
    for clone in one another/longer; do
        mkdir -p "$folder/$clone"
        git clone -q . "$folder/$clone/libtex"
        MINISIGN_KEY=$folder/key "$folder/$clone/libtex/samples/packaging/release.sh" "$version" "$folder/$clone/made"
    done
    diff "$folder/one/made/SHA256SUMS" "$folder/another/longer/made/SHA256SUMS"
    samples/packaging/verify-release.sh "$folder/one/made" --key "$folder/key.pub" --clone .
)

need_packages "${build_packages[@]}" "${test_packages[@]}" "${gate_packages[@]}" "${nightly_packages[@]}"
if command -v ccache >/dev/null; then export CMAKE_CXX_COMPILER_LAUNCHER=ccache; fi

build_release
step alone compile_alone c++
step extremes script extremes tests/extremes.py build/release 300
step long long
step scalar scalar
step commands commands
step slurm slurm
step arm64 arm64
step tsan tsan
step tidy tidy
step fuzz fuzz
step package package
step abi abi
step readers readers
step engines engines
step platforms platforms
step portable portable
step windows windows
step npm npm_package
step release script release make_release_twice
finish
