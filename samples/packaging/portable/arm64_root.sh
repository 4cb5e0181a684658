# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash
# Packages of Debian for arm64, to cross-build with. Sourced by portable.sh and tests/arm64.sh.

# arm64_root FOLDER PACKAGE...: unpacks the packages and what they depend on into a new FOLDER, once. Nothing is
# installed on this system.
arm64_root() {
    local root=$1 state=$1.apt file link
    shift
    [ ! -e "$root/complete" ] || return 0
    rm -rf "$root" "$state"
    mkdir -p "$root" "$state/lists/partial" "$state/cache/archives/partial"
    touch "$state/status"
    local options=(
        -q -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o APT::Sandbox::User=root
        -o "Dir::State::Lists=$state/lists" -o "Dir::State::status=$state/status" -o "Dir::Cache=$state/cache"
    )
    apt-get "${options[@]}" update || return 1
    apt-get "${options[@]}" -y --no-install-recommends --download-only install "$@" || return 1
    for file in "$state"/cache/archives/*.deb; do dpkg -x "$file" "$root" || return 1; done
    # Absolute links would lead out of the root.
    find "$root" -type l -lname '/*' | while IFS= read -r link; do
        ln -sfn "$root$(readlink "$link")" "$link"
    done
    rm -rf "$state"
    touch "$root/complete"
}
