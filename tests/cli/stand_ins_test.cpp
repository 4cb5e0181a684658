// SPDX-License-Identifier: Apache-2.0
// The libraries that tex-reader does not load (tools/reader/main.cpp).

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "cli/program.h"

namespace tex::cli {
namespace {

// A copy of the reader, alone in a folder.
class StandIns : public testing::Test {
protected:
    StandIns() {
        for (const std::string name : {"tex-reader", "tex-pictures.so"})
            std::filesystem::copy_file(TEX_BINARY_DIR "/" + name, scratch_.path(name));
    }
    void copy_stand_ins() const { std::filesystem::copy(TEX_BINARY_DIR "/stand-ins", scratch_.path("stand-ins")); }
    // The names of the libraries that it loads.
    [[nodiscard]] std::string loaded() const {
        const Ran ran = shell(scratch_, "LD_DEBUG=files ./tex-reader --version 2>&1");
        EXPECT_EQ(ran.code, 0) << ran.out;
        EXPECT_NE(ran.out.find("OpenImageIO 2"), std::string::npos) << ran.out;
        return ran.out;
    }
    [[nodiscard]] static bool has_movies(const std::string& libraries) {
        return libraries.find("/libavcodec.so") != std::string::npos;
    }
    Scratch scratch_;
};

TEST_F(StandIns, KeepLibrariesOfMoviesOut) {
    if (!std::filesystem::exists(TEX_BINARY_DIR "/stand-ins/avcodec.so")) GTEST_SKIP() << "OpenImageIO has no movies";
    copy_stand_ins();
    const std::string libraries = loaded();
    EXPECT_FALSE(has_movies(libraries)) << libraries;
    EXPECT_EQ(libraries.find("/liblog4cplus"), std::string::npos) << libraries;
    EXPECT_NE(libraries.find("/libtiff.so"), std::string::npos) << libraries;
}

TEST_F(StandIns, AreNotNeeded) { EXPECT_TRUE(has_movies(loaded())); }

// As after an update of OpenImageIO that imports another function.
TEST_F(StandIns, GiveWayIfOneLacksAFunction) {
    copy_stand_ins();
    scratch_.write("empty.cpp", "");
    const Ran made = shell(scratch_, "c++ -shared -o stand-ins/avcodec.so -Wl,-soname,libavcodec.so.59 empty.cpp");
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_TRUE(has_movies(loaded()));
}

TEST_F(StandIns, MayBeDamaged) {
    copy_stand_ins();
    scratch_.write("stand-ins/avcodec.so", "not a library");
    EXPECT_TRUE(has_movies(loaded()));
}

TEST_F(StandIns, AreNotAllOfTheReader) {
    std::filesystem::remove(scratch_.path("tex-pictures.so"));
    EXPECT_EQ(run(scratch_, scratch_.path("tex-reader"), {"--version"}).code, 127);
}

}  // namespace
}  // namespace tex::cli
