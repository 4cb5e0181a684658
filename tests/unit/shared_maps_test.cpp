// SPDX-License-Identifier: Apache-2.0

#include "stream/shared_maps.h"

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <tex/file.h>

#include "rows/blend_rows.h"
#include "scratch.h"

namespace tex {
namespace {

constexpr std::int64_t kBytes = 64 * 64 * 12;  // of a map

class SharedMapsTest : public testing::Test, protected Scratch {
protected:
    // A map of 64x64 texels.
    std::string map(const std::string& name, int lean) const {
        Texture texture;
        texture.format = Format::rgb8_unorm;
        texture.levels.push_back({{64, 64}, {}});
        for (int k = 0; k < 64 * 64; ++k) {
            for (const int code : {lean, 128, 230})
                texture.levels.front().bytes.push_back(static_cast<std::byte>(code));
        }
        EXPECT_TRUE(write_texture(path(name), texture));
        return path(name);
    }
    static std::shared_ptr<const HeldMap> get(SharedMaps& maps, const std::string& path, float tiling = 1.0f,
                                              const SourceOptions& options = {}, Wrap wrap = Wrap::repeat) {
        const UvMap place = uv_map_of(Placement{tiling, tiling}, {64, 64}, 1.0, 0.0);
        auto map = maps.get(path, options, {place, wrap, wrap}, {1, {}});
        EXPECT_TRUE(map);
        return map ? *map : nullptr;
    }
};

TEST_F(SharedMapsTest, ReadsAMapOnceForEachWayOfReadingIt) {
    SharedMaps maps(100 * kBytes);
    const std::string a = map("a.png", 100);
    const auto first = get(maps, a);
    EXPECT_EQ(first, get(maps, a));
    SourceOptions down;
    down.unpack.y_axis = YAxis::down;
    const auto other = get(maps, a, 1.0f, down);
    EXPECT_NE(other, first);
    EXPECT_EQ(other->info.y_axis, YAxis::down);
    // Smaller on the result: it needs levels, which depend on its borders.
    const auto levels = get(maps, a, 4.0f);
    EXPECT_EQ(levels->chain.levels.size(), 7u);
    EXPECT_EQ(levels, get(maps, a, 8.0f));
    EXPECT_EQ(levels->chain.levels[0].x.row(0), first->chain.levels[0].x.row(0)) << "both have the same base level";
    EXPECT_NE(levels, get(maps, a, 4.0f, {}, Wrap::clamp));
    EXPECT_EQ(first, get(maps, a));
}

TEST_F(SharedMapsTest, ReadsAFileAgainThatHasChanged) {
    SharedMaps maps(100 * kBytes);
    const auto before = get(maps, map("a.png", 100));
    const auto after = get(maps, map("a.png", 200));
    EXPECT_LT(before->chain.levels[0].x.row(5)[5], 0.0f);
    EXPECT_GT(after->chain.levels[0].x.row(5)[5], 0.0f);
}

TEST_F(SharedMapsTest, TakesNoMoreMemoryThanAllowed) {
    SharedMaps none(kBytes - 1);
    EXPECT_EQ(get(none, map("a.png", 1)), nullptr) << "the caller reads it";
    SharedMaps maps(2 * kBytes);
    const std::weak_ptr<const HeldMap> a = get(maps, map("a.png", 1)), b = get(maps, map("b.png", 2));
    EXPECT_FALSE(a.expired() || b.expired());
    EXPECT_TRUE(get(maps, path("a.png")));
    const auto c = get(maps, map("c.png", 3));
    EXPECT_TRUE(b.expired()) << "it was not used for the longest time";
    EXPECT_FALSE(a.expired());
    // Maps in use cannot make room. This caller gets the map alone.
    const auto held = a.lock();
    const std::weak_ptr<const HeldMap> d = get(maps, map("d.png", 4));
    EXPECT_TRUE(d.expired());
    EXPECT_EQ(get(maps, path("d.png")), nullptr);
}

TEST_F(SharedMapsTest, ErrorsAndStreamsAreLeftToTheCaller) {
    SharedMaps maps(100 * kBytes);
    EXPECT_EQ(get(maps, "-"), nullptr);
    EXPECT_EQ(get(maps, path("missing.png")), nullptr);
    ASSERT_TRUE(write_file(path("bad.png"), std::vector<std::byte>(10)));
    const auto bad = maps.get(path("bad.png"), {}, {}, {1, {}});
    ASSERT_FALSE(bad);
    EXPECT_EQ(bad.error().file, path("bad.png"));
}

TEST_F(SharedMapsTest, AnyThreadMayAsk) {
    SharedMaps maps(100 * kBytes);
    const std::string a = map("a.png", 100);
    std::vector<std::shared_ptr<const HeldMap>> found(8);
    std::vector<std::thread> threads;
    for (std::size_t k = 0; k < found.size(); ++k)
        threads.emplace_back([&, k] { found[k] = get(maps, a, 1.0f + static_cast<float>(k % 2) * 4.0f); });
    for (std::thread& thread : threads) thread.join();
    for (std::size_t k = 2; k < found.size(); ++k) EXPECT_EQ(found[k], found[k % 2]);
}

}  // namespace
}  // namespace tex
