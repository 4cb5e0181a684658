#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# portable_ci.sh: the portable archive where it is meant to go: the GitHub action (samples/ci/action.yml) and the
# container (samples/packaging/Containerfile). tests/portable.sh runs both. Needs root and mmdebstrap.
#
#     tests/portable_ci.sh action ARCHIVE       the action's steps that are scripts, as a runner starts them, by a user
#                                               without rights in a root with the essential packages and xz
#     tests/portable_ci.sh container ARCHIVE    buildah makes the image in a root of its own, and runs a command in it
#
# What GitHub would do itself is not run: the upload of SARIF and the kept page.
set -euo pipefail
what=$1
archive=$(realpath "$2")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
mirror=${MIRROR:-http://deb.debian.org/debian}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
fail() { echo "portable_ci.sh: $what: $*" >&2; exit 1; }

# make_root NAME VARIANT PACKAGE,...
make_root() {
    root=$PWD/build/platforms/$1
    if [ ! -e "$root/etc/debian_version" ]; then
        rm -rf "$root" "$root.new"
        mkdir -p build/platforms
        mmdebstrap --quiet --variant="$2" --include="$3" --aptopt='APT::Install-Recommends "false"' bookworm \
            "$root.new" "$mirror" || fail 'no root'
        mv "$root.new" "$root"
    fi
}

# in_root USER SCRIPT: runs a script of bash in the root, where /tmp/given is the folder $scratch/given.
in_root() {
    # shellcheck disable=SC2016  # expanded in the shell that has the mounts
    unshare --mount --pid --fork --kill-child bash -euc '
        mount --bind "$1" "$1"  # buildah wants a root that is a mount
        mount -t proc proc "$1/proc"
        mount --rbind /dev "$1/dev"
        mount -t tmpfs tmpfs "$1/tmp"
        chmod 1777 "$1/tmp"
        mkdir "$1/tmp/given"
        mount --bind "$2" "$1/tmp/given"
        exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp LANG=C chroot --userspec="$3" "$1" \
            bash -euo pipefail -c "$4"
    ' in_root "$root" "$scratch/given" "$1" "$2"
}

# Prints each step of the action that is a script as GitHub starts it: bash -eo pipefail, its inputs in variables, the
# folders of $GITHUB_PATH at the head of PATH.
print_steps() {
    /usr/bin/python3 - samples/ci/action.yml "$@" <<'PY'
import re, shlex, sys, yaml
action = yaml.safe_load(open(sys.argv[1]))
inputs = {name: about.get("default") for name, about in action["inputs"].items()}
inputs.update(one.split("=", 1) for one in sys.argv[2:])
missing = [name for name, value in inputs.items() if value is None]
assert not missing, missing
def filled(text):
    text = re.sub(r"\$\{\{ inputs\.(\w+) \}\}", lambda found: inputs[found[1]], text)
    assert "${{" not in text, text
    return text
steps = action["runs"]["steps"]
assert [step["uses"].split("@")[0] for step in steps if "uses" in step] == [
    "github/codeql-action/upload-sarif", "actions/upload-artifact"]
for step in steps:
    if "run" not in step:
        continue
    assert step["shell"] == "bash"
    variables = ["PATH=$(tr '\\n' : <\"$GITHUB_PATH\")$PATH"]
    variables += [f"{name}={shlex.quote(filled(value))}" for name, value in step.get("env", {}).items()]
    print("env", '"' + variables[0] + '"', *variables[1:], "bash --noprofile --norc -eo pipefail -c",
          shlex.quote(filled(step["run"])))
PY
}

# in_action INPUT=VALUE...: the folder $scratch/given/out has what the steps have left; the status is theirs.
in_action() {
    rm -rf "$scratch/given/out"
    mkdir -m 777 "$scratch/given/out"
    print_steps "$@" >"$scratch/given/steps.sh"
    # shellcheck disable=SC2016
    in_root 4321:4321 'cd /tmp/given; export RUNNER_TEMP=/tmp/given/out GITHUB_PATH=/tmp/given/out/path
        : >"$GITHUB_PATH"; . ./steps.sh'
}

action() {
    local sum sarif=$scratch/given/out/normals.sarif
    make_root runner-bookworm essential xz-utils
    mkdir -p "$scratch/given/art/deep er"
    cp "$archive" "$scratch/given/libtex.tar.xz"
    cp samples/ci/checks.toml "$scratch/given"
    sum=$(sha256sum <"$archive" | cut -d' ' -f1)
    local inputs=(archive=libtex.tar.xz "sha256=$sum" folder=art config=checks.toml)
    build/release/bake-normals samples/bricks.png -o "$scratch/given/art/deep er/a_n.dds"
    in_action "${inputs[@]}" || fail 'right maps fail'
    [ -s "$scratch/given/out/normals.html" ] || fail 'there is no page'
    /usr/bin/python3 -c 'import json, sys
run, = json.load(open(sys.argv[1]))["runs"]
assert run["tool"]["driver"]["name"] == "check-normals" and not run["results"], run["results"]' "$sarif"
    build/release/bake-normals samples/bricks.png -o "$scratch/given/art/deep er/a_n.dds" --y down
    if in_action "${inputs[@]}"; then fail 'a wrong map passes'; fi
    /usr/bin/python3 -c 'import json, sys
run, = json.load(open(sys.argv[1]))["runs"]
assert "N401" in [result["ruleId"] for result in run["results"]], run["results"]
place = run["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"]
assert place.endswith("art/deep%20er/a_n.dds"), place' "$sarif"
    if in_action "${inputs[@]}" sha256=00 2>/dev/null; then fail 'another archive than the one named passes'; fi
    in_action "${inputs[@]}" folder=out || fail 'a folder without maps fails'
}

container() {
    make_root buildah-bookworm apt buildah,ca-certificates
    mkdir -p "$scratch/given/context" "$scratch/given/work"
    cp "$archive" "$scratch/given/context"
    cp samples/packaging/Containerfile "$scratch/given"
    cp samples/bricks.png "$scratch/given/work"
    # shellcheck disable=SC2016
    in_root 0:0 'cd /tmp/given
        export STORAGE_DRIVER=vfs BUILDAH_ISOLATION=chroot
        buildah() { command buildah --root /tmp/store --runroot /tmp/run "$@"; }
        buildah bud -q -f Containerfile -t libtex context
        one=$(buildah from libtex)
        buildah run --volume "$PWD/work:/work" "$one" -- bake-normals bricks.png -o a.tif
        buildah run --volume "$PWD/work:/work" "$one" -- pack-normals a.tif -o a.dds
        du -sm "$(buildah mount "$one")"'
    build/release/bake-normals samples/bricks.png -o "$scratch/a.tif"
    build/release/pack-normals "$scratch/a.tif" -o "$scratch/a.dds"
    cmp "$scratch/a.dds" "$scratch/given/work/a.dds"
}

case $what in
    action | container) "$what" ;;
    *) fail 'no such step' ;;
esac
