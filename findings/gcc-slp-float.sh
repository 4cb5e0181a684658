#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# gcc-slp-float.sh: g++ 12.2.0 of Debian 12 at its usual -O2, on a loop that rounds two sums of doubles to float, as a
# node's matrix does with the position of a vertex, and goes on with them as doubles.
#
# Expected: the values are floats, as the language demands and as -O1, -O3 and clang make them.
# Seen (2026-11-28): no rounding takes place. -O2 joins the two statements to one vector (SLP) and leaves out the
# conversions to float and back; -fno-tree-slp-vectorize brings them
# back. g++ 11 does the same where -ftree-slp-vectorize is given. Two copies of a mesh, of which one is placed by a
# node and one was placed before, thus have other corners, and rays that graze an edge hit one and miss the other.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
dpkg-query -W -f 'g++-12 ${Version}\n' g++-12 || { echo "apt-get install g++-12, of Debian 12"; exit 1; }
cat >sums.cpp <<'CPP'
#include <cstdio>
static double m[4] = {0.1, 0.7, 1.3, 0.3};
__attribute__((noinline)) void run(const double* in, double* out, int n) {
    for (int k = 0; k < n; ++k) {
        const float x = static_cast<float>(m[0] * in[2 * k] + m[1] * in[2 * k + 1]);
        const float y = static_cast<float>(m[2] * in[2 * k] + m[3] * in[2 * k + 1]);
        out[2 * k] = x;
        out[2 * k + 1] = y;
    }
}
int main() {
    static double in[128], out[128];
    for (int k = 0; k < 128; ++k) in[k] = 1.0 / (k + 3);
    for (double& v : m) v *= 1.0 + in[5] / 3.0;
    run(in, out, 64);
    int not_rounded = 0;
    for (double v : out) not_rounded += v != static_cast<double>(static_cast<float>(v)) ? 1 : 0;
    std::printf("%d\n", not_rounded);
}
CPP
seen=
for flags in -O1 -O2 '-O2 -fno-tree-slp-vectorize'; do
    # shellcheck disable=SC2086  # flags are words
    g++-12 $flags sums.cpp -o sums
    count=$(./sums)
    echo "g++-12 $flags: $count of 128 values are not rounded"
    seen+="$count "
done
[ "$seen" = "0 128 0 " ]
