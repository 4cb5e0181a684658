// SPDX-License-Identifier: Apache-2.0
// The options of maps that belong to a mesh.

#include "options/tangent_space.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "cli/host.h"
#include "cli/meshes.h"
#include "cli/program.h"

namespace tex::cli {
namespace {

TEST(TangentSpaceOptions, AMeshIsReadOnceUntilItChanges) {
    const Scratch scratch;
    scratch.write("sheet.obj", kSheetObj);
    const std::string path = scratch.path("sheet.obj");
    MemoryHost host;
    Console console("test", host);
    Command command("test", "Tests.");
    TangentSpaceOptions options;
    options.add_input(command);
    const char* const arguments[] = {"--mesh", path.c_str()};
    ASSERT_FALSE(command.parse(arguments, console));
    const auto first = options.input(0, {}, {1, {}}), again = options.input(0, {}, {1, {}});
    ASSERT_TRUE(first && again);
    EXPECT_EQ(&first->selected(), &again->selected()) << "jobs share a mesh";
    std::string longer = kSheetObj;
    longer.replace(longer.find("v 1 1 0.4"), 9, "v 1 1 0.75");
    scratch.write("sheet.obj", longer);
    const auto changed = options.input(0, {}, {1, {}});
    ASSERT_TRUE(changed);
    const auto height = [](const MeshSpace& space) {
        float highest = 0.0f;
        for (const Float3& p : space.selected().part.positions) highest = std::max(highest, p.z);
        return highest;
    };
    EXPECT_EQ(height(*first), 0.4f);
    EXPECT_EQ(height(*changed), 0.75f);
}

}  // namespace
}  // namespace tex::cli
