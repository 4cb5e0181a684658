// SPDX-License-Identifier: Apache-2.0

#include <tex/pipeline.h>

#include <gtest/gtest.h>
#include <png.h>

#include <atomic>
#include <filesystem>
#include <random>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>
#include <half.h>

#include <tex/image_io.h>

#include "stream/bake_stream.h"
#include "unit/streams.h"

namespace tex {
namespace {

void append(png_structp png, png_bytep data, std::size_t count) {
    auto* bytes = static_cast<Bytes*>(png_get_io_ptr(png));
    const auto* from = reinterpret_cast<const std::byte*>(data);
    bytes->insert(bytes->end(), from, from + count);
}

struct Kind {
    int channels = 1;
    int bits = 8;
    bool interlaced = false;
};

// Bumps with noise.
Bytes make_png(Extent extent, const Kind& kind = {}, unsigned seed = 1) {
    constexpr int kColors[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGBA};
    Bytes bytes;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(png, &bytes, append, nullptr);
    png_set_compression_level(png, 1);
    png_set_IHDR(png, info, static_cast<png_uint_32>(extent.width), static_cast<png_uint_32>(extent.height), kind.bits,
                 kColors[kind.channels - 1], kind.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, 0, 0);
    png_write_info(png, info);
    std::mt19937 random(seed);
    std::vector<std::vector<png_byte>> rows;
    std::vector<png_bytep> pointers;
    for (int j = 0; j < extent.height; ++j) {
        std::vector<png_byte>& row = rows.emplace_back();
        for (int i = 0; i < extent.width * kind.channels; ++i) {
            const auto bump = static_cast<unsigned>(100.0 + 80.0 * std::sin(0.11 * i) * std::cos(0.07 * j));
            row.push_back(static_cast<png_byte>(bump + random() % 20));
            if (kind.bits == 16) row.push_back(static_cast<png_byte>(random()));
        }
    }
    for (std::vector<png_byte>& row : rows) pointers.push_back(row.data());
    png_write_image(png, pointers.data());
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return bytes;
}

class Pipeline : public StreamTest {
protected:
    Pipeline() {
        options_.write.sync = false;
        options_.pack.effort = Effort::fast;
    }

    // The picture, in linear values.
    [[nodiscard]] Image linear(const std::string& input) const {
        Image image = read_image(input).value();
        if (options_.color.space.empty()) return image;
        EXPECT_TRUE(to_linear(image, options_.color));
        return image;
    }

    // The result of calling the verbs on a picture one after the other.
    [[nodiscard]] Bytes by_verbs(const std::string& input, Container container, SlopeRange* slopes = nullptr) const {
        auto field = height_field(linear(input), options_.heights).value();
        const Strength strength = options_.strength ? options_.strength(field.height.extent()) : Strength();
        field.bumpiness_x = strength.x;
        field.bumpiness_y = strength.y;
        NormalMap normals = bake(field, options_.bake).value();
        if (slopes != nullptr) *slopes = slope_range(normals);
        const MipChain chain = build_mip_chain(std::move(normals), options_.mip).value();
        return encode_file(pack(chain, options_.pack).value(), container, options_.write).value();
    }

    // Streams a picture in small pieces.
    Result<BakeFileReport> stream(const std::string& input, Container container, int threads, const StreamSizes& sizes,
                                  std::function<bool(double)> progress = {}) const {
        Result<InputFile> file = InputFile::open(input);
        if (!file) return file.error();
        return bake_stream(*file, path("out"), container, options_, {threads, std::move(progress)}, sizes);
    }

