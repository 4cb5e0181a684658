// SPDX-License-Identifier: Apache-2.0
// Steps that are joined make the bytes that they make one after the other, with float EXR files in between.

#include <tex/pipeline.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "unit/streams.h"

namespace tex {
namespace {

const std::string kSamples = std::string(TEX_SOURCE_DIR) + "/samples/";

BakeFileOptions bakes(Wrap wrap) {
    BakeFileOptions options;
    options.heights.wrap_x = options.heights.wrap_y = wrap;
    options.strength = [](Extent) { return Strength{9.0f, 9.0f}; };
    options.heights.blur_sigma = 1.5f;
    options.mip.levels = 1;
    options.pack.encoding = Encoding::float_;
    options.write.sync = false;
    return options;
}

PackFileOptions scales(float scale) {
    PackFileOptions options;
    options.scale = Scaling{scale, ScaleMode::slope};
    options.pack = [](const SourceInfo& source) { return PackOptions{Encoding::float_, source.y_axis}; };
    options.write.sync = false;
    return options;
}

BlendFileOptions blends(const std::string& detail, float tiling) {
    BlendFileOptions options;
    LayerFile& layer = options.layers.emplace_back();
    layer.input = detail;
    layer.tiling_x = layer.tiling_y = tiling;
    options.mip.levels = 1;
    options.pack = [](const SourceInfo& source) { return PackOptions{Encoding::float_, source.y_axis}; };
    options.write.sync = false;
    return options;
}

PackFileOptions mips(Encoding encoding, YAxis y) {
    PackFileOptions options;
    options.mip = MipOptions();
    options.mip->filter = MipFilter::kaiser;
    options.pack = [=](const SourceInfo&) { return PackOptions{encoding, y}; };
    options.write.sync = false;
    return options;
}

}  // namespace

class Steps : public StreamTest {
protected:
    // Runs the steps one after the other with files in between, then joined, and compares the outputs.
    void expect_same(const std::string& input, const std::vector<Step>& steps, const std::string& extension) {
        std::string from = input;
        for (std::size_t k = 0; k < steps.size(); ++k) {
            const bool is_last = k + 1 == steps.size();
            const std::string to = path(is_last ? "apart" + extension : "step" + std::to_string(k) + ".exr");
            const auto done = apply_steps(from, {steps[k]}, to, *container_of(to));
            ASSERT_TRUE(done) << done.error().message();
            from = to;
        }
        for (const int threads : {1, 2, 5}) {
            const std::string to = path("joined" + extension);
            const auto done = apply_steps(input, steps, to, *container_of(to), {threads, {}});
            ASSERT_TRUE(done) << done.error().message();
            EXPECT_TRUE(bytes_of(to) == bytes_of(from)) << extension << ", " << threads << " threads";
        }
    }
    // A normal map that does not say how it is stored.
    [[nodiscard]] std::string detail() {
        BakeFileOptions options = bakes(Wrap::repeat);
        options.mip.levels = 0;
        options.pack.encoding = Encoding::dxt5nm;
        options.pack.y_axis = YAxis::down;
        const auto done = bake_file(kSamples + "waves.png", path("detail.dds"), Container::dds, options);
        EXPECT_TRUE(done);
        return path("detail.dds");
    }
};

TEST_F(Steps, JoinedMakeTheSameBytesAsFilesInBetween) {
    const std::string noise = detail();
    for (const Wrap wrap : {Wrap::repeat, Wrap::clamp}) {
        for (const std::string extension : {".dds", ".png", ".exr"}) {
            const Encoding encoding = extension == ".dds"   ? Encoding::bc5
                                      : extension == ".png" ? Encoding::rgb16
                                                            : Encoding::half;
            expect_same(kSamples + "bricks.png", {bakes(wrap), mips(encoding, YAxis::down)}, extension);
            expect_same(kSamples + "bricks.png",
                        {bakes(wrap), scales(0.7f), blends(noise, 3.0f), mips(encoding, YAxis::up)}, extension);
        }
        expect_same(kSamples + "bricks.png", {bakes(wrap), blends(noise, 1.0f), blends(noise, 0.5f)}, ".exr");
    }
}

TEST_F(Steps, MapsKeepTheirLevelsAndTheirDirectionOfY) {
    const std::string map = detail();
    expect_same(map, {scales(2.0f), scales(-0.3f)}, ".exr");
    PackFileOptions level = scales(1.5f);
    level.level = 1;
    expect_same(map, {level, scales(0.5f)}, ".exr");
    expect_same(map, {blends(map, 1.0f), scales(0.5f), mips(Encoding::dxt5nm, YAxis::down)}, ".dds");
}

TEST_F(Steps, SeveralFilesComeFromOneReading) {
    std::vector<Step> steps = {bakes(Wrap::repeat), mips(Encoding::dxt5nm, YAxis::up)};
    expect_same(kSamples + "ramp.png", {bakes(Wrap::repeat), mips(Encoding::rgb8, YAxis::down)}, ".png");
    const auto png = bytes_of(path("apart.png"));
    expect_same(kSamples + "ramp.png", steps, ".dds");
    const auto dds = bytes_of(path("apart.dds"));
    auto& last = std::get<PackFileOptions>(steps.back());
    MoreFile& more = last.more.emplace_back();
    more.output = path("more.png");
    more.container = Container::png;
    more.pack = [](const SourceInfo&) { return PackOptions{Encoding::rgb8, YAxis::down}; };
    MoreFile& small = last.more.emplace_back();
    small.output = path("small.exr");
    small.container = Container::exr;
    small.levels = 1;
    const auto done = apply_steps(kSamples + "ramp.png", steps, path("both.dds"), Container::dds);
    ASSERT_TRUE(done) << done.error().message();
    EXPECT_TRUE(bytes_of(path("both.dds")) == dds);
    EXPECT_TRUE(bytes_of(path("more.png")) == png);
    const auto read_back = read_texture(path("small.exr"));
    ASSERT_TRUE(read_back);
    EXPECT_EQ(read_back->levels.size(), 1u);
}

// Strips have whole rows of the blocks of all files: 4, 5 and 6 texels high.
TEST_F(Steps, FilesWithOtherBlocksComeFromOneReading) {
    struct Other {
        Encoding encoding;
        Container container;
        const char* extension;
    };
    const Other others[] = {{Encoding::astc_5x5, Container::ktx2, ".ktx2"},
                            {Encoding::astc_8x6, Container::astc, ".astc"}};
    const auto fast = [](Encoding encoding) {
        return [encoding](const SourceInfo&) { return PackOptions{encoding, YAxis::up, Effort::fast}; };
    };
    std::vector<Step> steps = {bakes(Wrap::mirror), mips(Encoding::dxt5nm, YAxis::up)};
    auto& last = std::get<PackFileOptions>(steps.back());
    for (const auto& [encoding, container, extension] : others) {
        last.pack = fast(encoding);
        const std::string alone = path(std::string("alone") + extension);
        ASSERT_TRUE(apply_steps(kSamples + "waves.png", steps, alone, container));
    }
    for (const auto& [encoding, container, extension] : others)
        last.more.push_back({path(std::string("more") + extension), {}, container, 0, fast(encoding), {}});
    last.pack = fast(Encoding::dxt5nm);
    for (const int threads : {1, 3}) {
        const auto done = apply_steps(kSamples + "waves.png", steps, path("x.dds"), Container::dds, {threads, {}});
        ASSERT_TRUE(done) << done.error().message();
        for (const char* extension : {".ktx2", ".astc"}) {
            EXPECT_TRUE(bytes_of(path(std::string("more") + extension)) ==
                        bytes_of(path(std::string("alone") + extension)))
                << extension;
        }
    }
}

TEST_F(Steps, ErrorsNameTheFileAndLeaveNothing) {
    const auto missing =
        apply_steps(path("none.png"), {bakes(Wrap::clamp), scales(2.0f)}, path("a.dds"), Container::dds);
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::io);
    EXPECT_EQ(missing.error().file, path("none.png"));
    const auto blended = apply_steps(kSamples + "ramp.png", {bakes(Wrap::clamp), blends(path("none.dds"), 2.0f)},
                                     path("a.dds"), Container::dds);
    ASSERT_FALSE(blended);
    EXPECT_EQ(blended.error().file, path("none.dds"));
    PackFileOptions level = scales(1.0f);
    level.level = 99;
    const auto deep = apply_steps(detail(), {level, scales(2.0f)}, path("a.dds"), Container::dds);
    ASSERT_FALSE(deep);
    EXPECT_EQ(deep.error().code, ErrorCode::bad_option);
    EXPECT_EQ(files(), 1u);  // the detail
}

}  // namespace tex
