// SPDX-License-Identifier: Apache-2.0

#include "stream/pack_stream.h"

#include <gtest/gtest.h>
#include <half.h>

#include <atomic>
#include <filesystem>
#include <random>

#include <tex/mip.h>

#include "unit/normal_maps.h"
#include "unit/streams.h"

namespace tex {
namespace {

class PackStream : public StreamTest {
protected:
    PackStream() {
        options_.write.sync = false;
        pack_.effort = Effort::fast;
        pack_.encoding = Encoding::dxt5nm;
        options_.pack = [this](const SourceInfo& info) {
            PackOptions pack = pack_;
            if (!y_) pack.y_axis = info.y_axis;
            return pack;
        };
    }

    using StreamTest::write;
    // Writes the texture to a file of type `kind`.
    [[nodiscard]] std::string write(const Texture& texture, Container kind) const {
        const std::string name(name_of(kContainerNames, kind));
        return write("in." + name, encode_file(texture, kind, options_.write).value());
    }
    [[nodiscard]] std::string write_map(Extent extent, Container kind, Encoding encoding, int levels = 1,
                                        ExtraSet beside = {}) const {
        MipOptions mip;
        mip.levels = levels;
        NormalMap map = wavy_map(extent);
        if (beside.alpha) map.alpha = wavy_map(extent).x;
        if (beside.blue) map.blue = wavy_map(extent).y;
        const MipChain chain = build_mip_chain(std::move(map), mip).value();
        return write(pack(chain, {encoding, YAxis::down, Effort::fast}).value(), kind);
    }

    // The result of calling the verbs on a file one after the other.
    [[nodiscard]] Result<Bytes> by_verbs(const std::string& input, Container container) const {
        Result<Source> source = read_normals(input, options_.source);
        if (!source) return source.error();
        MipChain chain = std::move(source->chain);
        if (options_.level) std::swap(chain.levels.front(), chain.levels.at(static_cast<std::size_t>(*options_.level)));
        if (options_.level || options_.mip || !can_hold_levels(container)) chain.levels.resize(1);
        if (options_.scale) chain = scale(std::move(chain), options_.scale->scale, options_.scale->mode).value();
        if (options_.mip) {
            MipOptions mip = *options_.mip;
            if (!can_hold_levels(container)) mip.levels = 1;
            chain = build_mip_chain(std::move(chain.levels.front()), mip).value();
        }
        return encode_file(pack(chain, options_.pack(source->info)).value(), container, options_.write);
    }

    // Streams a file in small pieces.
    Result<PackFileReport> stream(const std::string& input, Container container, int threads, const StreamSizes& sizes,
                                  std::function<bool(double)> progress = {}) const {
        Result<InputFile> file = InputFile::open(input);
        if (!file) return file.error();
        return pack_stream(*file, path("out"), container, options_, {threads, std::move(progress)}, sizes);
    }

    void draw_options(std::mt19937& random, int levels) {
        const auto one_in = [&](unsigned n) { return random() % n == 0; };
        options_.source = {};
        options_.source.drop_others = one_in(4);
        options_.source.unpack.others = {one_in(2), one_in(2)};
        options_.source.unpack.snap_flat = one_in(3);
        options_.source.unpack.keep_length = one_in(3);
        options_.source.unpack.range = one_in(2) ? ValueRange::automatic : any_of(kValueRangeNames, random);
        if (one_in(2)) options_.source.unpack.y_axis = any_of(kYAxisNames, random);
        if (one_in(8)) options_.source.r_or_a = true;
        options_.scale = one_in(3) ? std::optional<Scaling>({0.5f * static_cast<float>(random() % 7) - 1.0f,
                                                             any_of(kScaleModeNames, random)})
                                   : std::nullopt;
        options_.level =
            one_in(4) ? std::optional<int>(static_cast<int>(random() % static_cast<unsigned>(levels))) : std::nullopt;
        options_.mip.reset();
        if (one_in(2)) {
            options_.mip = MipOptions();
            options_.mip->filter = any_of(kMipFilterNames, random);
            options_.mip->domain = any_of(kMipDomainNames, random);
            options_.mip->levels = one_in(2) ? 0 : static_cast<int>(random() % 5);
            options_.mip->max_side = one_in(3) ? 1 << (random() % 7) : 0;
            if (one_in(3)) options_.mip->fade = Fade{1, 3};
            options_.mip->wrap_x = any_of(kWrapNames, random);
            options_.mip->wrap_y = any_of(kWrapNames, random);
            if (options_.mip->domain == MipDomain::vector) {
                options_.mip->alpha = any_of(kExtraKindNames, random);
                options_.mip->blue = any_of(kExtraKindNames, random);
            }
        }
        y_ = one_in(2);
        pack_.encoding = any_of(kEncodingNames, random);
        pack_.y_axis = any_of(kYAxisNames, random);
        options_.write.dds_header = any_of(kDdsHeaderNames, random);
    }

