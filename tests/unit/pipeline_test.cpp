// SPDX-License-Identifier: Apache-2.0

#include "unit/pipeline_files.h"

namespace tex {
namespace {

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
        options_.mip.max_side = one_in(3) ? 1 << (random() % 7) : 0;
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
        const bool is_made = options_.heights.channel >= HeightChannel::terrain_rgb;  // of bytes
        if (is_made && kind.bits != 8) options_.heights.channel = HeightChannel::luma;
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
        EXPECT_EQ(report->extent, read_texture(path("out"))->extent());
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
        options_.heights.deband = any_of(kDebandNames, random);
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
        const HeightReport counted = height_field(linear(input), options_.heights)->report;
        EXPECT_EQ(report->heights.luma_texels, counted.luma_texels);
        EXPECT_EQ(report->heights.invalid_texels, counted.invalid_texels);
        EXPECT_EQ(report->heights.deband.applied, counted.deband.applied);
        EXPECT_EQ(report->heights.deband.terrace_texels, counted.deband.terrace_texels);
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

}  // namespace
}  // namespace tex
