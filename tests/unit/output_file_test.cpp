// SPDX-License-Identifier: Apache-2.0
// Separate files for each level, and files of roughness, written from streams.

#include "files/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include <tex/file.h>

#include "stream/bake_stream.h"
#include "stream/pack_stream.h"
#include "unit/normal_maps.h"
#include "unit/streams.h"

namespace tex {
namespace {

constexpr Container kContainers[] = {Container::dds, Container::ktx2, Container::png, Container::exr};
constexpr int kSides[] = {1, 2, 3, 5, 8, 13, 16, 31, 40, 64, 97};

class OutputFiles : public StreamTest {
protected:
    OutputFiles() {
        names_ = [this](int level) { return path("out" + std::to_string(level)); };
        bake_.write.sync = pack_.write.sync = false;
        bake_.strength = [](Extent) { return Strength{7.0f, 5.0f}; };
    }

    [[nodiscard]] std::string write_map(Extent extent, int levels, Container container) const {
        MipOptions mip;
        mip.levels = levels;
        const MipChain chain = build_mip_chain(wavy_map(extent), mip).value();
        return write("in",
                     encode_file(pack(chain, {Encoding::rgb8, YAxis::up, Effort::fast}).value(), container).value());
    }
    void draw(std::mt19937& random, Container container) {
        MipOptions& mip = bake_.mip;
        mip.filter = any_of(kMipFilterNames, random);
        mip.domain = any_of(kMipDomainNames, random);
        mip.levels = static_cast<int>(random() % 4);
        mip.wrap_x = bake_.heights.wrap_x = any_of(kWrapNames, random);
        mip.wrap_y = bake_.heights.wrap_y = any_of(kWrapNames, random);
        packing_.effort = Effort::fast;
        do {
            packing_.encoding = any_of(kEncodingNames, random);
        } while (!can_hold(container, packing_.encoding));
        bake_.pack = packing_;
        pack_.pack = [this](const SourceInfo&) { return packing_; };
        bake_.level_names = pack_.level_names = names_;
    }
    // Expects that each level of `chain` has its own file and that there are no other files.
    void expect_files(const MipChain& chain, Container container, std::size_t bytes) const {
        Texture texture = pack(chain, packing_).value();
        const std::vector<Level> levels = std::exchange(texture.levels, {});
        for (std::size_t k = 0; k < levels.size(); ++k) {
            texture.levels = {levels[k]};
            const Bytes expected = encode_file(texture, container, bake_.write).value();
            bytes -= expected.size();
            ASSERT_TRUE(bytes_of(names_(static_cast<int>(k))) == expected) << k;
        }
        EXPECT_EQ(bytes, 0u);
        EXPECT_EQ(files(), levels.size() + 1);
    }
    void remove_outputs() const {
        for (int k = 0; k < 20; ++k) std::filesystem::remove(names_(k));
    }

