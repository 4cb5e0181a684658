#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# run.sh: installs the packages that the tests need (Debian 12 or 13), builds a release and runs all of its tests.
# Arguments go to ctest: `tests/run.sh -L unit -R Dds` runs the unit tests whose names contain "Dds".
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=.ci/packages.sh
. .ci/packages.sh

warn_if_untried
need_packages "${build_packages[@]}" "${test_packages[@]}"
cmake --preset release -DBUILD_TESTING=ON -DTEX_PYTHON=ON -DTEX_OIIO=ON
cmake --build --preset release
ctest --preset release -j "$(nproc)" "$@"
