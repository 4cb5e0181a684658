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
        const bool holds_nan = GetParam().find("nan_inf") != std::string::npos;
        EXPECT_EQ(ran.code, holds_nan ? 4 : 0) << output << ": " << ran.err;
        EXPECT_EQ(lines_of(ran.err).size(), holds_nan ? 1u : 0u) << ran.err;
        EXPECT_EQ(scratch.has(output), !holds_nan);
        if (!holds_nan) continue;
        EXPECT_EQ(run(scratch, "bake-normals", {input, "-o", output, "--fill-invalid", "--effort", "fast"}).code, 0)
            << output;
    }
}

}  // namespace tex::cli
