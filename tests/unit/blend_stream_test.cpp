// SPDX-License-Identifier: Apache-2.0

#include "stream/blend_stream.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <utility>

#include "stream/blend_stage.h"
#include "unit/normal_maps.h"
#include "unit/streams.h"

namespace tex {
namespace {

constexpr int kSides[] = {1, 2, 3, 4, 5, 7, 8, 13, 16, 17, 31, 40, 64, 97};

class BlendStream : public StreamTest {
protected:
    BlendStream() {
        options_.write.sync = false;
        options_.pack = [this](const SourceInfo& info) {
            PackOptions pack = pack_;
            if (!y_) pack.y_axis = info.y_axis;
            return pack;
        };
    }

    using StreamTest::write;
    [[nodiscard]] std::string write_map(const std::string& name, const NormalMap& map, Container kind,
                                        Encoding encoding, int levels = 1) const {
        MipOptions mip;
        mip.levels = levels;
        const MipChain chain = build_mip_chain(copy_of(map), mip).value();
        const Texture texture = pack(chain, {encoding, YAxis::down, Effort::fast}).value();
        return write(name, encode_file(texture, kind, options_.write).value());
    }

    // Writes a random map to a file of a random type.
    [[nodiscard]] std::string draw_map(const std::string& name, Extent extent, std::mt19937& random) const {
        constexpr std::pair<Container, Encoding> kFiles[] = {
            {Container::png, Encoding::rgb8}, {Container::png, Encoding::rgba8},  {Container::png, Encoding::ag8},
            {Container::exr, Encoding::half}, {Container::exr, Encoding::float_}, {Container::dds, Encoding::dxt5nm},
            {Container::dds, Encoding::bc5},  {Container::ktx2, Encoding::rgb8},  {Container::png, Encoding::rgb16},
        };
        const auto& [kind, encoding] = kFiles[random() % std::size(kFiles)];
        const int levels = can_hold_levels(kind) && random() % 2 == 0 ? 0 : 1;
        return write_map(name, wavy_map(extent, static_cast<double>(random() % 100)), kind, encoding, levels);
    }

    void draw_layer(Extent result, std::mt19937& random) {
        const auto one_in = [&](unsigned n) { return random() % n == 0; };
        const auto step = [&](unsigned n, float size) { return size * static_cast<float>(random() % n); };
        LayerFile& layer = options_.layers.emplace_back();
        const Extent extent = one_in(3) ? Extent{kSides[random() % 14], kSides[random() % 14]} : result;
        layer.input = draw_map("detail" + std::to_string(options_.layers.size()), extent, random);
        layer.source.file_y_first = one_in(2);
        if (one_in(3)) layer.scale = step(7, 0.5f) - 1.0f;
        if (one_in(4)) layer.tiling_x = 0.25f + step(12, 0.25f);
        if (one_in(4)) layer.tiling_y = 0.25f + step(12, 0.25f);
        if (one_in(3)) layer.offset_x = step(9, 0.125f) - 0.5f;
        if (one_in(5)) layer.offset_y = step(9, 0.125f) - 0.5f;
        if (one_in(5)) layer.rotation = step(36, 10.0f);
        if (one_in(3)) layer.strength = step(5, 0.25f);
        layer.wrap_x = any_of(kWrapNames, random);
        layer.wrap_y = any_of(kWrapNames, random);
        if (!one_in(3)) return;
        layer.mask = [side = kSides[random() % 14]]() -> Result<Plane<float>> {
            Plane<float> mask(Extent{side, 3});
            for (int j = 0; j < 3; ++j) {
                for (int i = 0; i < side; ++i) mask.at(i, j) = static_cast<float>((3 * i + j) % 5) / 4.0f;
            }
            return mask;
        };
    }

