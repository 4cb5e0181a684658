#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# quickstart.sh: takes you from a fresh clone on Debian 12 or 13 to a baked normal map. Installs the packages that the
# build needs (with sudo if you are not root), builds a release and bakes samples/bricks.png. A second run repeats only
# the steps whose input has changed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=.ci/packages.sh
. .ci/packages.sh

warn_if_untried
need_packages "${build_packages[@]}"

# An existing build folder keeps its setting for tests. A new one is made without tests, which is faster.
tests=OFF
if grep -qs '^BUILD_TESTING:BOOL=ON' build/release/CMakeCache.txt; then tests=ON; fi
cmake --preset release -DBUILD_TESTING="$tests"
cmake --build --preset release

out=build/quickstart
mkdir -p "$out"
bake=build/release/bake-normals
preview=build/release/preview-normals
"$bake" samples/bricks.png -o "$out/bricks.dds" --bumpiness 12
"$bake" samples/bricks.png -o "$out/bricks_normals.png" --bumpiness 12
"$bake" samples/waves.png -o "$out/waves_normals.png" --bumpiness 6
"$preview" "$out/bricks_normals.png" -o "$out/strip.png" --height samples/bricks.png \
    --detail "$out/waves_normals.png" --detail-tiling 6 \
    --show height,normals,plain,lit --size 220 --light -1,1,0.9 --tint 0.6,0.28,0.18 --specular 0.12 --no-legend

cat <<END

Made from samples/bricks.png:
  $out/bricks.dds          DXT5nm (BC3) with all mip levels, for engines
  $out/strip.png           the README's picture: heights, normals, the normals lit, and samples/waves.png as detail

Next:
  $bake --help
  $bake your_height_map.png -o your_normals.dds --bumpiness 8
  $preview your_normals.dds -o look.png --shape sphere
  man ./build/release/man/bake-normals.1
  tests/run.sh                           builds and runs the tests
  cmake --install build/release          installs commands, library and manual in /usr/local
END
