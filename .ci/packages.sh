# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash
# The packages that libtex needs, listed once, with the names of Debian 12 and 13. Sourced by samples/quickstart.sh,
# tests/run.sh, .ci/run and others.

# shellcheck disable=SC2034  # used by the scripts that source this file
build_packages=(
    g++ cmake ninja-build pkg-config
    libpng-dev libopenexr-dev libtiff-dev libjpeg62-turbo-dev libwebp-dev libopenimageio-dev libopencolorio-dev
    libseccomp-dev libdeflate-dev libisal-dev libzstd-dev libtbb-dev libhwy-dev libfmt-dev
    nlohmann-json3-dev libtomlplusplus-dev libassimp-dev libdraco-dev
)
# shellcheck disable=SC2034
test_packages=(
    libgtest-dev libgmock-dev libsquish-dev libosmesa6-dev libgl-dev
    astcenc libastcenc-dev imagemagick openimageio-tools python3-jsonschema python3-yaml libxml2-utils mandoc shellcheck
    dpkg-dev file git strace zsh fish assimp-utils nix-bin ruby
    pybind11-dev python3-dev python3-numpy python3-pil python3-pytest python3-pip
)
# The browser takes 300 MB. Without it and GNU parallel, their tests report that they were skipped.
# shellcheck disable=SC2034
gate_packages=(
    clang-14 clang-format-14 ccache chromium parallel
)
# shellcheck disable=SC2034
nightly_packages=(
    clang-tidy-14 libbenchmark-dev g++-aarch64-linux-gnu qemu-user-static slurmctld slurmd slurm-client munge lintian
    rustc mono-mcs abigail-tools mmdebstrap nasm g++-mingw-w64-x86-64-posix libz-mingw-w64-dev wine64 wine googletest
    minisign gdal-bin python3-gdal
)
# For samples/packaging/npm.sh. It needs node 20, too, which Debian 12 does not have.
# shellcheck disable=SC2034
wasm_packages=(
    clang-19 lld-19 llvm-19 libc++-19-dev-wasm32 libc++abi-19-dev-wasm32 wasi-libc libclang-rt-19-dev-wasm32
)

# Elsewhere names may differ. Known: Ubuntu has another name for libjpeg-turbo.
system=$(if [ -r /etc/os-release ]; then . /etc/os-release; echo "${ID:-} ${VERSION_ID:-}"; fi)
case $system in
    ubuntu*) build_packages=("${build_packages[@]/libjpeg62-turbo-dev/libjpeg-dev}") ;;
esac

# Says so on a system on which these scripts were not tried.
warn_if_untried() {
    case $system in
        'debian 12' | 'debian 13') return ;;
    esac
    echo "$0: note: tried on Debian 12 and 13, not on ${system:-this system}; packages may have other names here" >&2
}

as_root() {
    if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo "$@"; fi
}

# Installs the missing ones of the named packages. Asks for nothing and downloads nothing if none is missing.
need_packages() {
    local missing=() package status
    if ! command -v apt-get >/dev/null; then
        echo "$0: this script installs packages with apt-get, for Debian 12 and 13 and their relatives. Elsewhere," \
             "install what these Debian packages hold, then: cmake --preset release &&" \
             "cmake --build --preset release" >&2
        echo "    $*" >&2
        return 1
    fi
    for package in "$@"; do
        status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
        [ "$status" = installed ] || missing+=("$package")
    done
    [ "${#missing[@]}" -gt 0 ] || return 0
    if [ "$(id -u)" -ne 0 ] && ! command -v sudo >/dev/null; then
        echo "$0: not root and no sudo here. As root, run: apt-get install ${missing[*]}" >&2
        return 1
    fi
    echo "installing packages: ${missing[*]}"
    # A mirror may fail for a moment, so try again once.
    install_packages "${missing[@]}" || { sleep 10 && install_packages "${missing[@]}"; }
}

install_packages() {
    as_root apt-get update -q </dev/null &&
        as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "$@" </dev/null
}