    void draw_options(std::mt19937& random) {
        const auto one_in = [&](unsigned n) { return random() % n == 0; };
        options_.source.unpack.snap_flat = one_in(3);
        options_.source.unpack.keep_length = one_in(3);
        options_.blend.mode = any_of(kBlendModeNames, random);
        options_.blend.scale_mode = any_of(kScaleModeNames, random);
        options_.blend.base_scale = one_in(3) ? 1.5f : 1.0f;
        options_.blend.extent = one_in(4) ? Extent{kSides[random() % 14], kSides[random() % 14]} : Extent{};
        options_.blend.wrap_x = options_.mip.wrap_x = any_of(kWrapNames, random);
        options_.blend.wrap_y = options_.mip.wrap_y = any_of(kWrapNames, random);
        options_.mip.filter = any_of(kMipFilterNames, random);
        options_.mip.max_side = one_in(3) ? 1 << (random() % 7) : 0;
        options_.mip.levels = one_in(2) ? 0 : static_cast<int>(random() % 5);
        y_ = one_in(2);
        pack_.y_axis = any_of(kYAxisNames, random);
        pack_.effort = Effort::fast;
    }

    [[nodiscard]] Result<Bytes> by_verbs(const std::string& input, Container container) const {
        Result<Source> base = read_normals(input, options_.source);
        if (!base) return base.error();
        std::vector<Layer> layers;
        for (const LayerFile& file : options_.layers) {
            Result<Source> detail = read_normals(file.input, file.source);
            if (!detail) return detail.error();
            Layer layer = file.layer();
            layer.detail = std::move(detail->chain);
            if (file.mask) layer.mask = file.mask().value();
            layers.push_back(std::move(layer));
        }
        NormalMap blended = blend(std::move(base->chain), std::move(layers), options_.blend).value();
        MipOptions mip = options_.mip;
        if (!can_hold_levels(container)) mip.levels = 1;
        const MipChain chain = build_mip_chain(std::move(blended), mip).value();
        return encode_file(pack(chain, options_.pack(base->info)).value(), container, options_.write);
    }

    Result<BlendFileReport> stream(const std::string& input, Container container, int threads,
                                   const StreamSizes& sizes = {}) const {
        return blend_stream(input, path("out"), container, options_, {threads, {}}, sizes);
    }

