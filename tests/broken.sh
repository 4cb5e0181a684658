#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# broken.sh MAKE_BROKEN: the program reproduces the committed files of samples/broken byte for byte.
set -euo pipefail
samples=$(cd "$(dirname "${BASH_SOURCE[0]}")/../samples" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

mkdir "$scratch/meshes"
"$1" "$samples/waves.png" "$scratch"
diff -r -x options.txt "$scratch" "$samples/broken"
