// SPDX-License-Identifier: Apache-2.0
// What build-normals remembers, and the order in which it works.

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "cli/host.h"
#include "cli/program.h"
#include "tree/cache.h"
#include "tree/queue.h"
#include "tree/state.h"

namespace tex::cli {
namespace {

OutputFiles one_file(const std::string& path) { return {{}, {path}}; }

BuildState some_state() {
    BuildState state;
    Memo memo{{1, 2, 3, 4, -5}, digest_of("a"), true};
    state.memos["a\tb\n%.png"] = memo;
    state.memos["\xff'.png"] = memo;
    state.outputs["out/a.dds"] = {"a\nb.png", digest_of("s"), digest_of("i"), {{"out/a\t.dds", digest_of("o")}}};
    state.outputs["out/b.dds"] = {"b", digest_of("s"), digest_of("i"), {}, {{"b\n", digest_of("b")}}};
    state.outputs["out/b.dds"].warnings = {{"b", "a\tb\n%"}, {"b", "", true}};
    state.settings[digest_of("s")] = {{"blend tiling", "8\t%"}, {"bake no-data", ""}};
    state.outputs["none"] = {"x", {}, {}, {}};
    return state;
}

}  // namespace

TEST(BuildState, SurvivesTheFile) {
    const BuildState state = some_state();
    const BuildState read = BuildState::parse(state.text());
    EXPECT_EQ(read.outputs, state.outputs);
    EXPECT_EQ(read.settings, state.settings);
    ASSERT_EQ(read.memos.size(), 2u);
    EXPECT_EQ(read.memos.at("a\tb\n%.png").stamp, state.memos.at("a\tb\n%.png").stamp);
    EXPECT_EQ(read.memos.at("\xff'.png").digest, digest_of("a"));
}

TEST(BuildState, ForgetsWhatWasNotUsed) {
    EXPECT_TRUE(BuildState::parse(BuildState::parse(some_state().text()).text()).memos.empty());
}

TEST(BuildState, DamagedFilesAreEmptyStates) {
    const std::string text = some_state().text();
    for (std::size_t k = 0; k < text.size(); ++k) {
        std::string damaged = text;
        damaged[k] = static_cast<char>(damaged[k] ^ 1);
        ASSERT_TRUE(BuildState::parse(damaged).outputs.empty()) << k;
        ASSERT_TRUE(BuildState::parse(text.substr(0, k)).outputs.empty()) << k;
    }
    EXPECT_TRUE(BuildState::parse(text + text).outputs.empty());
}

TEST(Contents, AreReadAgainOnlyIfTheStampIsNew) {
    const Scratch scratch;
    std::unordered_map<std::string, Memo> memos;
    Contents contents(scratch.path(), memos);
    scratch.write("a", "1");
    EXPECT_EQ(*contents.digest("a"), digest_of("1"));
    EXPECT_TRUE(memos.empty());  // it could change within the same tick
    std::this_thread::sleep_for(std::chrono::milliseconds(40));
    EXPECT_EQ(*contents.digest("a"), digest_of("1"));
    ASSERT_EQ(memos.size(), 1u);
    memos["a"].digest = digest_of("2");
    EXPECT_EQ(*contents.digest("a"), digest_of("2")) << "the memo is used";
    const auto before = std::filesystem::last_write_time(scratch.path("a"));
    scratch.write("a", "3");
    std::filesystem::last_write_time(scratch.path("a"), before);  // the same size and time
    EXPECT_EQ(*contents.digest("a"), digest_of("3"));
    EXPECT_FALSE(contents.digest("missing"));
}

TEST(TaskQueue, TheLargestComeFirstAndNeedsBeforeAll) {
    TaskQueue queue({{1, 0, {}}, {9, 0, {2}}, {3, 0, {}}, {5, 0, {}}}, 100);
    std::vector<std::size_t> order;
    while (const auto task = queue.take()) {
        order.push_back(*task);
        queue.finish(*task);
    }
    EXPECT_EQ(order, (std::vector<std::size_t>{3, 2, 1, 0}));
}

TEST(TaskQueue, MemoryIsNeverExceededExceptByOneAlone) {
    TaskQueue queue({{9, 200, {}}, {5, 60, {}}, {4, 60, {}}, {3, 40, {}}}, 100);
    EXPECT_EQ(queue.take(), 0u);  // too large, but alone
    queue.finish(0);
    EXPECT_EQ(queue.take(), 1u);
    EXPECT_EQ(queue.take(), 3u);  // 2 must wait
    queue.finish(1);
    EXPECT_EQ(queue.take(), 2u);
    EXPECT_EQ(queue.take(), std::nullopt);
}

TEST(TaskQueue, StopsWhenItIsTold) {
    TaskQueue queue({{1, 0, {}}, {2, 0, {0}}}, 100);
    EXPECT_EQ(queue.take(), 0u);
    std::thread waiting([&] { EXPECT_EQ(queue.take(), std::nullopt); });
    queue.stop();
    waiting.join();
}

TEST(Cache, FindsDamagedEntries) {
    const Scratch scratch;
    Cache cache(scratch.path("cache"));
    ASSERT_TRUE(cache.open(false));
    const Digest key = digest_of("key");
    const WriteOptions write;
    const std::vector<FileWarning> warnings = {{"", "is flat"}, {"", "a\tb", true}};
    EXPECT_TRUE(cache.fetch(key, one_file(scratch.path("b")), write)->empty());
    EXPECT_TRUE(cache.warnings(key).empty());
    ASSERT_TRUE(cache.store(key, one_file(scratch.path("a")), {"contents"}, warnings));
    EXPECT_FALSE(cache.fetch(key, one_file(scratch.path("b")), write)->empty());
    EXPECT_EQ(scratch.read("b"), "contents");
    EXPECT_EQ(cache.warnings(key), warnings);
    const std::string entry = "cache/" + key.hex().substr(0, 2) + "/" + key.hex();
    const std::string whole = scratch.read(entry);
    for (std::size_t k = 0; k < whole.size(); ++k) {
        std::string damaged = whole;
        damaged[k] = static_cast<char>(damaged[k] ^ 4);
        scratch.write(entry, damaged);
        ASSERT_TRUE(cache.fetch(key, one_file(scratch.path("c")), write)->empty()) << k;
        scratch.write(entry, whole.substr(0, k));
        ASSERT_TRUE(cache.fetch(key, one_file(scratch.path("c")), write)->empty()) << k;
    }
    EXPECT_FALSE(scratch.has("c"));
    EXPECT_EQ(cache.damaged(), 2 * whole.size());
}

TEST(Cache, RemovesWhatWasUsedLongestAgo) {
    const Scratch scratch;
    Cache cache(scratch.path("cache"));
    ASSERT_TRUE(cache.open(false));
    for (const char* name : {"1", "2", "3"}) {
        ASSERT_TRUE(cache.store(digest_of(name), one_file(scratch.path("a")), {std::string(1000, 'a')}, {}));
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    EXPECT_FALSE(cache.fetch(digest_of("1"), one_file(scratch.path("b")), {})->empty());
    MemoryHost host;
    Console console("test", host);
    cache.shrink(2500, console);
    EXPECT_FALSE(cache.fetch(digest_of("1"), one_file(scratch.path("b")), {})->empty());
    EXPECT_TRUE(cache.fetch(digest_of("2"), one_file(scratch.path("b")), {})->empty());
    EXPECT_FALSE(cache.fetch(digest_of("3"), one_file(scratch.path("b")), {})->empty());
}

}  // namespace tex::cli
