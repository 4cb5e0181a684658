// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <filesystem>

#include "cli/glob.h"
#include "cli/program.h"
#include "cli/usage_error.h"
#include "tasks/find_files.h"

namespace tex::cli {

struct GlobCase {
    const char* pattern;
    std::vector<const char*> matches;
    std::vector<const char*> others;
};

// Patterns come from files that anybody may have written.
TEST(Glob, ManyBracesAreRefusedAtOnce) {
    const auto refusal = [](const std::string& pattern) {
        try {
            const Glob glob(pattern);
        } catch (const UsageError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    std::string nested(15, '{');
    nested += "a,b" + std::string(15, '}');
    EXPECT_EQ(refusal(nested), "");
    EXPECT_EQ(refusal("{{" + nested + "}}"), "'{{" + nested + "}}' nests braces in more than 16 levels");
    EXPECT_EQ(refusal("{a,b}{a,b}{a,b}{a,b}{a,b}{a,b}{a,b}{a,b}{a,b}{a,b}"), "");
    EXPECT_EQ(refusal("{a,b,c}{a,b}{a,b}{a,b}{a,b}{a,b}{a,b}{a,b}{a,b}{a,b}"),
              "'{a,b,c}{a,b}{a,b}{a,b}{a,b}{a,b}{a,b}{a,b}{a,b}{a,b}' stands for more than 1024 patterns");
    EXPECT_EQ(refusal("{{a,b},{c,d}}{{a,b},{c,d}}{{a,b},{c,d}}{{a,b},{c,d}}{{a,b},{c,d}}"), "");
    const std::string wide = refusal(std::string(100000, '{'));
    EXPECT_EQ(wide, "'" + std::string(200, '{') + "...' has more than 4096 bytes");
}

TEST(Glob, MatchesAsAShellDoes) {
    const GlobCase cases[] = {
        {"*.png", {"a.png", "a.b.png"}, {"a/b.png", "a.pngx", ".a.png"}},
        {"a?.png", {"ab.png"}, {"a.png", "abc.png"}},
        {"[a-c]*.png", {"b.png", "call.png"}, {"d.png", "B.png"}},
        {"[!a]x", {"bx"}, {"ax", "x"}},
        {"[]]x", {"]x"}, {"[x"}},
        {"art/**/*_h.png", {"art/a_h.png", "art/b/c/a_h.png"}, {"a_h.png", "art/a.png", "art/.git/a_h.png"}},
        {"**/x", {"x", "a/x", "a/b/x"}, {"ax", "x/a"}},
        {"a/**", {"a/x", "a/b/x"}, {"a", "b/x"}},
        {"a/{b,c/d}/x.{png,tif}", {"a/b/x.png", "a/c/d/x.tif"}, {"a/c/x.png", "a/b/x.exr"}},
        {"{a,b{c,d}}.x", {"a.x", "bc.x", "bd.x"}, {"b.x", "c.x"}},
        {"\\*\\{a\\}.x", {"*{a}.x"}, {"b{a}.x"}},
        {".hidden/*", {".hidden/a"}, {".hidden/.a"}},
        {"a//./b", {"a/b"}, {"a"}},
        {"*\xff*.png", {"a\xff.png", "\xff\n.png"}, {"a.png"}},
        {"*.png", {"a\nb.png", "quo'te \".png"}, {}},
    };
    for (const GlobCase& one : cases) {
        const Glob glob(one.pattern);
        for (const char* path : one.matches) EXPECT_TRUE(glob.matches(path)) << one.pattern << " " << path;
        for (const char* path : one.others) EXPECT_FALSE(glob.matches(path)) << one.pattern << " " << path;
    }
}

TEST(Glob, CaseCountsExceptInTheExtension) {
    const Glob glob("Art/*_h.{png,tif}");
    EXPECT_TRUE(glob.matches("Art/a_h.PNG"));
    EXPECT_TRUE(glob.matches("Art/a_h.Tif"));
    EXPECT_FALSE(glob.matches("art/a_h.png"));
    EXPECT_FALSE(glob.matches("Art/a_H.png"));
}

TEST(Glob, KnowsWhichFoldersItReaches) {
    const Glob glob("art/{a,b}/**/x/*.png");
    for (const char* folder : {"", "art/", "art/a/", "art/b/c/d/", "art/a/x/"}) EXPECT_TRUE(glob.reaches(folder));
    for (const char* folder : {"other/", "art/c/", "art/a/.git/"}) EXPECT_FALSE(glob.reaches(folder)) << folder;
    EXPECT_FALSE(Glob("*.png").reaches("a/"));
}

TEST(Glob, MistakesAreUsageErrors) {
    std::string many;
    for (int k = 0; k < 11; ++k) many += "{a,b}";
    for (const std::string& text :
         {std::string(), std::string("/"), std::string("/a"), std::string("../a"), std::string("a/../b"),
          std::string("{a,b"), std::string("[a"), std::string("."), many, std::string("**/a/**/a/**/a/**/a/**/a")})
        EXPECT_THROW(Glob{text}, UsageError) << text;
}

// Without care, such a pattern takes exponential time.
TEST(Glob, HostilePatternsEndSoon) {
    std::string pattern, name;
    for (int k = 0; k < 40; ++k) pattern += "*a";
    name.assign(4000, 'a');
    EXPECT_FALSE(Glob(pattern + "b").matches(name));
}

class FindFiles : public testing::Test {
protected:
    [[nodiscard]] std::vector<std::string> find(const std::string& pattern, const std::string& skipped = {}) {
        const Glob glob(pattern);
        FileSearch search;
        search.globs = {&glob};
        search.skip = [&](const std::string& folder) { return folder == skipped; };
        search.unreadable = [&](const std::string& folder, const std::string&) { unreadable_.push_back(folder); };
        std::vector<std::string> paths;
        for (const FoundFile& file : find_files(scratch_.path(), search)) paths.push_back(file.path);
        return paths;
    }
    void add(const std::string& name) {
        std::filesystem::create_directories(std::filesystem::path(scratch_.path(name)).parent_path());
        scratch_.write(name, "x");
    }
    Scratch scratch_;
    std::vector<std::string> unreadable_;
};

TEST_F(FindFiles, AreSortedAndLinksAreFollowedWithoutLoops) {
    for (const char* name : {"b/2.png", "b/1.png", "a.png", "c/d/3.PNG", ".git/4.png", "out/5.png"}) add(name);
    std::filesystem::create_directory_symlink("..", scratch_.path("b/loop"));
    std::filesystem::create_directory_symlink("c", scratch_.path("linked"));
    std::filesystem::create_symlink("nowhere", scratch_.path("dangling.png"));
    const std::vector<std::string> expected = {"a.png",     "b/1.png",      "b/2.png",
                                               "c/d/3.PNG", "dangling.png", "linked/d/3.PNG"};
    EXPECT_EQ(find("**/*.png", "out/"), expected);
    EXPECT_TRUE(unreadable_.empty());
}

TEST_F(FindFiles, ReportsFoldersThatCannotBeRead) {
    const Glob glob("*");
    FileSearch search;
    search.globs = {&glob};
    search.unreadable = [&](const std::string& folder, const std::string&) { unreadable_.push_back(folder); };
    EXPECT_TRUE(find_files(scratch_.path("missing"), search).empty());
    EXPECT_EQ(unreadable_.size(), 1u);
}

}  // namespace tex::cli
