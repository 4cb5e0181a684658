// SPDX-License-Identifier: Apache-2.0
// Verbs on the threads and in the memory of a caller: Execution::parallel and Execution::allocate.

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/bake.h>
#include <tex/blend.h>
#include <tex/file.h>
#include <tex/height.h>
#include <tex/mip.h>
#include <tex/pack.h>
#include <tex/pipeline.h>
#include <tex/surface.h>

#include "unit/fields.h"
#include "unit/normal_maps.h"
#include "unit/streams.h"

namespace tex {
namespace {

HeightField terraces(Extent extent) {
    HeightField field;
    field.height = fields::plane_of(extent, [](int i, int j) { return ((i * i / 40 + j * 3) % 200) / 255.0; });
    return field;
}

// Most verbs, one after the other.
Result<std::vector<std::byte>> make_texture(const Execution& execution, Extent extent = {90, 40}) {
    Result<DebandedField> field = deband(terraces(extent), Deband::on, execution);
    if (!field) return field.error();
    Result<NormalMap> map = bake(*field, {}, execution);
    if (!map) return map.error();
    Result<Integration> heights = integrate(*map, {}, execution);
    if (!heights) return heights.error();
    Result<NormalMap> scaled = scale(std::move(*map), 1.5f, ScaleMode::slope, execution);
    if (!scaled) return scaled.error();
    std::vector<Layer> layers(1);
    layers[0].detail = chain_from(wavy_map({32, 32}));
    Result<NormalMap> blended = blend(chain_from(std::move(*scaled)), std::move(layers), {}, execution);
    if (!blended) return blended.error();
    Result<MipChain> chain = build_mip_chain(std::move(*blended), {}, execution);
    if (!chain) return chain.error();
    Result<PackedTexture> texture = pack(*chain, {Encoding::bc5}, execution);
    if (!texture) return texture.error();
    Result<MipChain> unpacked = unpack(*texture, {}, execution);
    if (!unpacked) return unpacked.error();
    return encode_file(*texture, Container::ktx2);
}

// Runs the bodies on three threads, the last body first.
void run_backwards(int count, const std::function<void(int)>& body) {
    std::atomic<int> next{count - 1};
    std::vector<std::thread> threads;
    for (int k = 0; k < 3; ++k) {
        threads.emplace_back([&] {
            for (int at = next--; at >= 0; at = next--) body(at);
        });
    }
    for (std::thread& thread : threads) thread.join();
}

TEST(CallerResources, LoopsRunOnTheCallersThreads) {
    constexpr Extent kSize = {200, 90};
    const auto wanted = make_texture({1, {}}, kSize).value();
    std::atomic<int> loops{0};
    Execution execution;
    execution.threads = 4;
    execution.parallel = [&](int count, const std::function<void(int)>& body) {
        ++loops;
        run_backwards(count, body);
    };
    EXPECT_EQ(make_texture(execution, kSize).value(), wanted);
    EXPECT_GT(loops, 5);
    execution.parallel = [](int count, const std::function<void(int)>& body) {
        for (int k = 0; k < count; ++k) body(k);
    };
    EXPECT_EQ(make_texture(execution, kSize).value(), wanted) << "one after the other";
    loops = 0;
    execution.threads = 1;
    execution.parallel = [&](int, const std::function<void(int)>&) { ++loops; };
    EXPECT_EQ(make_texture(execution, kSize).value(), wanted);
    EXPECT_EQ(loops, 0) << "one thread is the caller's own";
}

class CallerThreads : public StreamTest {};

TEST_F(CallerThreads, StreamFiles) {
    ASSERT_TRUE(write_texture(path("in.ktx2"), *pack(chain_from(wavy_map({700, 500})), {Encoding::float_})));
    PackFileOptions options;
    options.mip.emplace();
    ASSERT_TRUE(pack_file(path("in.ktx2"), path("wanted.dds"), Container::dds, options, {1, {}}));
    Execution execution;
    execution.threads = 3;
    for (const bool serial : {false, true}) {
        int loops = 0;
        execution.parallel = [&](int count, const std::function<void(int)>& body) {
            ++loops;
            if (!serial) return run_backwards(count, body);
            for (int k = 0; k < count; ++k) body(k);
        };
        ASSERT_TRUE(pack_file(path("in.ktx2"), path("out.dds"), Container::dds, options, execution));
        EXPECT_GT(loops, 0);
        EXPECT_TRUE(bytes_of(path("out.dds")) == bytes_of(path("wanted.dds")));
    }
}

// Counts the planes that live in its memory.
struct Arena {
    std::atomic<int> made{0}, alive{0};
    std::atomic<int> most{1 << 30};  // planes; then there is no more memory

    [[nodiscard]] Execution execution() {
        Execution with;
        with.threads = 2;
        with.allocate = [this](std::size_t bytes) -> std::shared_ptr<void> {
            if (made >= most) return nullptr;
            ++made;
            ++alive;
            const std::size_t whole = (bytes + kRowAlignment - 1) / kRowAlignment * kRowAlignment;
            return {std::aligned_alloc(kRowAlignment, whole), [this](void* memory) {
                        --alive;
                        std::free(memory);
                    }};
        };
        return with;
    }
};

TEST(CallerResources, PlanesLiveInTheCallersMemory) {
    Arena arena;
    {
        const Result<NormalMap> map = bake(terraces({90, 40}), {}, arena.execution());
        ASSERT_TRUE(map);
        EXPECT_GT(arena.alive, 0);
        const NormalMap copy = copy_of(*map);
        EXPECT_EQ(arena.alive, 1) << "x, y and z are one piece; the caller's own copies come from the heap";
    }
    EXPECT_EQ(arena.alive, 0);
    EXPECT_EQ(make_texture(arena.execution()).value(), make_texture({1, {}}).value());
    EXPECT_EQ(arena.alive, 0);
}

TEST(CallerResources, WithoutMemoryIsAnErrorWhereverItEnds) {
    Arena all;
    ASSERT_TRUE(make_texture(all.execution()));
    ASSERT_GT(all.made, 10);
    for (int most = 0; most < all.made; most += 1 + most / 4) {
        Arena arena;
        arena.most = most;
        const auto texture = make_texture(arena.execution());
        ASSERT_FALSE(texture) << most;
        EXPECT_EQ(texture.error().code, ErrorCode::out_of_memory) << most;
        EXPECT_EQ(arena.alive, 0) << most;
    }
}

}  // namespace
}  // namespace tex
