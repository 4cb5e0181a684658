#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# portable.sh: tests the archive that samples/packaging/portable.sh has made: what it needs, what is inside, and that it
# works on each release of Debian that the mirror has, in a root with the essential packages and nothing else, for a
# user without rights, from a folder with a space in its name. Its outputs must have the bytes of build/release.
#
#     tests/portable.sh [RELEASE...]    bullseye bookworm trixie forky sid, unless releases are named
#     tests/portable.sh --arm64         the archive for arm64, under QEMU on this system
#
# Needs root, mmdebstrap, and the commands in build/release. The last line is "portable: N passed, M failed". Exits 77
# without an archive, mmdebstrap or root.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

releases=("$@")
tool=
made=build/portable
if [ "${1:-}" = --arm64 ]; then
    releases=()
    tool=aarch64-linux-gnu-
    made=build/portable-arm64
elif [ $# -eq 0 ]; then
    releases=(bullseye bookworm trixie forky sid)
fi
mirror=${MIRROR:-http://deb.debian.org/debian}
archive=$(find "$made" -maxdepth 1 -name 'libtex-*-linux-*.tar.xz' 2>/dev/null | head -n 1)
if [ -z "$archive" ] || [ "$(id -u)" -ne 0 ] || ! command -v mmdebstrap >/dev/null; then
    echo 'portable: not run: needs an archive of samples/packaging/portable.sh, root and mmdebstrap'
    exit 77
fi
name=$(basename "$archive" .tar.xz)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
tar -xf "$archive" -C "$scratch"
tree=$scratch/$name

emulator=()
if [ -n "$tool" ]; then emulator=(qemu-aarch64-static); fi
passed=0
failed=0
# check WHAT COMMAND...: one test.
check() {
    local what=$1
    shift
    if "$@"; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "portable: FAILED: $what"; fi
}

programs() { find "$tree/bin" "$tree/libexec" -type f; }
needs_no_library() {
    local program needed
    while IFS= read -r program; do
        needed=$("${tool}objdump" -p "$program" | grep -E 'NEEDED|INTERP' || true)
        needed+=$("${tool}objdump" -T "$program" 2>/dev/null | grep -E '\*UND\*' || true)
        [ -z "$needed" ] || { echo "$program: $needed"; return 1; }
    done < <(programs)
}
moves_in_memory() { # address space layout randomisation: position-independent
    local program
    while IFS= read -r program; do
        readelf -h "$program" | grep -q 'Type: *DYN' || { echo "$program is not position-independent"; return 1; }
    done < <(programs)
}
# Each command of the installation, each page of the manual, each completion.
has_everything() {
    local command
    for command in tools/*-normals.cpp; do
        command=$(basename "$command" .cpp)
        if [ ! -x "$tree/bin/$command" ] || [ ! -s "$tree/share/man/man1/$command.1.gz" ] ||
            [ ! -s "$tree/share/bash-completion/completions/$command" ]; then
            echo "lacks $command"
            return 1
        fi
    done
}
is_small() { [ "$(stat -c %s "$archive")" -le $((12 << 20)) ]; }
has_licences() {
    /usr/bin/python3 - "$tree/share/doc/libtex" <<'PY'
import json, pathlib, sys
folder = pathlib.Path(sys.argv[1])
document = json.loads((folder / "libtex.spdx.json").read_text())
assert document["spdxVersion"] == "SPDX-2.3" and document["dataLicense"] == "CC0-1.0"
names = [package["name"] for package in document["packages"]]
assert len(names) == len(set(names)) and {"libtex", "glibc", "tiff", "openexr"} <= set(names), names
for package in document["packages"]:
    assert package["versionInfo"] and package["licenseConcluded"] != "NOASSERTION", package
    if package["name"] != "libtex":
        assert (folder / "licences" / (package["name"] + ".txt")).stat().st_size > 200, package["name"]
known = {package["SPDXID"] for package in document["packages"]}
assert all(one["relatedSpdxElement"] in known for one in document["relationships"])
PY
}
refuses_other_names() {
    local status=0
    ln -s build-normals "$tree/bin/unknown-normals"
    "${emulator[@]}" "$tree/bin/unknown-normals" 2>"$scratch/message" || status=$?
    rm "$tree/bin/unknown-normals"
    [ "$status" -eq 2 ] && grep -q 'acts by its name' "$scratch/message"
}

make_root() {
    local root=build/platforms/essential-$1
    if [ ! -e "$root/etc/debian_version" ]; then
        rm -rf "$root" "$root.new"
        mkdir -p build/platforms
        # A mirror that stands still has an index of forky and sid that is past its date. It must be signed.
        mmdebstrap --quiet --variant=essential --aptopt='Acquire::Check-Valid-Until "false"' "$1" "$root.new" \
            "$mirror" && mv "$root.new" "$root"
    fi
}
# The outputs in a root, by a user without rights. Prints what portable_outputs.sh prints.
outputs_in() {
    # shellcheck disable=SC2016  # expanded in the shell that has the mounts
    unshare --mount --pid --fork --kill-child bash -euc '
        root=$1
        mount -t proc proc "$root/proc"
        mount -t tmpfs tmpfs "$root/tmp"
        mkdir -p "$root/tmp/any where"
        cp -r "$2" "$root/tmp/any where/libtex"
        cp "$3" "$root/tmp/outputs.sh"
        mkdir -m 1777 "$root/tmp/out"
        exec env -i PATH=/usr/sbin:/usr/bin:/bin LANG=C chroot --userspec=4321:4321 "$root" sh -euc "
            cd /tmp
            ./any\ where/libtex/libexec/libtex/tex-reader --version >&2
            sh outputs.sh \"/tmp/any where/libtex/bin\" \"/tmp/any where/libtex/share/doc/libtex/samples\" \\
                /tmp/out/made"
    ' outputs "$1" "$tree" "$PWD/tests/portable_outputs.sh"
}
works_in() {
    local root=build/platforms/essential-$1 log=build/platforms/essential-$1.log
    outputs_in "$root" >"$scratch/$1.sums" 2>"$log" || { tail -n 3 "$log"; return 1; }
    grep -q 'files restricted, system calls filtered' "$log" || { cat "$log"; return 1; }
    diff "$scratch/native.sums" "$scratch/$1.sums"
}

# The outputs of the programs for arm64. A script starts each; that of the reader takes its place, because commands look
# for it beside themselves. So this is the last check.
works_under_qemu() {
    local program
    emulate() { printf '#!/bin/sh\nexec qemu-aarch64-static %q "$@"\n' "$1" >"$2" && chmod +x "$2"; }
    mkdir "$scratch/emulated"
    for program in "$tree"/bin/*; do emulate "$program" "$scratch/emulated/${program##*/}"; done
    for program in "$tree"/libexec/libtex/*; do
        mv "$program" "$scratch" && emulate "$scratch/${program##*/}" "$program"
    done
    tests/portable_outputs.sh "$scratch/emulated" "$PWD/samples" "$scratch/arm64" >"$scratch/arm64.sums" &&
        diff "$scratch/native.sums" "$scratch/arm64.sums"
}