    BakeFileOptions options_;
};

TEST_F(Pipeline, StreamsGiveTheBytesOfTheVerbs) {
    constexpr int kSides[] = {1, 2, 3, 4, 5, 7, 8, 13, 16, 17, 31, 40, 64, 97};
    std::mt19937 random(7);
    const auto one_in = [&](unsigned n) { return random() % n == 0; };
    for (int round = 0; round < 600; ++round) {
        const Extent extent{kSides[random() % 14], kSides[random() % 14]};
        options_.heights = {};
        options_.heights.wrap_x = any_of(kWrapNames, random);
        options_.heights.wrap_y = any_of(kWrapNames, random);
        options_.heights.invert = one_in(4);
        if (one_in(3)) options_.heights.blur_sigma = 0.3f + 0.4f * static_cast<float>(random() % 9);
        options_.bake.kernel = any_of(kGradientKernelNames, random);
        options_.bake.gaussian_sigma = 0.4f + 0.5f * static_cast<float>(random() % 6);
        options_.mip.filter = any_of(kMipFilterNames, random);
        options_.mip.domain = any_of(kMipDomainNames, random);
        options_.mip.levels = one_in(2) ? 0 : static_cast<int>(random() % 5);
        options_.mip.fade = one_in(3) ? std::optional<Fade>(Fade{1, 3}) : std::nullopt;
        options_.mip.wrap_x = one_in(4) ? any_of(kWrapNames, random) : options_.heights.wrap_x;
        options_.mip.wrap_y = one_in(4) ? any_of(kWrapNames, random) : options_.heights.wrap_y;
        options_.pack.encoding = any_of(kEncodingNames, random);
        options_.pack.y_axis = any_of(kYAxisNames, random);
        options_.pack.effort = one_in(8) ? any_of(kEffortNames, random) : Effort::fast;
        options_.write.dds_header = any_of(kDdsHeaderNames, random);
        options_.write.dds_mark = one_in(4);
        options_.slopes = true;
        options_.strength = [&](Extent its) { return Strength{6.0f, static_cast<float>(its.height) / 8.0f}; };
        const Kind kind{1 + static_cast<int>(random() % 4), one_in(2) ? 8 : 16};
        if (kind.channels >= 3) options_.heights.channel = any_of(kHeightChannelNames, random);
        if (kind.channels == 3 && options_.heights.channel == HeightChannel::a)
            options_.heights.channel = HeightChannel::b;
        if (options_.heights.channel == HeightChannel::y) options_.heights.channel = HeightChannel::max;
        constexpr Container kContainers[] = {Container::dds, Container::ktx2, Container::png, Container::exr};
        const Container container = kContainers[random() % 4];
        if (container == Container::png || container == Container::exr)
            options_.mip.levels = container == Container::exr && one_in(2) ? 0 : 1;  // EXR holds the base level or all
        while (!can_hold(container, options_.pack.encoding)) options_.pack.encoding = any_of(kEncodingNames, random);
        const std::string input = write("in.png", make_png(extent, kind, static_cast<unsigned>(random())));
        SlopeRange slopes;
        const Bytes expected = by_verbs(input, container, &slopes);
        const int strip_texels = 1 << (2 + random() % 10);
        const int threads = 1 + static_cast<int>(random() % 3);
        SCOPED_TRACE(testing::Message() << "round " << round << ", " << extent.width << "x" << extent.height);
        const auto report = stream(input, container, threads, {strip_texels, 0});
        ASSERT_TRUE(report) << report.error().message();
        ASSERT_TRUE(bytes_of(path("out")) == expected);
        EXPECT_EQ(report->extent, extent);
        EXPECT_EQ(report->bytes, expected.size());
        EXPECT_EQ(report->slopes.min_x, slopes.min_x);
        EXPECT_EQ(report->slopes.max_y, slopes.max_y);
    }
}

TEST_F(Pipeline, LargePicturesGoThroughManyStripsOnManyThreads) {
    options_.strength = [](Extent) { return Strength{5.0f, 5.0f}; };
    struct Case {
        Extent extent;
        Wrap wrap;
    };
    for (const auto& [extent, wrap] : {Case{{2048, 70}, Wrap::repeat}, Case{{131, 1100}, Wrap::clamp}}) {
        const std::string input = write("in.png", make_png(extent));
        options_.heights.wrap_x = options_.heights.wrap_y = options_.mip.wrap_x = options_.mip.wrap_y = wrap;
        const Bytes expected = by_verbs(input, Container::dds);
        for (const int threads : {1, 2, 5}) {
            const auto report = bake_file(input, path("out.dds"), Container::dds, options_, {threads, {}});
            ASSERT_TRUE(report) << report.error().message();
            EXPECT_TRUE(bytes_of(path("out.dds")) == expected) << extent.width << " " << threads;
        }
    }
}

// An interlaced PNG, heights that need filling and an output that the reader process encodes are held in memory. Colour
// spaces change each row.
TEST_F(Pipeline, StepsThatReachOverAllRowsGiveTheBytesOfTheVerbs) {
    std::mt19937 random(23);
    constexpr Container kContainers[] = {Container::tiff, Container::tga,  Container::jpeg, Container::bmp,
                                         Container::dds,  Container::ktx2, Container::png,  Container::exr};
    for (int round = 0; round < 80; ++round) {
        const Extent extent{1 + static_cast<int>(random() % 70), 1 + static_cast<int>(random() % 70)};
        SCOPED_TRACE(testing::Message() << "round " << round << ", " << extent.width << "x" << extent.height);
        options_.heights = {};
        options_.heights.wrap_x = any_of(kWrapNames, random);
        options_.heights.wrap_y = any_of(kWrapNames, random);
        options_.heights.invert = random() % 3 == 0;
        options_.heights.blur_sigma = random() % 3 == 0 ? 1.5f : 0.0f;
        options_.strength = [](Extent) { return Strength{6.0f, 4.0f}; };
        options_.color.space = random() % 2 == 0 ? "sRGB" : "";
        const Kind kind{1 + static_cast<int>(random() % 4), random() % 2 == 0 ? 8 : 16, random() % 2 == 0};
        const std::string input = write("in.png", make_png(extent, kind, static_cast<unsigned>(random())));
        if (random() % 2 == 0) {
            options_.heights.fill_invalid = true;
            options_.heights.no_data = linear(input).planes.front().at(extent.width / 2, extent.height / 3);
            if (!height_field(linear(input), options_.heights)) options_.heights.no_data.reset();  // no height is left
        }
        const Container container = kContainers[round % 8];
        options_.pack.encoding = default_encoding(container);
        options_.mip.levels = container == Container::dds || container == Container::ktx2 ? 0 : 1;
        const Bytes expected = by_verbs(input, container);
        const auto report = stream(input, container, 1 + round % 3, {1 << (2 + random() % 10), 0});
        ASSERT_TRUE(report) << report.error().message();
        ASSERT_TRUE(bytes_of(path("out")) == expected);
        EXPECT_EQ(report->bytes, expected.size());
        HeightReport counted;
        ASSERT_TRUE(height_field(linear(input), options_.heights, {}, &counted));
        EXPECT_EQ(report->heights.luma_texels, counted.luma_texels);
        EXPECT_EQ(report->heights.invalid_texels, counted.invalid_texels);
    }
}

TEST_F(Pipeline, HeightsInTexturesGiveTheBytesOfTheVerbs) {
    const HeightField field = height_field(read_image(write("in.png", make_png({45, 31}))).value(), {}).value();
    const MipChain chain = build_mip_chain(bake(field).value()).value();
    options_.heights.channel = HeightChannel::g;
    options_.heights.wrap_y = Wrap::repeat;
    for (const Encoding encoding : {Encoding::rgb8, Encoding::bc5, Encoding::float_}) {
        for (const Container kind : {Container::dds, Container::ktx2}) {
            const std::string input =
                write("in.texture", encode_file(pack(chain, {encoding}).value(), kind, options_.write).value());
            options_.pack.encoding = PackOptions().encoding;
            ASSERT_TRUE(stream(input, Container::dds, 2, {256, 0}));
            EXPECT_TRUE(bytes_of(path("out")) == by_verbs(input, Container::dds));
            options_.pack.encoding = Encoding::rgb8;
            ASSERT_TRUE(stream(input, Container::png, 2, {256, 0}));
            EXPECT_TRUE(bytes_of(path("out")) == by_verbs(input, Container::png));
        }
    }
}

TEST_F(Pipeline, NormalsInAnInterlacedPictureAreThoseOfAPlainOne) {
    PackFileOptions options;
    options.write.sync = false;
    options.mip = MipOptions();
    const auto packed = [&](const Kind& kind) {
        const auto report = pack_file(write("in.png", make_png({40, 30}, kind)), path("out"), Container::dds, options);
        EXPECT_TRUE(report) << report.error().message();
        return bytes_of(path("out"));
    };
    EXPECT_TRUE(packed({3, 8}) == packed({3, 8, true}));
    // Grey becomes R = G = B; alpha becomes A.
    EXPECT_TRUE(packed({2, 16}) == packed({2, 16, true}));
}

struct ExrKind {
    Imf::Compression compression = Imf::ZIP_COMPRESSION;
    Imf::PixelType type = Imf::HALF;
    Imf::LineOrder order = Imf::INCREASING_Y;
    int tile = 0;  // 0: scanlines
};

// Bumps, and another channel besides them. The data window begins anywhere.
void make_exr(const std::string& path, Extent extent, const ExrKind& kind) {
    const Imath::Box2i window(Imath::V2i(-3, 5), Imath::V2i(extent.width - 4, extent.height + 4));
    Imf::Header header(window, window);
    header.compression() = kind.compression;
    header.lineOrder() = kind.order;
    header.channels().insert("Y", Imf::Channel(kind.type));
    header.channels().insert("A", Imf::Channel(Imf::HALF));
    const auto count = static_cast<std::size_t>(extent.texels());
    std::vector<Imath::half> halves(count);
    std::vector<float> floats(count);
    std::vector<std::uint32_t> integers(count);
    for (std::size_t k = 0; k < count; ++k) {
        const auto i = static_cast<double>(k % static_cast<std::size_t>(extent.width));
        const auto j = static_cast<double>(k / static_cast<std::size_t>(extent.width));
        const double height = 0.5 + 0.4 * std::sin(0.3 * i) * std::cos(0.2 * j);
        halves[k] = Imath::half(static_cast<float>(height));
        floats[k] = static_cast<float>(height);
        integers[k] = static_cast<std::uint32_t>(height * 4e9);
    }
    const auto width = static_cast<std::size_t>(extent.width);
    const auto slice = [&](Imf::PixelType type, const void* data, std::size_t size) {
        return Imf::Slice::Make(type, data, window, size, size * width);
    };
    Imf::FrameBuffer buffer;
    buffer.insert("A", slice(Imf::HALF, halves.data(), 2));
    buffer.insert("Y", kind.type == Imf::HALF    ? slice(kind.type, halves.data(), 2)
                       : kind.type == Imf::FLOAT ? slice(kind.type, floats.data(), 4)
                                                 : slice(kind.type, integers.data(), 4));
    if (kind.tile == 0) {
        Imf::OutputFile file(path.c_str(), header, 0);
        file.setFrameBuffer(buffer);
        file.writePixels(extent.height);
        return;
    }
    header.setTileDescription(
        Imf::TileDescription(static_cast<unsigned>(kind.tile), static_cast<unsigned>(kind.tile), Imf::ONE_LEVEL));
    Imf::TiledOutputFile file(path.c_str(), header, 0);
    file.setFrameBuffer(buffer);
    file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
}

TEST_F(Pipeline, ExrStreamsWhateverItsRowsAreKeptIn) {
    const std::vector<ExrKind> kinds = {{},
                                        {Imf::NO_COMPRESSION},
                                        {Imf::ZIPS_COMPRESSION, Imf::FLOAT},
                                        {Imf::PIZ_COMPRESSION, Imf::UINT},
                                        {Imf::RLE_COMPRESSION},
                                        {Imf::PXR24_COMPRESSION, Imf::FLOAT},
                                        {Imf::B44_COMPRESSION},
                                        {Imf::DWAA_COMPRESSION},
                                        {Imf::DWAB_COMPRESSION},
                                        {Imf::ZIP_COMPRESSION, Imf::FLOAT, Imf::DECREASING_Y},
                                        {Imf::ZIP_COMPRESSION, Imf::HALF, Imf::INCREASING_Y, 16},
                                        {Imf::PIZ_COMPRESSION, Imf::FLOAT, Imf::RANDOM_Y, 32}};
    options_.strength = [](Extent) { return Strength{9.0f, 9.0f}; };
    for (const Extent extent : {Extent{37, 61}, Extent{5, 3}, Extent{64, 300}}) {
        for (const ExrKind& kind : kinds) {
            SCOPED_TRACE(testing::Message() << extent.width << "x" << extent.height << ", " << kind.compression);
            make_exr(path("in.exr"), extent, kind);
            const Bytes expected = by_verbs(path("in.exr"), Container::dds);
            for (const int threads : {1, 3}) {
                const auto report = stream(path("in.exr"), Container::dds, threads, {256, 0});
                ASSERT_TRUE(report) << report.error().message();
                EXPECT_TRUE(bytes_of(path("out")) == expected);
            }
            ASSERT_TRUE(bake_file(path("in.exr"), path("out"), Container::dds, options_));
            options_.mip.levels = 1;
            options_.pack.encoding = Encoding::rgb8;
            ASSERT_TRUE(stream(path("in.exr"), Container::png, 3, {256, 0}));
            EXPECT_TRUE(bytes_of(path("out")) == by_verbs(path("in.exr"), Container::png));
            options_.mip = {};
            options_.pack.encoding = PackOptions().encoding;
            options_.heights.fill_invalid = true;
            ASSERT_TRUE(bake_file(path("in.exr"), path("out"), Container::dds, options_));
            EXPECT_TRUE(bytes_of(path("out")) == expected);
            options_.heights.fill_invalid = false;
        }
    }
}

TEST_F(Pipeline, DamageIsTheSameErrorAndLeavesNothing) {
    make_exr(path("in.exr"), {200, 300}, {});
    for (const std::string& sound : {path("in.exr"), write("in.png", make_png({300, 500}, {1, 16})),
                                     write("interlaced.png", make_png({300, 500}, {1, 16, true}))}) {
        for (const Container container : {Container::dds, Container::png, Container::tiff}) {
            options_.heights.fill_invalid = container == Container::tiff;
            expect_same_damage(
                sound, [](const std::string& input) { return read_image(input); },
                [&](const std::string& input, int threads) {
                    options_.pack.encoding = default_encoding(container);
                    return stream(input, container, threads, {2048, 0});
                });
        }
    }
    EXPECT_EQ(files(), 5u);
    // If a picture is damaged, that error is reported first, whatever else is wrong.
    options_.pack.encoding = PackOptions().encoding;
    options_.color.space = "nonsense";
    EXPECT_EQ(bake_file(path("cut"), path("out"), Container::dds, options_).error().code, ErrorCode::bad_data);
    options_.color.space.clear();
    options_.heights.channel = HeightChannel::a;
    EXPECT_EQ(bake_file(path("cut"), path("out"), Container::dds, options_).error().code, ErrorCode::bad_data);
}

TEST_F(Pipeline, HeightsThatCannotBeUsedAreTheSameErrors) {
    const std::string input = write("in.png", make_png({64, 50}, {3, 8}));
    const Image image = read_image(input).value();
    options_.heights.channel = HeightChannel::a;
    EXPECT_EQ(bake_file(input, path("out"), Container::dds, options_).error().message(),
              height_field(image, options_.heights).error().message());
    options_.heights.channel = HeightChannel::r;
    for (const Container container : {Container::dds, Container::png}) {
        options_.pack.encoding = default_encoding(container);
        for (const int row : {31, 0, 49}) {
            options_.heights.no_data = image.planes[0].at(7, row);
            for (const int threads : {1, 2}) {
                EXPECT_EQ(stream(input, container, threads, {64, 0}).error().message(),
                          height_field(image, options_.heights).error().message());
            }
        }
    }
    EXPECT_EQ(files(), 1u);
    options_.heights = {};
    options_.pack.encoding = PackOptions().encoding;
    options_.color.space = "nonsense";
    Image copy = read_image(input).value();
    EXPECT_EQ(bake_file(input, path("out"), Container::dds, options_).error().message(),
              to_linear(copy, options_.color).error().message());
    options_.color.space.clear();
    const std::string dot = write("dot.png", make_png({1, 1}));
    options_.heights.fill_invalid = true;
    options_.heights.no_data = read_image(dot).value().planes[0].at(0, 0);
    EXPECT_EQ(bake_file(dot, path("out"), Container::dds, options_).error().message(),
              height_field(read_image(dot).value(), options_.heights).error().message());
    options_.heights = {};
    const auto report = bake_file(input, path("out"), Container::dds, options_);
    HeightReport counted;
    ASSERT_TRUE(height_field(image, options_.heights, {}, &counted));
    EXPECT_EQ(report.value().heights.luma_texels, counted.luma_texels);
    EXPECT_GT(counted.luma_texels, 0);
}

TEST_F(Pipeline, OutputsThatCannotBeWrittenAreErrors) {
    const std::string input = write("in.png", make_png({64, 50}));
    const auto missing = bake_file(input, path("none/out.dds"), Container::dds, options_);
    EXPECT_EQ(missing.error().code, ErrorCode::io);
    EXPECT_EQ(missing.error().message(), path("none/out.dds") + ": the directory does not exist");
    EXPECT_EQ(bake_file(input, "/dev/full", Container::dds, options_).error().reason,
              "cannot be written: no space left on the disk");
    options_.write.no_clobber = true;
    ASSERT_TRUE(bake_file(input, path("out"), Container::dds, options_));
    EXPECT_EQ(bake_file(input, path("out"), Container::dds, options_).error().reason, "exists already");
    EXPECT_EQ(files(), 2u);
    options_.write.no_clobber = false;
    options_.pack.encoding = Encoding::half;
    options_.mip.levels = 2;
    EXPECT_EQ(bake_file(input, path("out.exr"), Container::exr, options_).error().message(),
              path("out.exr") + ": EXR holds the base level or all 7 mip levels, not 2");
    EXPECT_EQ(files(), 2u);
    EXPECT_EQ(bake_file(path("nothing.png"), path("out"), Container::dds, options_).error().code, ErrorCode::io);
}

TEST_F(Pipeline, CancellingLeavesNothing) {
    const std::string input = write("in.png", make_png({200, 400}));
    for (const int threads : {1, 2}) {
        std::atomic<int> calls{0};
        double last = 0.0;
        const auto report = stream(input, Container::dds, threads, {2000, 0}, [&](double fraction) {
            EXPECT_GE(fraction, last);
            last = fraction;
            return ++calls < 10;
        });
        ASSERT_FALSE(report);
        EXPECT_EQ(report.error().code, ErrorCode::cancelled);
        EXPECT_EQ(calls, 10);
        EXPECT_EQ(files(), 1u);
    }
    // Cancels while heights are read, filled and used.
    options_.heights.fill_invalid = true;
    options_.heights.no_data = read_image(input).value().planes[0].at(3, 5);
    for (const int most : {10, 401, 405}) {
        int calls = 0;
        double last = 0.0;
        EXPECT_EQ(stream(input, Container::dds, 1, {2000, 0},
                         [&](double fraction) {
                             EXPECT_GE(fraction, last);
                             last = fraction;
                             return ++calls < most;
                         })
                      .error()
                      .code,
                  ErrorCode::cancelled);
        EXPECT_EQ(calls, most);
        EXPECT_EQ(files(), 1u);
    }
    options_.heights = {};
    // Cancels while the last rows are searched for, and after that.
    options_.pack.encoding = default_encoding(Container::png);
    for (const int most : {10, 404}) {
        int calls = 0;
        EXPECT_EQ(stream(input, Container::png, 1, {2000, 0}, [&](double) { return ++calls < most; }).error().code,
                  ErrorCode::cancelled);
        EXPECT_EQ(calls, most);
        EXPECT_EQ(files(), 1u);
    }
}

}  // namespace
}  // namespace tex
