// SPDX-License-Identifier: Apache-2.0
// lod_bench: how far LODs are from their original to the eye.
//
//     lod_bench ORIGINAL LOD...        glTF models
//
// Each model is drawn by preview(), with its own normal maps and tangents and without its colours, from 26 directions,
// as tools/reports/lod_difference.h says. For each LOD, the mean difference of the codes from those of the original is
// printed, and the mean angle in degrees between both normals. tests/bench/lods.sh makes the models.

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "reports/lod_difference.h"

namespace {

[[noreturn]] void fail(const std::string& why) {
    std::fprintf(stderr, "lod_bench: %s\n", why.c_str());
    std::exit(1);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc == 1) {  // ninja bench
        std::puts("usage: lod_bench ORIGINAL LOD...; skipped: it needs models, which tests/bench/lods.sh makes");
        return 0;
    }
    if (argc < 3) fail("ORIGINAL LOD...");
    std::vector<std::vector<tex::cli::LodMaterial>> models;
    for (int k = 1; k < argc; ++k) {
        auto read = tex::cli::lod_materials(argv[k], {}, {});
        if (!read) fail(read.error().message());
        models.push_back(std::move(*read));
    }
    std::vector<std::vector<tex::cli::LodMaterial>*> all;
    std::vector<const std::vector<tex::cli::LodMaterial>*> lods;
    for (auto& model : models) all.push_back(&model);
    for (std::size_t k = 1; k < models.size(); ++k) lods.push_back(&models[k]);
    tex::cli::frame_together(all);
    const auto differences = tex::cli::lod_differences(models.front(), lods, tex::cli::kLodSide, {});
    if (!differences) fail(differences.error().message());
    if (differences->empty()) fail("no pixel is lit in all of them");
    for (std::size_t k = 0; k < lods.size(); ++k)
        std::printf("%s\t%.2f\t%.2f\n", argv[k + 2], (*differences)[k].codes, (*differences)[k].degrees);
    return 0;
}
