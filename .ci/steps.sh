# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash
# What .ci/run and tests/nightly.sh share: steps that run one after the other, each even if an earlier one has failed,
# and a last line that counts all tests. Sourced in the root of the project.

export DEBIAN_FRONTEND=noninteractive CTEST_PARALLEL_LEVEL CMAKE_BUILD_PARALLEL_LEVEL
CTEST_PARALLEL_LEVEL=$(nproc)
CMAKE_BUILD_PARALLEL_LEVEL=$(nproc)
exec </dev/null

broken=()

# begin FOLDER [STEP...]: results go to a new FOLDER; only the named steps run, or all.
begin() {
    results=$1
    wanted=("${@:2}")
    rm -rf "$results"
    mkdir -p "$results"
}

# For each step, ctest writes its counts to a file; the files are added up at the end. count NAME TESTS FAILURES writes
# such a file for a step without ctest.
count() {
    echo "<testsuite name=\"$1\" tests=\"$2\" failures=\"$3\" disabled=\"0\" skipped=\"0\" >" >"$results/$1.xml"
}
attribute() { sed -n "/<testsuite /,/>/s/.*[[:space:]]$1=\"\([0-9]*\)\".*/\1/p" "$2" | head -n 1; }

# Prints each failed test of a file of results, with the end of what it wrote: a server may keep only the end of a log.
failures_of() {
    awk -v step="$(basename "$1" .xml)" '
        /<testcase .*status="fail"/ { failed = 1; lines = 0; name = $0; gsub(/.*<testcase name="|" .*/, "", name) }
        failed { text[lines++] = $0 }
        /<\/testcase>/ && failed {
            print "gate: failed in " step ": " name
            for (i = lines > 40 ? lines - 40 : 1; i < lines; i++) print "    " text[i]
            failed = 0
        }' "$1"
}

finish() {
    local ran=0 failed=0 skipped=0 file
    for file in "$results"/*.xml; do
        [ -e "$file" ] || continue
        ran=$((ran + $(attribute tests "$file")))
        failed=$((failed + $(attribute failures "$file")))
        skipped=$((skipped + $(attribute skipped "$file") + $(attribute disabled "$file")))
        failures_of "$file"
    done
    echo
    if [ "$skipped" -gt 0 ] && [ -d ../shared/data ]; then
        echo "gate: $skipped tests skipped although ../shared/data is here:"
        grep -h 'status="notrun"\|status="disabled"' "$results"/*.xml |
            sed 's/.*<testcase name="\([^"]*\)".*/    \1/' | sort -u
        broken+=("skipped tests")
    fi
    # A step that failed without a failed test (for example, in its build) counts as one.
    if [ "${#broken[@]}" -gt 0 ]; then
        echo "gate: FAILED: ${broken[*]}"
        [ "$failed" -gt 0 ] || failed=${#broken[@]}
    fi
    echo "gate: ${SECONDS} s"
    echo "$((ran - failed - skipped > 0 ? ran - failed - skipped : 0)) passed, $failed failed, $skipped skipped"
    [ "$failed" -eq 0 ] && [ "${#broken[@]}" -eq 0 ]
}

# step NAME COMMAND...: runs the command, prints how long it took, and records whether it failed.
step() {
    local name=$1 start=$SECONDS
    shift
    if [ "${#wanted[@]}" -gt 0 ] && [[ " ${wanted[*]} " != *" $name "* ]]; then return; fi
    echo
    echo "=== $name"
    if "$@"; then echo "=== $name: done in $((SECONDS - start)) s"; else
        echo "=== $name: FAILED after $((SECONDS - start)) s"
        broken+=("$name")
    fi
}

# compile_alone COMPILER [UNITY_BUILD]: each source and each private header by itself, but for the sources that
# UNITY_BUILD has compiled so. The other builds compile folders as one source, which hides a missing include.
compile_alone() {
    local log=$results/alone.configure.log
    cmake --preset dev -B build/alone -DBUILD_TESTING=OFF -DTEX_PYTHON=ON -DTEX_OIIO=ON >"$log" ||
        { cat "$log"; return 1; }
    if tests/alone.py build/alone "$@"; then count alone 1 0; else count alone 1 1; return 1; fi
}

# preset NAME "TARGET..." CTEST_OPTION...: builds the targets of a preset, or the whole preset, and runs tests.
preset() {
    local name=$1 targets=() counts
    counts=$(mktemp -u "$results/$1.XXXX.xml")
    read -ra targets <<<"$2"
    shift 2
    [ "${#targets[@]}" -eq 0 ] || targets=(--target "${targets[@]}")
    cmake --preset "$name" >"$results/$name.configure.log" || { cat "$results/$name.configure.log"; return 1; }
    cmake --build --preset "$name" "${targets[@]}" && ctest --preset "$name" --output-junit "$counts" "$@"
}

# The longest tests of the release, which the nightly run has: all instruction sets but one, pages with real models in a
# browser, statistics that set thresholds, searches of everything, packages, releases, and whole builds by consumers.
# shellcheck disable=SC2034  # used by the scripts that source this file
longest='Matrix[.].*"(SCALAR|EMU128|SSSE3|SSE4|AVX3|AVX3_DL)"|CheckThresholds|CheckData.FindsPlantedDamage'
longest+='|ReportPage.LinksReachFilesAnywhereOnALongPage|ReportMesh.DrawsModelsOfOthers'
longest+='|ReportMesh.LightsAMirroredMeshAsPreviewNormalsDoes|EacSearch.FindsTheOptimumOfEveryBlock'
longest+='|MeshFit.FindsWrongSpacesOnRealModels|GltfTools.OutputsAreReadAsTheModel/(Helmet|NormalTangent)'
longest+='|^consumer.(packages|headers|subdirectory)$|^samples.(release|build_drills)$'

# Tests that judge real maps, exhaustive searches, and the longest comparisons of whole runs: their results are the same
# in every build, because the bytes are. And tests that make the system fail: their results do not depend on the
# compiler.
# shellcheck disable=SC2034  # used by the scripts that source this file
judgements='CheckData.(FindsPlantedDamage|FindsNoDamage|TellsEveryKnownDirection|CompressionOf|IntactMaps)'
judgements+='|CheckThresholds|BakeData|IntegrateData|TransferData|DebandData|Guesses|FalseAlarms|ExtrasMatrix|MeshFit'
judgements+='|Efforts.NoneIsWorseThanACheaperOneOnRealMaps|EacSearch.FindsTheOptimum|PlainFit.(IsNever|Best)'
judgements+='|AstcEncode.(IsCloser|MoreEffort)|RoundTrip.RepacksEveryRealTexture|StorageAngle|PngWrite.TakesNoMoreBytes'
judgements+='|PngFilter.Paeth|Nearest.FillsFromTheNearestTexel|RdoStream|RdoOption.FilesAreSmaller'
judgements+='|BakeNormals.HoldingAllRows|Steps.Joined|AtomicFile.(AKilledWriter|ManyWriters)|Bc4Search.FindsTheOptimum'
judgements+='|Convert.(MakesUnit|ShowsFlat)|GpuDecode|Mip.(EveryTexel|ALargeMap)|SecondRays.BelowASphere'
# shellcheck disable=SC2034
failures='Faults|HostileFiles'
