// SPDX-License-Identifier: Apache-2.0
// Meshes that tex-mesh-reader reads. Assimp's own program makes them from OBJ.

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cli/meshes.h"
#include "cli/program.h"

namespace tex::cli {
namespace {

class MeshReader : public testing::Test {
protected:
    MeshReader() {
        scratch_.add_sample("waves.png", "waves.png");
        scratch_.write("sheet.obj", kSheetObj);
        EXPECT_EQ(go("bake-normals", {"waves.png", "-o", "n.png", "--bumpiness", "4"}).code, 0);
    }
    Ran go(const std::string& command, std::vector<std::string> arguments) {
        arguments.push_back("--no-sync");
        return run(scratch_, command, arguments);
    }
    Ran convert(const std::string& mesh, const std::string& output) {
        return go("convert-normals", {"n.png", "-o", output, "--mesh", mesh, "--to", "object"});
    }
    // FBX in its form as text: Assimp 5.2 cannot read the binary form that it writes.
    void export_as(const std::string& name) {
        const std::string form = name.ends_with(".fbx") ? " -ffbxa" : "";
        const Ran ran = shell(scratch_, "assimp export sheet.obj " + name + form);
        ASSERT_TRUE(scratch_.has(name)) << ran.out << ran.err;
    }
    Scratch scratch_;
};

TEST_F(MeshReader, ReadsWhatAssimpReads) {
    ASSERT_EQ(convert("sheet.obj", "obj.exr").code, 0);
    for (const char* type : {"fbx", "ply", "dae"}) {
        const std::string mesh = std::string("sheet.") + type;
        export_as(mesh);
        const Ran ran = convert(mesh, std::string(type) + ".exr");
        EXPECT_EQ(ran.code, 0) << ran.err;
        EXPECT_EQ(ran.err, "");
        const Ran same = run(scratch_, "compare-normals", {"obj.exr", std::string(type) + ".exr", "--max", "0.01"});
        EXPECT_EQ(same.code, 0) << type << ": " << same.out;
    }
}

TEST_F(MeshReader, TellsFileTypesByTheirContentIfTheNameDoesNot) {
    export_as("sheet.fbx");
    for (const char* name : {"sheet", "fbx.obj"}) {
        scratch_.write(name, scratch_.read("sheet.fbx"));
        const Ran ran = convert(name, "o.exr");
        EXPECT_EQ(ran.code, 0) << ran.err;
    }
}

TEST_F(MeshReader, RefusesDamagedFilesWithOneSentence) {
    export_as("sheet.fbx");
    export_as("sheet.ply");
    scratch_.write("words.fbx", "These are words.\n");
    scratch_.write("words.txt", "These are words.\n");
    scratch_.write("empty.fbx", "");
    std::vector<std::string> names = {"words.fbx", "words.txt", "empty.fbx", "waves.png"};
    for (const char* whole : {"sheet.fbx", "sheet.ply"}) {
        const std::string bytes = scratch_.read(whole);
        for (const std::size_t part : {1U, 3U, 7U, 15U}) {
            names.push_back(std::to_string(part) + "_" + whole);
            scratch_.write(names.back(), bytes.substr(0, bytes.size() * part / 16));
        }
    }
    for (const std::string& name : names) {
        // Assimp's reader of FBX does not end on some of these.
        const Ran ran =
            go("convert-normals", {"n.png", "-o", "o.exr", "--mesh", name, "--to", "object", "--reader-timeout", "2"});
        EXPECT_EQ(ran.code, 4) << name << ": " << ran.err;
        EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
        EXPECT_TRUE(ran.err.starts_with("convert-normals: error: " + name + ": ")) << ran.err;
        EXPECT_FALSE(scratch_.has("o.exr"));
    }
    EXPECT_NE(convert("words.txt", "o.exr").err.find("is not a mesh that libtex reads"), std::string::npos);
}

}  // namespace
}  // namespace tex::cli
