// SPDX-License-Identifier: Apache-2.0
// bake_file() and bake_stream() when something is wrong, or when they are cancelled.

#include <atomic>
#include <string>

#include "unit/pipeline_files.h"

namespace tex {
namespace {

class PipelineErrors : public Pipeline {};

TEST_F(PipelineErrors, DamageIsTheSameErrorAndLeavesNothing) {
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

TEST_F(PipelineErrors, HeightsThatCannotBeUsedAreTheSameErrors) {
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
            for (const Deband deband : {Deband::off, Deband::on}) {  // which takes all rows before any
                options_.heights.deband = deband;
                for (const int threads : {1, 2}) {
                    const auto failed = stream(input, container, threads, {64, 0});
                    EXPECT_EQ(failed.error().reason, height_field(image, options_.heights).error().reason);
                    EXPECT_EQ(failed.error().code, ErrorCode::bad_data);
                }
            }
        }
    }
    EXPECT_EQ(files(), 1u);
    options_.heights = {};
    options_.pack.encoding = PackOptions().encoding;
    options_.color.space = "nonsense";
    Image copy = read_image(input).value();
    EXPECT_EQ(bake_file(input, path("out"), Container::dds, options_).error().message(),
              to_linear(std::move(copy), options_.color).error().message());
    options_.color.space.clear();
    const std::string dot = write("dot.png", make_png({1, 1}));
    options_.heights.fill_invalid = true;
    options_.heights.no_data = read_image(dot).value().planes[0].at(0, 0);
    EXPECT_EQ(bake_file(dot, path("out"), Container::dds, options_).error().message(),
              height_field(read_image(dot).value(), options_.heights).error().message());
    options_.heights = {};
    const auto report = bake_file(input, path("out"), Container::dds, options_);
    const HeightReport counted = height_field(image, options_.heights)->report;
    EXPECT_EQ(report.value().heights.luma_texels, counted.luma_texels);
    EXPECT_GT(counted.luma_texels, 0);
}

TEST_F(PipelineErrors, OutputsThatCannotBeWrittenAreErrors) {
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

TEST_F(PipelineErrors, CancellingLeavesNothing) {
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