# Installs the wheel with pip, where there is Python with numpy and no compiler, and bakes through the reader with it.
wheel_works() {
    local root=build/platforms/python-bookworm wheel=$1
    if [ ! -e "$root/etc/debian_version" ]; then
        rm -rf "$root" "$root.new"
        mmdebstrap --quiet --variant=apt --aptopt='APT::Install-Recommends "false"' \
            --include=python3-numpy,python3-pip bookworm "$root.new" "$mirror" && mv "$root.new" "$root" || return 1
    fi
    printf '%s\n' 'import tex' 'tex.run("bake-normals", ["bricks.png", "-o", "a.tif"], check=True)' \
        'tex.run("pack-normals", ["a.tif", "-o", "a.dds"], check=True)' >"$scratch/use.py"
    # shellcheck disable=SC2016  # expanded in the shell that has the mounts
    unshare --mount --pid --fork --kill-child bash -euc '
        mount -t proc proc "$1/proc"
        mount -t tmpfs tmpfs "$1/tmp"
        cp "$2" "$3" samples/bricks.png "$1/tmp"
        exec env -i PATH=/usr/sbin:/usr/bin:/bin HOME=/tmp LANG=C chroot --userspec=4321:4321 "$1" sh -euc "
            cd /tmp
            ! command -v cc && ! command -v g++
            pip install -q --no-index --break-system-packages --user --no-warn-script-location ./*.whl
            python3 use.py
            sha256sum a.dds"
    ' wheel "$root" "$wheel" "$scratch/use.py" >"$scratch/wheel.sum" || return 1
    build/release/bake-normals samples/bricks.png -o "$scratch/a.tif"
    build/release/pack-normals "$scratch/a.tif" -o "$scratch/a.dds"
    [ "$(cut -d' ' -f1 "$scratch/wheel.sum" | tail -n 1)" = "$(sha256sum <"$scratch/a.dds" | cut -d' ' -f1)" ]
}
# The name of the wheel states the newest version of the C library that its files ask for.
wheel_states_its_floor() {
    local newest
    mkdir "$scratch/unpacked" && /usr/bin/python3 -m zipfile -e "$1" "$scratch/unpacked"
    newest=$(objdump -T "$scratch"/unpacked/tex/_tex*.so | grep -o 'GLIBC_2[.][0-9]*' | sort -uV | tail -n 1)
    echo "portable: the wheel needs $newest"
    [[ $1 == *manylinux_2_${newest#GLIBC_2.}_* ]]
}

check 'no program needs a library' needs_no_library
check 'programs lie at another address in each run' moves_in_memory
check 'all commands, pages and completions' has_everything
check 'at most 12 MB' is_small
check 'SPDX document and licences' has_licences
check 'another name is refused' refuses_other_names
tests/portable_outputs.sh "$PWD/build/release" "$PWD/samples" "$scratch/native" >"$scratch/native.sums"
echo "portable: $(wc -l <"$scratch/native.sums") outputs"
if [ -n "$tool" ]; then
    check 'same bytes on arm64' works_under_qemu
    echo "portable: $passed passed, $failed failed"
    [ "$failed" -eq 0 ]
    exit
fi
for release in "${releases[@]}"; do
    make_root "$release" || { echo "portable: the mirror does not have $release"; continue; }
    check "same bytes and a filtered reader on $release" works_in "$release"
done
check 'the action for GitHub' tests/portable_ci.sh action "$archive"
check 'the container' tests/portable_ci.sh container "$archive"
wheel=$(find "$made" -maxdepth 1 -name 'tex-*.whl' | head -n 1)
if [ -n "$wheel" ]; then
    check 'the wheel states its floor' wheel_states_its_floor "$wheel"
    check 'pip installs the wheel, which works' wheel_works "$wheel"
fi
echo "portable: $passed passed, $failed failed"
[ "$failed" -eq 0 ]