    BlendFileOptions options_;
    PackOptions pack_;
    bool y_ = false;  // pack_.y_axis applies
};

TEST_F(BlendStream, GivesTheBytesOfTheVerbs) {
    constexpr std::pair<Container, Encoding> kTargets[] = {
        {Container::dds, Encoding::dxt5nm}, {Container::ktx2, Encoding::bc5}, {Container::dds, Encoding::half},
        {Container::exr, Encoding::float_}, {Container::png, Encoding::rgb8},
    };
    std::mt19937 random(17);
    for (int round = 0; round < 300; ++round) {
        options_.layers.clear();
        draw_options(random);
        const Extent extent{kSides[random() % 14], kSides[random() % 14]};
        const std::string input = draw_map("base", extent, random);
        const Extent result = options_.blend.extent == Extent{} ? extent : options_.blend.extent;
        for (unsigned k = 0, layers = 1 + random() % 2; k < layers; ++k) draw_layer(result, random);
        const auto& [container, encoding] = kTargets[random() % std::size(kTargets)];
        pack_.encoding = encoding;
        if (container == Container::exr) options_.mip.levels %= 2;  // all levels, or one
        const Result<Bytes> expected = by_verbs(input, container);
        ASSERT_TRUE(expected) << round << " " << expected.error().message();
        StreamSizes sizes;
        sizes.strip_texels = 1 << (random() % 12);
        sizes.worth_threads = random() % 2 == 0 ? 0 : sizes.worth_threads;
        const auto report = stream(input, container, 1 + static_cast<int>(random() % 3), sizes);
        ASSERT_TRUE(report) << round << " " << report.error().message();
        EXPECT_EQ(report->extent, read_texture(path("out"))->extent());
        EXPECT_EQ(report->details.size(), options_.layers.size());
        EXPECT_EQ(report->bytes, expected->size());
        ASSERT_TRUE(bytes_of(path("out")) == *expected) << round;
    }
}

TEST_F(BlendStream, FilesThatAreEncodedAsAWholeHoldTheSameTexels) {
    const std::string base = write_map("base", wavy_map({40, 31}), Container::png, Encoding::rgb8);
    options_.layers.push_back({write_map("detail", wavy_map({40, 31}, 2.0), Container::png, Encoding::rgb8), {}});
    pack_.encoding = Encoding::rgb8;
    const auto report = stream(base, Container::tga, 2);
    ASSERT_TRUE(report) << report.error().message();
    EXPECT_TRUE(bytes_of(path("out")) == by_verbs(base, Container::tga).value());
    EXPECT_EQ(report->bytes, std::filesystem::file_size(path("out")));
}

TEST_F(BlendStream, ALayoutThatTheTexelsTellIsFoundInEveryMap) {
    const std::string base = write_map("base", wavy_map({33, 40}), Container::png, Encoding::ag8);
    options_.layers.push_back({write_map("detail", wavy_map({33, 40}, 2.0), Container::png, Encoding::ag8), {}});
    options_.layers.push_back({write_map("more", wavy_map({33, 40}, 4.0), Container::png, Encoding::rgba8), {}});
    pack_.encoding = Encoding::rgb8;
    const auto report = stream(base, Container::png, 2);
    ASSERT_TRUE(report) << report.error().message();
    EXPECT_TRUE(bytes_of(path("out")) == by_verbs(base, Container::png).value());
    EXPECT_EQ(report->source.swizzle[3], Component::x);
    EXPECT_EQ(report->details.at(0).swizzle[3], Component::x);
    EXPECT_NE(report->details.at(1).swizzle[3], Component::x);
}

TEST_F(BlendStream, ErrorsNameTheFileThatIsWrong) {
    const std::string base = write_map("base", wavy_map({97, 97}), Container::png, Encoding::rgb8);
    const std::string detail = write_map("detail", wavy_map({97, 97}, 2.0), Container::png, Encoding::rgb8);
    Bytes bytes = bytes_of(detail);
    bytes[bytes.size() / 2] ^= std::byte{0x5a};
    const std::string hurt = write("hurt", bytes);
    const std::string cut =
        write("cut", Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() / 3)));
    pack_.encoding = Encoding::rgb8;
    for (const std::string& wrong : {hurt, cut, path("missing")}) {
        for (const float tiling : {1.0f, 2.0f}) {
            options_.layers = {{wrong, {}, 1.0f, tiling, tiling}};
            const auto report = stream(base, Container::png, 2);
            ASSERT_FALSE(report);
            EXPECT_EQ(report.error().message(), read_normals(wrong).error().message());
            options_.layers = {{detail, {}, 1.0f, tiling, tiling}};
            const auto other = stream(wrong, Container::png, 2);
            ASSERT_FALSE(other);
            EXPECT_EQ(other.error().message(), read_normals(wrong).error().message());
            EXPECT_FALSE(std::filesystem::exists(path("out")));
        }
    }
    options_.layers.front().mask = [] { return Result<Plane<float>>(Error{ErrorCode::io, "mask", "is not there"}); };
    EXPECT_EQ(stream(base, Container::png, 2).error().message(), "mask: is not there");
}

TEST(RowsInStep, AreThoseOfMapsThatLieTexelOnTexelFromTopToBottom) {
    const Extent extent{40, 30};
    const auto in_step = [&](const Layer& layer, Extent source) {
        return rows_in_step(source, extent, uv_map_of(layer, extent), layer.wrap_x, layer.wrap_y).has_value();
    };
    Layer layer;
    EXPECT_TRUE(in_step(layer, extent));
    EXPECT_FALSE(in_step(layer, {40, 31}));
    layer.offset_x = 0.3f;
    EXPECT_TRUE(in_step(layer, extent));
    layer.offset_y = 0.5f;
    EXPECT_FALSE(in_step(layer, extent));
    layer.offset_y = 0.0f;
    layer.tiling_x = 2.0f;
    EXPECT_FALSE(in_step(layer, extent));
    layer.tiling_x = 1.0f;
    layer.rotation = 90.0f;
    EXPECT_FALSE(in_step(layer, extent));
}

}  // namespace
}  // namespace tex