    std::function<std::string(int)> names_;
    BakeFileOptions bake_;
    PackFileOptions pack_;
    PackOptions packing_;
};

TEST_F(OutputFiles, LevelsOfBakedMapsHaveTheBytesOfTheVerbs) {
    std::mt19937 random(5);
    for (int round = 0; round < 200; ++round) {
        const Extent extent{kSides[random() % 11], kSides[random() % 11]};
        const Container container = kContainers[round % 4];
        SCOPED_TRACE(testing::Message() << "round " << round << ", " << extent.width << "x" << extent.height);
        draw(random, container);
        const std::string input = write_map(extent, 1, Container::png);
        auto field = height_field(read_image(input).value(), bake_.heights).value();
        field.bumpiness_x = 7.0f;
        field.bumpiness_y = 5.0f;
        const MipChain chain = build_mip_chain(bake(field).value(), bake_.mip).value();

        Result<InputFile> file = InputFile::open(input);
        const StreamSizes sizes{1 << (2 + random() % 10), 0};
        const auto report = bake_stream(*file, "", container, bake_, {1 + static_cast<int>(random() % 3), {}}, sizes);
        ASSERT_TRUE(report) << report.error().message();
        EXPECT_EQ(report->levels, static_cast<int>(chain.levels.size()));
        expect_files(chain, container, report->bytes);
        remove_outputs();
        bake_.heights.fill_invalid = true;
        const auto filled = bake_file(input, "", container, bake_);
        bake_.heights.fill_invalid = false;
        ASSERT_TRUE(filled) << filled.error().message();
        expect_files(chain, container, filled->bytes);
        remove_outputs();
    }
}

TEST_F(OutputFiles, LevelsOfRepackedMapsHaveTheBytesOfTheVerbs) {
    std::mt19937 random(6);
    for (int round = 0; round < 200; ++round) {
        const Extent extent{kSides[random() % 11], kSides[random() % 11]};
        const Container container = kContainers[round % 4];
        SCOPED_TRACE(testing::Message() << "round " << round << ", " << extent.width << "x" << extent.height);
        draw(random, container);
        pack_.mip = random() % 2 == 0 ? std::optional(bake_.mip) : std::nullopt;  // else the file's own levels
        const std::string input = write_map(extent, pack_.mip ? 1 : static_cast<int>(random() % 4),
                                            random() % 2 == 0 ? Container::ktx2 : Container::dds);
        MipChain chain = read_normals(input).value().chain;
        if (pack_.mip) {
            chain.levels.resize(1);
            chain = build_mip_chain(std::move(chain.levels.front()), *pack_.mip).value();
        }
        Result<InputFile> file = InputFile::open(input);
        const StreamSizes sizes{1 << (2 + random() % 10), 0};
        const auto report = pack_stream(*file, "", container, pack_, {1 + static_cast<int>(random() % 3), {}}, sizes);
        ASSERT_TRUE(report) << report.error().message();
        expect_files(chain, container, report->bytes);
        remove_outputs();
    }
}

// Roughness together with the normals, from values and from maps.
TEST_F(OutputFiles, RoughnessHasTheBytesOfTheVerbs) {
    constexpr Format kFormats[] = {Format::bc4_unorm, Format::r8_unorm, Format::r16_unorm, Format::r16_float,
                                   Format::r32_float};
    constexpr Container kRough[] = {Container::dds, Container::ktx2, Container::exr, Container::png};
    std::mt19937 random(10);
    for (int round = 0; round < 150; ++round) {
        const Extent extent{kSides[random() % 11], kSides[random() % 11]};
        SCOPED_TRACE(testing::Message() << "round " << round << ", " << extent.width << "x" << extent.height);
        draw(random, Container::dds);
        pack_.level_names = {};
        pack_.mip = bake_.mip;
        RoughnessFile file;
        file.output = path("rough");
        file.container = kRough[random() % 4];
        file.format = kFormats[file.container == Container::exr   ? 3 + random() % 2
                               : file.container == Container::png ? 1 + random() % 2
                                                                  : random() % 5];
        if (file.container == Container::exr) pack_.mip->levels = random() % 2 == 0 ? 0 : 1;
        file.effort = Effort::fast;
        file.model = any_of(kRoughnessModelNames, random);
        file.own = static_cast<float>(random() % 5) / 4.0f;
        pack_.roughness = file;
        const std::string input = write_map(extent, 1, Container::png);

        const NormalMap base = std::move(read_normals(input).value().chain.levels.front());
        MipOptions mip = *pack_.mip;
        if (file.container == Container::png) mip.levels = 1;
        const Plane<float> own(extent, file.own);
        const RoughnessChain chain = build_roughness_chain(base, own, file.model, mip).value();
        const Bytes expected =
            encode_file(pack_roughness(chain, *file.format, file.effort).value(), file.container, pack_.write).value();

        Result<InputFile> opened = InputFile::open(input);
        const StreamSizes sizes{1 << (2 + random() % 10), 0};
        const auto report =
            pack_stream(*opened, path("out"), Container::dds, pack_, {1 + static_cast<int>(random() % 3), {}}, sizes);
        ASSERT_TRUE(report) << report.error().message();
        ASSERT_TRUE(bytes_of(path("rough")) == expected);
        EXPECT_EQ(report->roughness_bytes, expected.size());
        const Bytes normals = bytes_of(path("out"));
        // A map with the same extent or with a different one.
        const Extent its = round % 2 == 0 ? extent : Extent{kSides[random() % 11], kSides[random() % 11]};
        const auto make_map = [its, seed = random()] {
            std::mt19937 values(seed);
            Plane<float> map(its);
            for (int j = 0; j < its.height; ++j) {
                for (int i = 0; i < its.width; ++i) map.at(i, j) = static_cast<float>(values() % 300) / 256.0f;
            }
            return map;
        };
        pack_.roughness->map = [&]() -> Result<Plane<float>> { return make_map(); };
        const auto mapped = pack_file(input, path("out"), Container::dds, pack_, {1 + round % 3, {}});
        ASSERT_TRUE(mapped) << mapped.error().message();
        const RoughnessChain rough = build_roughness_chain(base, make_map(), file.model, mip).value();
        const Texture packed = pack_roughness(rough, *file.format, file.effort).value();
        EXPECT_TRUE(bytes_of(path("rough")) == encode_file(packed, file.container, pack_.write).value());
        EXPECT_EQ(mapped->roughness_bytes, bytes_of(path("rough")).size());
        EXPECT_TRUE(bytes_of(path("out")) == normals);
        pack_.roughness.reset();
        ASSERT_TRUE(pack_file(input, path("out"), Container::dds, pack_));
        EXPECT_TRUE(bytes_of(path("out")) == normals);
    }
}

TEST_F(OutputFiles, DamageLeavesNoneOfTheLevels) {
    std::mt19937 random(7);
    const std::string input = write_map({300, 280}, 1, Container::png);
    Bytes bytes = bytes_of(input);
    bytes.resize(bytes.size() - 300);
    const std::string cut = write("in", bytes);
    for (const Container container : kContainers) {
        draw(random, container);
        pack_.mip = MipOptions();
        EXPECT_EQ(bake_file(cut, "", container, bake_).error().code, ErrorCode::bad_data);
        EXPECT_EQ(pack_file(cut, "", container, pack_).error().code, ErrorCode::bad_data);
        EXPECT_EQ(files(), 1u);
    }
}

// Large files are open while they grow; small ones are written at the end. In both cases, the error must name the file
// that cannot be written.
TEST_F(OutputFiles, ALevelThatCannotBeWrittenIsNamedAndOthersAreWhole) {
    const std::string input = write_map({640, 640}, 1, Container::png);
    std::mt19937 random(8);
    for (const int missing : {0, 1, 4}) {
        draw(random, Container::dds);
        packing_.encoding = bake_.pack.encoding = Encoding::rgb8;
        bake_.mip = {};
        bake_.level_names = [&](int level) {
            return path(level == missing ? "none/out" : "out" + std::to_string(level));
        };
        const auto report = bake_file(input, "", Container::dds, bake_);
        EXPECT_EQ(report.error().message(), path("none/out") + ": the directory does not exist");
        const std::size_t before = missing == 4 ? 4 : 0;  // 0 and 1 are opened immediately
        EXPECT_EQ(files(), 1 + before);
        remove_outputs();
    }
}

// A reader that reads FIFOs one after the other opens the second one when the first has ended.
TEST_F(OutputFiles, FifosAreWrittenOneAfterTheOther) {
    const std::string input = write_map({640, 640}, 1, Container::png);
    std::mt19937 random(9);
    draw(random, Container::dds);
    bake_.mip = {};
    bake_.mip.levels = 3;
    bake_.pack.encoding = Encoding::rgb8;
    for (int k = 0; k < 3; ++k) ASSERT_EQ(mkfifo(names_(k).c_str(), 0600), 0);
    std::vector<std::size_t> sizes;
    std::thread reader([&] {
        for (int k = 0; k < 3; ++k) sizes.push_back(bytes_of(names_(k)).size());
    });
    const auto report = bake_file(input, "", Container::dds, bake_);
    reader.join();
    ASSERT_TRUE(report) << report.error().message();
    ASSERT_EQ(sizes.size(), 3u);
    EXPECT_EQ(sizes[0] + sizes[1] + sizes[2], report->bytes);
    EXPECT_GT(sizes[1], std::size_t{320} * 320 * 3);
}

}  // namespace
}  // namespace tex
