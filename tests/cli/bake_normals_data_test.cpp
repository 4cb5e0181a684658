// SPDX-License-Identifier: Apache-2.0
// Height maps by other authors.

#include <algorithm>

#include <gtest/gtest.h>

#include "cli/program.h"

namespace tex::cli {
namespace {

const std::filesystem::path kHeights = TEX_SOURCE_DIR "/../shared/data/height";

// Sanitizers make a program ten times slower. The errors that they find do not depend on the output format.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
const std::vector<std::string> kOutputs = {"x.dds"};
#else
const std::vector<std::string> kOutputs = {"x.dds", "x.ktx2", "x.png", "x.exr", "x.tif"};
#endif

std::vector<std::string> height_maps() {
    std::vector<std::string> names;
    if (std::filesystem::exists(kHeights)) {
        for (const auto& entry : std::filesystem::directory_iterator(kHeights))
            names.push_back(entry.path().filename());
    }
    std::sort(names.begin(), names.end());
    if (names.empty()) names.emplace_back("none");
    return names;
}

}  // namespace

class RealHeights : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Cli, RealHeights, testing::ValuesIn(height_maps()), [](const auto& instance) {
    std::string name = instance.param;
    for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
    return name;
});

TEST_P(RealHeights, AreBakedOrRefusedWithASentence) {
    if (GetParam() == "none") GTEST_SKIP() << "no ../shared/data";
    const Scratch scratch;
    const std::string input = (kHeights / GetParam()).string();
    for (const std::string& output : kOutputs) {
        const Ran ran = run(scratch, "bake-normals", {input, "-o", output, "--effort", "fast", "--no-sync", "--quiet"});
        const bool holds_nan =
            GetParam().find("nan_inf") != std::string::npos || GetParam().find("nodata") != std::string::npos;
        EXPECT_EQ(ran.code, holds_nan ? 4 : 0) << output << ": " << ran.err;
        EXPECT_EQ(lines_of(ran.err).size(), holds_nan ? 1u : 0u) << ran.err;
        EXPECT_EQ(scratch.has(output), !holds_nan);
        if (!holds_nan) continue;
        EXPECT_EQ(run(scratch, "bake-normals", {input, "-o", output, "--fill-invalid", "--effort", "fast"}).code, 0)
            << output;
    }
}

// GDAL's tag names -9999. The texels are at the border, where they would be cliffs of 5000 m.
TEST(HeightsWithoutData, AreNoCliffs) {
    const std::string input = (kHeights / "dtm_283x259_f32_nodata-9999.tif").string();
    if (!std::filesystem::exists(input)) GTEST_SKIP() << "no ../shared/data";
    const Scratch scratch;
    const Ran refused = run(scratch, "bake-normals", {input, "-o", "x.dds"});
    EXPECT_EQ(refused.code, 4);
    EXPECT_NE(refused.err.find("276 heights are NaN, infinite or no-data"), std::string::npos) << refused.err;
    EXPECT_FALSE(scratch.has("x.dds"));
    const Ran filled = run(scratch, "bake-normals", {input, "-o", "x.dds", "--fill-invalid"});
    EXPECT_EQ(filled.code, 0) << filled.err;
    EXPECT_EQ(without_notes(filled.err), "");
    const Ran cliffs = run(scratch, "bake-normals", {input, "-o", "x.dds", "--no-data", "none"});
    EXPECT_EQ(cliffs.code, 0) << cliffs.err;
    EXPECT_NE(cliffs.err.find("are steeper than dxt5nm"), std::string::npos) << cliffs.err;
}

}  // namespace tex::cli
