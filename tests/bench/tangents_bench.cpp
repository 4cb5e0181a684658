// SPDX-License-Identifier: Apache-2.0
// Measures make_tangents() on a wavy sheet with shared vertices: milliseconds, the median of five runs.
//
//     tangents_bench [TRIANGLES]        default 2,000,000

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <tex/mesh.h>

#include "unit/meshes.h"

int main(int argc, char** argv) {
    const double triangles = argc > 1 ? std::atof(argv[1]) : 2e6;
    const tex::MeshPart part = tex::wavy_part(static_cast<int>(std::sqrt(triangles / 2.0)), true);
    std::printf("%zu triangles, %zu vertices\n\n| method | threads | ms |\n|---|---|---|\n", part.triangles(),
                part.positions.size());
    for (const auto& method : tex::kTangentMethodNames) {
        for (const int threads : {1, 2}) {
            std::vector<double> runs;
            for (int k = 0; k < 5; ++k) {
                const auto start = std::chrono::steady_clock::now();
                const auto tangents = tex::make_tangents(part, method.value, 0, {threads, {}});
                if (!tangents) return 1;
                runs.push_back(
                    std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
            }
            std::sort(runs.begin(), runs.end());
            std::printf("| %s | %d | %.0f |\n", method.name.data(), threads, runs[2]);
        }
    }
}
