// SPDX-License-Identifier: Apache-2.0
// What libtex writes, judged by OpenEXR: header, table, texels.

#include "formats/exr/exr.h"
#include "formats/exr/exr_waiting.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <mutex>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfTiledInputFile.h>
#include <ImfTiledOutputFile.h>

#include <tex/types.h>

#include "reference/exr_file.h"
#include "unit/exr_files.h"

namespace tex {
namespace {

using Bytes = std::vector<std::byte>;

constexpr Format kExrFormats[] = {Format::r16_float, Format::rg16_float, Format::rgb16_float, Format::rgba16_float,
                                  Format::r32_float, Format::rg32_float, Format::rgb32_float, Format::rgba32_float};

// Levels of any bits, among them NaN. With a `density` below 256, most bytes repeat others: such chunks are compressed.
Texture texture_of_bits(Format format, Extent extent, bool has_levels, unsigned density = 3) {
    std::mt19937 random(11);
    Texture texture;
    texture.format = format;
    texture.y_axis = YAxis::down;
    texture.y_known = true;
    for (int k = 0; k < (has_levels ? level_count(extent) : 1); ++k) {
        Level level{level_extent(extent, k), {}};
        level.bytes.resize(level_bytes(format, level.extent));
        for (std::byte& b : level.bytes)
            b = static_cast<std::byte>(random() % 256 < density ? random() : level.bytes.size());
        texture.levels.push_back(std::move(level));
    }
    return texture;
}

class ExrBytes final : public Imf::IStream {
public:
    explicit ExrBytes(const Bytes& bytes) : Imf::IStream("test.exr"), bytes_(bytes) {}
    bool read(char data[], int n) override {
        if (at_ + static_cast<std::size_t>(n) > bytes_.size()) throw std::runtime_error("the file ends");
        std::memcpy(data, bytes_.data() + at_, static_cast<std::size_t>(n));
        at_ += static_cast<std::size_t>(n);
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t at) override { at_ = at; }

private:
    const Bytes& bytes_;
    std::size_t at_ = 0;
};

// The frame buffer of a level. OpenEXR's slices point to mutable bytes even if it only reads them.
Imf::FrameBuffer buffer_of(Format format, const Level& level) {
    const FormatInfo info = format_info(format);
    std::vector<std::string> names = {"R", "G", "B", "A"};
    if (info.channels == 1) names = {"Y"};
    Imf::FrameBuffer buffer;
    for (int c = 0; c < info.channels; ++c) {
        char* const channel = const_cast<char*>(reinterpret_cast<const char*>(level.bytes.data())) + c * info.bits / 8;
        buffer.insert(names[static_cast<std::size_t>(c)],
                      Imf::Slice(info.bits == 16 ? Imf::HALF : Imf::FLOAT, channel, info.block_bytes,
                                 info.block_bytes * static_cast<std::size_t>(level.extent.width)));
    }
    return buffer;
}

// What OpenEXR writes.
Bytes written_by_openexr(const Texture& texture) {
    const Extent extent = texture.levels.front().extent;
    Imf::Header header(extent.width, extent.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    const Imf::FrameBuffer first = buffer_of(texture.format, texture.levels.front());
    for (auto it = first.begin(); it != first.end(); ++it)
        header.channels().insert(it.name(), Imf::Channel(it.slice().type));
    header.insert("normalEncoding", Imf::StringAttribute("signed"));
    header.insert("normalYAxis", Imf::StringAttribute("down"));
    Bytes bytes;
    ExrSink sink(bytes);
    if (texture.levels.size() == 1) {
        Imf::OutputFile file(sink, header);
        file.setFrameBuffer(first);
        file.writePixels(extent.height);
        return bytes;
    }
    header.setTileDescription(Imf::TileDescription(64, 64, Imf::MIPMAP_LEVELS, Imf::ROUND_DOWN));
    Imf::TiledOutputFile file(sink, header);
    for (int k = 0; k < file.numLevels(); ++k) {
        file.setFrameBuffer(buffer_of(texture.format, texture.levels[static_cast<std::size_t>(k)]));
        file.writeTiles(0, file.numXTiles(k) - 1, 0, file.numYTiles(k) - 1, k);
    }
    return bytes;
}

// The levels that OpenEXR reads.
std::vector<Bytes> read_by_openexr(const Bytes& bytes, const Texture& like) {
    ExrBytes stream(bytes);
    std::vector<Bytes> levels;
    const auto room = [&](std::size_t k) {
        return Level{like.levels[k].extent, Bytes(like.levels[k].bytes.size(), std::byte{0xcd})};
    };
    if (like.levels.size() == 1) {
        Imf::InputFile file(stream);
        EXPECT_TRUE(file.isComplete());
        const Level level = room(0);
        file.setFrameBuffer(buffer_of(like.format, level));
        file.readPixels(0, level.extent.height - 1);
        return {level.bytes};
    }
    Imf::TiledInputFile file(stream);
    EXPECT_TRUE(file.isComplete());
    EXPECT_EQ(static_cast<std::size_t>(file.numLevels()), like.levels.size());
    for (int k = 0; k < file.numLevels(); ++k) {
        const Level level = room(static_cast<std::size_t>(k));
        file.setFrameBuffer(buffer_of(like.format, level));
        file.readTiles(0, file.numXTiles(k) - 1, 0, file.numYTiles(k) - 1, k);
        levels.push_back(level.bytes);
    }
    return levels;
}

// Equal version, attributes and number of chunks.
void expect_same_head(const Bytes& ours, const Bytes& theirs) {
    const auto parsed = [](const Bytes& bytes) {
        return reference::parse_exr({reinterpret_cast<const char*>(bytes.data()), bytes.size()}).value();
    };
    const reference::ExrFile a = parsed(ours), b = parsed(theirs);
    EXPECT_EQ(a.version, b.version);
    EXPECT_EQ(a.table.size(), b.table.size());
    ASSERT_EQ(a.parts.size(), b.parts.size());
    ASSERT_EQ(a.parts[0].size(), b.parts[0].size());
    for (std::size_t k = 0; k < a.parts[0].size(); ++k) {
        EXPECT_EQ(a.parts[0][k].name, b.parts[0][k].name);
        EXPECT_EQ(a.parts[0][k].type, b.parts[0][k].type);
        EXPECT_EQ(a.parts[0][k].value, b.parts[0][k].value) << a.parts[0][k].name;
    }
}

void expect_reads(const Texture& texture) {
    const Extent extent = texture.levels.front().extent;
    SCOPED_TRACE(std::string(name_of(kFormatNames, texture.format)) + " " + std::to_string(extent.width) + "x" +
                 std::to_string(extent.height) + ", levels: " + std::to_string(texture.levels.size()));
    const Result<Bytes> bytes = encode_exr(texture);
    ASSERT_TRUE(bytes) << bytes.error().message();
    const std::vector<Bytes> levels = read_by_openexr(*bytes, texture);
    ASSERT_EQ(levels.size(), texture.levels.size());
    for (std::size_t k = 0; k < levels.size(); ++k) EXPECT_TRUE(levels[k] == texture.levels[k].bytes) << k;
    expect_same_head(*bytes, written_by_openexr(texture));
}

TEST(ExrWrite, OpenExrReadsTheSameHeaderAndTexels) {
    for (const Format format : kExrFormats) {
        // One texel, one row, one column, one and several chunks, tiles that are cut off, and several blocks of a band.
        for (const Extent extent : {Extent{1, 1}, Extent{200, 1}, Extent{1, 300}, Extent{37, 16}, Extent{130, 70},
                                    Extent{64, 129}, Extent{3000, 17}}) {
            for (const bool has_levels : {false, true}) expect_reads(texture_of_bits(format, extent, has_levels));
        }
    }
}

// Zeros give the longest runs; noise cannot be compressed, and is stored.
TEST(ExrWrite, OpenExrReadsTexelsOfEveryDensity) {
    for (const unsigned density : {0u, 1u, 64u, 256u}) {
        for (const bool has_levels : {false, true})
            expect_reads(texture_of_bits(Format::rgb16_float, {300, 200}, has_levels, density));
    }
}

TEST(ExrWrite, NoiseTakesNoMoreBytesThanFromOpenExr) {
    const Texture texture = texture_of_bits(Format::rgba32_float, {200, 100}, true, 256);
    EXPECT_LE(encode_exr(texture).value().size(), written_by_openexr(texture).size());
}

// Puts rows in pieces of several sizes, level by level or a little of each, and ends work in any order on several
// threads.
class ManyHands {
public:
    // What waits may go to a scratch file beside `beside`, if that is not empty.
    explicit ManyHands(const Texture& texture, unsigned seed, const std::string& beside = {})
        : texture_(texture), random_(seed) {
        target_ =
            open_exr_target(head_of(texture),
                            [this](std::uint64_t offset, std::span<const std::byte> bytes) -> Result<void> {
                                const auto at = static_cast<std::size_t>(offset);
                                file_.resize(std::max(file_.size(), at + bytes.size()));
                                std::copy(bytes.begin(), bytes.end(), file_.begin() + static_cast<std::ptrdiff_t>(at));
                                return {};
                            })
                .value();
        if (!beside.empty()) target_->wait_beside(beside);
        next_.assign(texture.levels.size(), 0);
    }
    Bytes run(int threads) {
        std::vector<std::thread> others;
        for (int k = 1; k < threads; ++k) others.emplace_back([this] { work(); });
        work();
        for (std::thread& other : others) other.join();
        EXPECT_FALSE(failed_);
        EXPECT_TRUE(target_->finish());
        return file_;
    }

private:
    // Puts some rows of a level. False if there are none left.
    bool put_some() {
        std::vector<std::size_t> open;
        for (std::size_t k = 0; k < next_.size(); ++k) {
            if (next_[k] < texture_.levels[k].extent.height) open.push_back(k);
        }
        if (open.empty()) return false;
        const std::size_t k = open[random_() % open.size()];
        const Level& level = texture_.levels[k];
        const int most = random_() % 2 == 0 ? 200 : 9;
        const int count =
            std::min(1 + static_cast<int>(random_() % static_cast<unsigned>(most)), level.extent.height - next_[k]);
        const std::size_t pitch = level.bytes.size() / static_cast<std::size_t>(level.extent.height);
        if (!target_->put(static_cast<int>(k), level.bytes.data() + pitch * static_cast<std::size_t>(next_[k]), count))
            failed_ = true;
        next_[k] += count;
        return true;
    }
    void work() {
        std::unique_lock lock(mutex_);
        while (put_some()) {
            std::vector<std::shared_ptr<RowWork>> taken;
            while (std::shared_ptr<RowWork> some = target_->take_work()) taken.push_back(std::move(some));
            std::shuffle(taken.begin(), taken.end(), random_);
            for (const std::shared_ptr<RowWork>& some : taken) {
                lock.unlock();
                if (!some->run()) failed_ = true;
                lock.lock();
                if (!target_->end_work(some)) failed_ = true;
            }
        }
    }

    const Texture& texture_;
    std::mutex mutex_;
    std::minstd_rand random_;
    std::unique_ptr<RowTarget> target_;
    std::vector<int> next_;
    Bytes file_;
    std::atomic<bool> failed_{false};
};

TEST(ExrWrite, BytesDoNotDependOnThreadsAndOrder) {
    for (const Extent extent : {Extent{131, 200}, Extent{64, 128}, Extent{2000, 70}, Extent{700, 3}}) {
        for (const bool has_levels : {false, true}) {
            const Texture texture = texture_of_bits(Format::rgb16_float, extent, has_levels);
            const Bytes expected = encode_exr(texture).value();
            for (unsigned round = 0; round < 6; ++round) {
                const int threads = 1 + static_cast<int>(round) % 3;
                EXPECT_TRUE(ManyHands(texture, round).run(threads) == expected) << extent.width << ", " << round;
            }
        }
    }
}

// The bytes that wait are more than those that may wait in memory.
TEST(ExrWrite, BytesDoNotDependOnScratchFiles) {
    const Texture texture = texture_of_bits(Format::rgba16_float, {1100, 1300}, true, 256);
    const Bytes expected = encode_exr(texture).value();
    for (const std::string beside : {"", "out.exr", "/no/such/folder/out.exr"})
        EXPECT_TRUE(ManyHands(texture, 5, beside).run(2) == expected) << beside;
}

ExrChunks chunks_of(std::size_t bytes, int number) {
    return {Bytes(bytes, static_cast<std::byte>(number)), {bytes, static_cast<std::size_t>(number)}};
}

void expect_takes(ExrWaitingBlocks& blocks, std::size_t bytes, int number) {
    const Result<std::optional<ExrChunks>> taken = blocks.take(number);
    ASSERT_TRUE(taken);
    ASSERT_TRUE(*taken) << number;
    const ExrChunks expected = chunks_of(bytes, number);
    EXPECT_TRUE((*taken)->bytes == expected.bytes) << number;
    EXPECT_EQ((*taken)->sizes, expected.sizes) << number;
    EXPECT_FALSE(blocks.take(number).value()) << number;
}

TEST(ExrWaitingBlocks, ComeBackInAnyOrder) {
    constexpr std::size_t kMegabyte = std::size_t{1} << 20;
    for (const std::string output : {"", "out.exr"}) {
        ExrWaitingBlocks blocks;
        blocks.wait_beside(output);
        EXPECT_FALSE(blocks.take(0).value());
        for (const int number : {9, 2, 7, 4, 8, 3, 1}) ASSERT_TRUE(blocks.add(number, chunks_of(kMegabyte, number)));
        for (const int number : {3, 9, 1}) expect_takes(blocks, kMegabyte, number);
        for (const int number : {6, 5}) ASSERT_TRUE(blocks.add(number, chunks_of(2 * kMegabyte, number)));
        for (const int number : {2, 4}) expect_takes(blocks, kMegabyte, number);
        for (const int number : {5, 6}) expect_takes(blocks, 2 * kMegabyte, number);
        for (const int number : {7, 8}) expect_takes(blocks, kMegabyte, number);
    }
}

TEST(ExrWrite, MissingRowsAreAnError) {
    for (const bool has_levels : {false, true}) {
        const Texture texture = texture_of_bits(Format::rgb16_float, {10, 10}, has_levels);
        const auto target =
            open_exr_target(head_of(texture), [](std::uint64_t, std::span<const std::byte>) { return Result<void>(); });
        ASSERT_TRUE(target);
        ASSERT_TRUE((*target)->put(0, texture.levels.front().bytes.data(), 9));
        EXPECT_EQ((*target)->take_work(), nullptr);
        EXPECT_FALSE((*target)->finish());
    }
}

TEST(ExrWrite, FailuresOfTheFileAreReported) {
    const Texture texture = texture_of_bits(Format::r16_float, {40, 40}, false);
    for (int good = 0; good < 4; ++good) {
        int left = good;
        const auto target =
            open_exr_target(head_of(texture), [&](std::uint64_t, std::span<const std::byte>) -> Result<void> {
                return left-- > 0 ? Result<void>() : Result<void>(Error{ErrorCode::io, "out.exr", "the disk is full"});
            });
        ASSERT_TRUE(target);
        ASSERT_TRUE((*target)->put(0, texture.levels.front().bytes.data(), 40));
        Result<void> done;
        while (const std::shared_ptr<RowWork> work = (*target)->take_work()) {
            ASSERT_TRUE(work->run());
            if (done) done = (*target)->end_work(work);
        }
        if (done) done = (*target)->finish();
        ASSERT_EQ(static_cast<bool>(done), false) << good;
        EXPECT_EQ(done.error().reason, "the disk is full");
    }
}

}  // namespace
}  // namespace tex
