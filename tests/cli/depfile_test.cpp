// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "cli/program.h"
#include "tasks/depfile.h"

namespace tex::cli {

TEST(Depfile, OneRuleForEachOutput) {
    EXPECT_EQ(*depfile_text({{{"a.dds"}, {"a.png", "config.ocio"}}, {{"b0.png", "b1.png"}, {"b.png"}}}),
              "a.dds: \\\n  a.png \\\n  config.ocio\nb0.png b1.png: \\\n  b.png\n");
}

TEST(Depfile, WhatHasNoNameIsLeftOut) {
    EXPECT_EQ(*depfile_text({{{"a.dds"}, {"-"}}, {{"-"}, {"a.png"}}}), "a.dds:\n");
}

// Once, such names were silently left out, and outputs made from those files were never rebuilt.
TEST(Depfile, NamesThatItCannotHoldAreRefused) {
    const auto text = depfile_text({{{"a.dds"}, {"a.png", "two\nlines.ocio"}}});
    ASSERT_FALSE(text);
    EXPECT_EQ(text.error().file, "two\nlines.ocio");

    const Scratch scratch;
    scratch.add_sample("ramp.png", "two\nlines.png");
    scratch.add_sample("ramp.png", "plain.png");
    const auto before = scratch.list();
    for (const std::string name : {"two\nlines", "plain"}) {
        const std::string output = name == "plain" ? "two\nlines.dds" : "plain.dds";
        const Ran ran = run(scratch, "bake-normals", {name + ".png", "-o", output, "--depfile", "d"});
        EXPECT_EQ(ran.code, 2);
        EXPECT_TRUE(ran.err.starts_with("bake-normals: error: --depfile: two\\x0alines.")) << ran.err;
        EXPECT_EQ(scratch.list(), before);
    }
    EXPECT_EQ(run(scratch, "bake-normals", {"two\nlines.png", "-o", "plain.dds"}).code, 0);
}

// All names that Make would misread, at once. Make must rebuild the output after the input was touched, and otherwise
// leave it alone.
TEST(Depfile, MakeReadsEveryName) {
    for (const std::string name : {"plain", "with blank", "dollar$", "hash#", "colon:", "back\\slash", "back\\ blank",
                                   "per%cent~", "trailing\\", "Gel\xc3\xa4nde", "quote's", "amper&sand"}) {
        const Scratch scratch;
        const std::string input = name + ".png", output = name + ".dds";
        scratch.write(input, "");
        scratch.write("d", *depfile_text({{{output}, {input}}}));
        scratch.write("Makefile", "include d\n%.dds:\n\t@echo built\n.DEFAULT_GOAL :=\n");
        EXPECT_EQ(run(scratch, "/usr/bin/make", {"-s", "-f", "Makefile", output}).out, "built\n") << name;
        scratch.write(output, "");
        EXPECT_EQ(shell(scratch, "touch -d '1 hour ago' *.png").code, 0);
        EXPECT_EQ(run(scratch, "/usr/bin/make", {"-q", "-f", "Makefile", output}).code, 0) << name;
        EXPECT_EQ(shell(scratch, "touch -d '1 hour ago' *.dds; touch *.png").code, 0);
        EXPECT_EQ(run(scratch, "/usr/bin/make", {"-q", "-f", "Makefile", output}).code, 1) << name;
    }
}

TEST(Depfile, NinjaRebuildsOnlyWhatChanged) {
    if (!is_installed("ninja")) GTEST_SKIP() << "no ninja";
    const Scratch scratch;
    scratch.add_sample("ramp.png", "one map.png");
    scratch.add_sample("hemisphere.png", "two.png");
    scratch.write("build.ninja",
                  "rule bake\n  command = bake-normals $in -o $out --depfile $out.d --quiet\n  depfile = $out.d\n"
                  "build one.dds: bake one$ map.png\nbuild two.dds: bake two.png\n");
    EXPECT_EQ(shell(scratch, "ninja").code, 0);
    EXPECT_NE(shell(scratch, "ninja").out.find("no work to do"), std::string::npos);
    const Ran again = shell(scratch, "sleep 0.01; touch two.png; ninja -v");
    EXPECT_NE(again.out.find("two.dds"), std::string::npos);
    EXPECT_EQ(again.out.find("one.dds"), std::string::npos);
}

}  // namespace tex::cli