    PackFileOptions options_;
    PackOptions pack_;
    bool y_ = false;  // pack_.y_axis applies
};

Encoding encoding_in(Container kind, std::mt19937& random) {
    while (true) {
        const Encoding encoding = any_of(kEncodingNames, random);
        if (can_hold(kind, encoding)) return encoding;
    }
}

constexpr int kSides[] = {1, 2, 3, 4, 5, 7, 8, 13, 16, 17, 31, 40, 64, 97};

TEST_F(PackStream, GivesTheBytesOfTheVerbs) {
    constexpr Container kKinds[] = {Container::png, Container::exr, Container::dds, Container::ktx2, Container::astc};
    std::mt19937 random(11);
    for (int round = 0; round < 600; ++round) {
        const Extent extent{kSides[random() % 14], kSides[random() % 14]};
        const Container kind = kKinds[random() % std::size(kKinds)];
        const Container container = kKinds[random() % std::size(kKinds)];
        const bool all_or_one = kind == Container::exr || container == Container::exr;
        int levels = 1 + static_cast<int>(random() % static_cast<unsigned>(level_count(extent)));
        if (all_or_one && levels > 1) levels = level_count(extent);
        if (!can_hold_levels(kind)) levels = 1;
        draw_options(random, levels);
        options_.write.dds_mark = random() % 2 == 0;
        pack_.encoding = encoding_in(container, random);
        if (container == Container::exr) {
            if (options_.mip) options_.mip->levels = random() % 2 == 0 ? 0 : 1;
        }
        const std::string input =
            write_map(extent, kind, encoding_in(kind, random), levels, {random() % 2 == 0, random() % 2 == 0});
        SCOPED_TRACE(testing::Message() << "round " << round << ", " << extent.width << "x" << extent.height);
        const Result<Bytes> expected = by_verbs(input, container);
        ASSERT_TRUE(expected) << expected.error().message();
        const int strip_texels = 1 << (2 + random() % 10);
        const auto report = stream(input, container, 1 + static_cast<int>(random() % 3), {strip_texels, 0});
        ASSERT_TRUE(report) << report.error().message();
        ASSERT_TRUE(bytes_of(path("out")) == *expected);
        EXPECT_EQ(report->extent, read_texture(path("out"))->extent());
        EXPECT_EQ(report->bytes, expected->size());
    }
}

// Textures by other writers: channels by masks, rows from bottom to top, headers that claim too much.
TEST_F(PackStream, TakesTheTexturesOfOthersAsTheVerbsDo) {
    std::vector<std::filesystem::path> inputs;
    for (const auto& entry : std::filesystem::directory_iterator(TEX_SOURCE_DIR "/samples/broken"))
        inputs.push_back(entry.path());
    if (std::filesystem::exists(shared_data())) {
        for (const char* folder : {"dds", "dds/reference", "bad"}) {
            for (const auto& file : files_in(folder, ".dds")) inputs.push_back(file);
        }
    }
    pack_.encoding = Encoding::bc5;
    for (const auto& input : inputs) {
        const std::string extension = input.extension();
        if (extension != ".dds" && extension != ".ktx2") continue;
        for (const std::optional<int> level : {std::optional<int>(), std::optional<int>(1)}) {
            SCOPED_TRACE(input.string());
            options_.level = level;
            const Result<Source> source = read_normals(input, options_.source);
            const auto report = pack_file(input, path("out"), Container::dds, options_, {2, {}});
            if (source && level && source->chain.levels.size() < 2) {
                EXPECT_EQ(report.error().code, ErrorCode::bad_option);
                continue;
            }
            ASSERT_EQ(bool(report), bool(source));
            if (!report) {
                EXPECT_EQ(report.error().message(), source.error().message());
                EXPECT_EQ(report.error().code, source.error().code);
                EXPECT_FALSE(std::filesystem::exists(path("out")));
                continue;
            }
            EXPECT_TRUE(bytes_of(path("out")) == by_verbs(input, Container::dds).value());
            EXPECT_EQ(report->source.remarks, source->info.remarks);
            EXPECT_EQ(report->source.swizzle, source->info.swizzle);
            std::filesystem::remove(path("out"));
        }
    }
}

TEST_F(PackStream, TakesRowsThatRunUpwards) {
    Texture texture = pack(chain_from(wavy_map({19, 11})), {Encoding::rgb8}).value();
    Bytes bytes = encode_file(texture, Container::ktx2).value();
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::size_t at = text.find("KTXorientation") + 16;  // "rd"
    bytes[at] = std::byte{'u'};
    const std::string input = write("up.ktx2", bytes);
    const Bytes expected = by_verbs(input, Container::dds).value();
    EXPECT_FALSE(expected == by_verbs(write(texture, Container::ktx2), Container::dds).value());
    for (const int strip_texels : {4, 100, 10000}) {
        ASSERT_TRUE(stream(input, Container::dds, 2, {strip_texels, 0}));
        EXPECT_TRUE(bytes_of(path("out")) == expected);
    }
}

// Layouts that only the texels show. The first assumption may be wrong.
TEST_F(PackStream, ReadsOnceMoreWhereTheTexelsSayOtherwise) {
    std::mt19937 random(5);
    constexpr Swizzle kUnknown = {Component::other, Component::other, Component::other, Component::other};
    constexpr Encoding kEncodings[] = {Encoding::rgba8, Encoding::ag8, Encoding::rgb8, Encoding::half,
                                       Encoding::float_};
    for (int round = 0; round < 120; ++round) {
        const Extent extent{kSides[random() % 14], kSides[random() % 14]};
        const Encoding encoding = kEncodings[random() % std::size(kEncodings)];
        Texture texture = pack(chain_from(wavy_map(extent)), {encoding}).value();
        const bool floats = format_info(texture.format).sample == SampleKind::floating;
        if (floats && random() % 2 == 0) {  // (n + 1) / 2, and four channels
            const bool doom = random() % 2 == 0;
            const Texture source = pack(chain_from(wavy_map(extent)), {Encoding::float_}).value();
            texture.format = Format::rgba32_float;
            texture.levels[0].bytes.resize(level_bytes(texture.format, extent));
            for (std::size_t k = 0; k < static_cast<std::size_t>(extent.texels()); ++k) {
                float n[4] = {0, 0, 0, 1};
                std::memcpy(n, source.levels[0].bytes.data() + 12 * k, 12);
                for (int c = 0; c < 3; ++c) n[c] = (n[c] + 1) / 2;
                if (doom) std::swap(n[0], n[3]);
                std::memcpy(texture.levels[0].bytes.data() + 16 * k, n, 16);
            }
        }
        texture.swizzle = kUnknown;  // the EXR file then says nothing
        draw_options(random, 1);
        options_.source.unpack.range = ValueRange::automatic;
        const std::string input = write(texture, floats ? Container::exr : Container::png);
        SCOPED_TRACE(testing::Message() << "round " << round << ", " << extent.width << "x" << extent.height << ", "
                                        << name_of(kEncodingNames, pack_.encoding));
        const Result<Bytes> expected = by_verbs(input, Container::ktx2);
        ASSERT_TRUE(expected) << expected.error().message();
        double last = 0.0;
        const auto report = stream(input, Container::ktx2, 1 + round % 3, {64, 0}, [&](double fraction) {
            EXPECT_GE(fraction, last);
            last = fraction;
            return true;
        });
        ASSERT_TRUE(report) << report.error().message();
        ASSERT_TRUE(bytes_of(path("out")) == *expected);
        const SourceInfo info = read_normals(input, options_.source).value().info;
        EXPECT_EQ(report->source.swizzle, info.swizzle);
        EXPECT_EQ(report->source.guessed, info.guessed);
        EXPECT_EQ(report->source.y_axis, info.y_axis);
        EXPECT_EQ(files(), 1u + static_cast<std::size_t>(std::filesystem::exists(path("out"))) +
                               static_cast<std::size_t>(std::filesystem::exists(path("in.png")) &&
                                                        std::filesystem::exists(path("in.exr"))));
    }
}

TEST_F(PackStream, MapsGoThroughManyStripsOnManyThreads) {
    for (const Extent extent : {Extent{512, 70}, Extent{131, 300}}) {
        for (const Container kind : {Container::png, Container::exr, Container::dds}) {
            pack_.encoding = Encoding::dxt5nm;
            const std::string input = write_map(extent, kind, default_encoding(kind), kind == Container::dds ? 0 : 1);
            options_.mip = kind == Container::dds ? std::nullopt : std::optional(MipOptions());
            const Bytes expected = by_verbs(input, Container::dds).value();
            for (const int threads : {2, 5}) {
                const auto report = stream(input, Container::dds, threads, {4096, 0});
                ASSERT_TRUE(report) << report.error().message();
                EXPECT_TRUE(bytes_of(path("out")) == expected) << extent.width << " " << threads;
            }
            options_.mip.reset();
            options_.level = 0;
            pack_.encoding = default_encoding(kind == Container::dds ? Container::png : kind);
            const Container picture = kind == Container::dds ? Container::png : kind;
            const auto report = stream(input, picture, 3, {4096, 0});
            ASSERT_TRUE(report) << report.error().message();
            EXPECT_TRUE(bytes_of(path("out")) == by_verbs(input, picture).value());
            options_.level.reset();
        }
    }
}

TEST_F(PackStream, TakesEveryInputThatComesInOrder) {
    const Extent extent{45, 30};
    options_.mip = MipOptions();
    struct Case {
        Container kind;
        Encoding encoding;
    };
    for (const auto& [kind, encoding] : {Case{Container::png, Encoding::rgb8}, Case{Container::png, Encoding::rgb16},
                                         Case{Container::exr, Encoding::half}, Case{Container::exr, Encoding::float_},
                                         Case{Container::tiff, Encoding::rgb16}, Case{Container::tga, Encoding::ag8},
                                         Case{Container::bmp, Encoding::rgb8}, Case{Container::jpeg, Encoding::rgb8},
                                         Case{Container::webp, Encoding::rgb8}}) {
        SCOPED_TRACE(name_of(kContainerNames, kind));
        const std::string input = write_map(extent, kind, encoding);
        const auto report = pack_file(input, path("out"), Container::ktx2, options_);
        ASSERT_TRUE(report) << report.error().message();
        EXPECT_EQ(report->levels, 6);
        EXPECT_TRUE(bytes_of(path("out")) == by_verbs(input, Container::ktx2).value());
    }
}

// The reader process encodes such pictures as a whole.
TEST_F(PackStream, PicturesOfTheReaderHaveTheBytesOfTheVerbs) {
    const std::string plain = write_map({82, 56}, Container::png, Encoding::rgb8);
    for (const Container container :
         {Container::tiff, Container::tga, Container::bmp, Container::jpeg, Container::webp}) {
        for (const bool builds : {false, true}) {
            SCOPED_TRACE(name_of(kContainerNames, container));
            options_.mip = builds ? std::optional(MipOptions()) : std::nullopt;
            pack_.encoding = default_encoding(container);
            const auto report = stream(plain, container, 3, {256, 0});
            ASSERT_TRUE(report) << report.error().message();
            EXPECT_EQ(report->bytes, bytes_of(path("out")).size());
            EXPECT_EQ(report->levels, 1);
            EXPECT_TRUE(bytes_of(path("out")) == by_verbs(plain, container).value());
        }
    }
    pack_.encoding = Encoding::bc5;
    EXPECT_EQ(pack_file(plain, path("none.tga"), Container::tga, options_).error().message(),
              path("none.tga") + ": tga does not hold bc5-unorm");
    EXPECT_EQ(files(), 2u);
}

TEST_F(PackStream, LevelsOfAnExrStream) {
    const std::string mipped =
        write(pack(build_mip_chain(wavy_map({320, 190})).value(), {Encoding::half}).value(), Container::exr);
    pack_.encoding = Encoding::bc5;
    for (const bool builds : {false, true}) {
        options_.mip = builds ? std::optional(MipOptions()) : std::nullopt;
        const auto report = pack_file(mipped, path("out"), Container::dds, options_);
        ASSERT_TRUE(report) << report.error().message();
        EXPECT_EQ(report->levels, 9);
        EXPECT_TRUE(bytes_of(path("out")) == by_verbs(mipped, Container::dds).value());
    }
}

TEST_F(PackStream, DamageIsTheSameErrorAndLeavesNothing) {
    for (const Container kind : {Container::png, Container::exr}) {
        expect_same_damage(
            write_map({300, 200}, kind, default_encoding(kind)),
            [](const std::string& input) { return read_normals(input); },
            [&](const std::string& input, int threads) {
                return stream(input, Container::dds, threads, {2048, 0});
            });
    }
    // If a file is damaged, that error is reported first, whatever else is wrong.
    options_.level = 3;
    EXPECT_EQ(pack_file(path("cut"), path("out"), Container::dds, options_).error().code, ErrorCode::bad_data);
    EXPECT_EQ(files(), 4u);
}

TEST_F(PackStream, OptionsThatDoNotFitAreTheSameErrors) {
    const std::string input = write_map({20, 10}, Container::png, Encoding::rgb8);
    options_.source.unpack.swizzle = Swizzle{Component::z, Component::y, Component::other, Component::x};
    EXPECT_EQ(pack_file(input, path("out"), Container::dds, options_).error().message(),
              read_normals(input, options_.source).error().message());
    options_.source = {};
    options_.level = 2;
    EXPECT_EQ(pack_file(input, path("out"), Container::dds, options_).error().message(),
              input + ": has no level 2, only 1");
    EXPECT_EQ(pack_file(input, path("out"), Container::tga, options_).error().message(),
              input + ": has no level 2, only 1");
    Texture grey;
    grey.format = Format::r8_unorm;
    grey.levels.push_back({{4, 4}, Bytes(16)});
    const std::string one = write(grey, Container::png);
    options_.level.reset();
    EXPECT_EQ(pack_file(one, path("out"), Container::dds, options_).error().message(),
              read_normals(one).error().message());
    EXPECT_EQ(pack_file(path("none.png"), path("out"), Container::dds, options_).error().code, ErrorCode::io);
    EXPECT_EQ(files(), 1u);
}

TEST_F(PackStream, OutputsThatCannotBeWrittenAreErrors) {
    const std::string input = write_map({300, 200}, Container::dds, Encoding::bc5);
    for (const Container container : {Container::png, Container::exr, Container::ktx2}) {
        pack_.encoding = default_encoding(container);
        EXPECT_EQ(pack_file(input, path("none/out"), container, options_).error().message(),
                  path("none/out") + ": the directory does not exist");
        EXPECT_EQ(pack_file(input, "/dev/full", container, options_).error().message(),
                  "/dev/full: cannot be written: no space left on the disk");
    }
    pack_.encoding = Encoding::bc5;
    EXPECT_EQ(pack_file(input, path("out"), Container::png, options_).error().message(),
              path("out") + ": PNG holds 8 or 16 bits in one, three or four channels, not bc5-unorm");
    EXPECT_EQ(pack_file(input, path("out"), Container::exr, options_).error().message(),
              path("out") + ": EXR holds half and float, not bc5-unorm");
    EXPECT_EQ(files(), 1u);
}

TEST_F(PackStream, CancellingLeavesNothing) {
    const std::string input = write_map({200, 400}, Container::png, Encoding::rgb8);
    pack_.encoding = Encoding::rgb8;
    for (const Container container : {Container::dds, Container::png}) {
        for (const int threads : {1, 2}) {
            std::atomic<int> calls{0};
            const auto report = stream(input, container, threads, {2000, 0}, [&](double) { return ++calls < 10; });
            ASSERT_FALSE(report);
            EXPECT_EQ(report.error().code, ErrorCode::cancelled);
            EXPECT_EQ(calls, 10);
            EXPECT_EQ(files(), 1u);
        }
    }
}

}  // namespace
}  // namespace tex
