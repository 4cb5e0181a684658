// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "cli/program.h"
#include "cli/usage_error.h"
#include "options/check_config.h"
#include "options/toml_bounds.h"

namespace tex::cli {
namespace {

std::string repeated(std::string_view text, int count) {
    std::string all;
    for (int k = 0; k < count; ++k) all += text;
    return all;
}

// The error message for a text, or nothing.
std::string refusal(const std::string& text) {
    try {
        check_toml_bounds("f.toml", text);
    } catch (const UsageError& error) {
        return error.what();
    }
    return {};
}

const std::string kTooDeep = "f.toml: line 1: keys and lists nest deeper than 64 levels";

// Each way to nest, with `count` levels.
const std::function<std::string(int count)> kNests[] = {
    [](int count) { return "a" + repeated(".a", count) + " = 1\n"; },
    [](int count) { return "[a" + repeated(" . a", count - 1) + "]\n"; },
    [](int count) { return "[[a" + repeated(".'a.b'", count - 2) + "]]\n"; },
    [](int count) { return "a = " + repeated("[", count) + repeated("]", count); },
    [](int count) { return "a = " + repeated("{a=", count) + "1" + repeated("}", count); },
    [](int count) { return "a = " + repeated("{a.b=", count / 2) + "1" + repeated("}", count / 2); },
    [](int count) { return "a = [{}, \"\"\"x\"\"\"\"\", '''y''''', \"\\\\\", " + repeated("[", count - 1); },
};

}  // namespace

TEST(TomlBounds, EveryWayToNestIsCounted) {
    for (const auto& nest : kNests) {
        EXPECT_EQ(refusal(nest(kMostTomlLevels)), "") << nest(kMostTomlLevels);
        EXPECT_EQ(refusal(nest(kMostTomlLevels + 2)), kTooDeep) << nest(kMostTomlLevels + 2);
    }
    EXPECT_EQ(refusal("\n'''\n\n'''\n\"\"\"\\\n\"\"\"\na" + repeated(".a", 70)).substr(8, 7), "line 7:");
}

TEST(TomlBounds, WhatStandsBesideEachOtherIsNotNested) {
    EXPECT_EQ(refusal(repeated("a.b = [1.5, 2.5, {c.d = 1, e.f = 2}]\n", 1000)), "");
    EXPECT_EQ(refusal("a = [" + repeated("\"a.b.png\",", 1000) + "]"), "");
    EXPECT_EQ(refusal("a = '" + repeated("[.{", 1000) + "'  # " + repeated("[.{", 1000)), "");
    EXPECT_EQ(refusal("a = \"\"\"\n" + repeated("[.{\\\"\"\n", 1000) + "\"\"\"\n"), "");
    EXPECT_EQ(refusal(repeated("[[a.b]]\nc = ']'\n", 1000)), "");
}

TEST(TomlBounds, LongTextsAreRefused) {
    EXPECT_EQ(refusal(std::string(kMostTomlBytes, '\n')), "");
    EXPECT_EQ(refusal(std::string(kMostTomlBytes + 1, '\n')),
              "f.toml: 1048577 bytes; a file of settings has at most 1048576");
}

// Such files once ended check-normals by SIGSEGV.
TEST(TomlBounds, SettingsOfAMillionKeysAreAUsageError) {
    const Scratch scratch;
    scratch.add_sample("waves.png", "a.png");
    for (const std::string& text : {"a" + repeated(".a", 520'000) + "=1", "[a" + repeated(".a", 520'000) + "]"}) {
        scratch.write("f.toml", text);
        const Ran ran = run(scratch, "check-normals", {"a.png", "--config", "f.toml"});
        EXPECT_EQ(ran.code, 2);
        EXPECT_EQ(lines_of(ran.err).at(0), "check-normals: error: " + kTooDeep);
    }
    EXPECT_NO_THROW(static_cast<void>(parse_check_config("f.toml", "[severity]\nnot-unit-length = \"error\"\n")));
}

}  // namespace tex::cli
