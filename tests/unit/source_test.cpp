// SPDX-License-Identifier: Apache-2.0

#include <tex/file.h>

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include <tex/mip.h>
#include <tex/pack.h>

#include "fields.h"
#include "normal_maps.h"
#include "scratch.h"

namespace tex {
namespace {

class SourceFiles : public testing::Test, protected Scratch {
protected:
    [[nodiscard]] std::string write(const std::string& name, const Texture& texture) const {
        WriteOptions options;
        options.sync = false;
        EXPECT_TRUE(write_texture(folder_ + "/" + name, texture, options));
        return folder_ + "/" + name;
    }
    [[nodiscard]] static Texture packed(Encoding encoding, YAxis y_axis = YAxis::up) {
        return pack(chain_from(wavy_map({20, 12})), {encoding, y_axis}).value();
    }

    [[nodiscard]] static Texture without_marks(Texture texture) {
        texture.swizzle_known = texture.y_known = false;
        return texture;
    }
};

TEST_F(SourceFiles, AreReadAsTheySay) {
    const Source source = read_normals(write("a.ktx2", packed(Encoding::bc5, YAxis::down))).value();
    EXPECT_EQ(source.info.format, Format::bc5_unorm);
    EXPECT_EQ(source.info.y_axis, YAxis::down);
    EXPECT_FALSE(source.info.guessed);
    EXPECT_TRUE(fields::same_bytes(source.chain.levels.front(),
                                   unpack(packed(Encoding::bc5, YAxis::down)).value().levels.front()));
    SourceOptions options;
    options.unpack.y_axis = YAxis::up;
    EXPECT_EQ(read_normals(folder_ + "/a.ktx2", options).value().info.y_axis, YAxis::up);
    options.file_y_first = true;
    EXPECT_EQ(read_normals(folder_ + "/a.ktx2", options).value().info.y_axis, YAxis::down);
    options.bc5_swizzle = Swizzle{Component::y, Component::x, Component::zero, Component::one};
    EXPECT_EQ(read_normals(folder_ + "/a.ktx2", options).value().info.swizzle, *options.bc5_swizzle);
}

TEST_F(SourceFiles, ThatDoNotSayAreReadAsTheirTexelsLook) {
    const std::string png = write("a.png", without_marks(packed(Encoding::ag8)));
    const Source source = read_normals(png).value();
    EXPECT_TRUE(source.info.guessed);
    EXPECT_EQ(name_of(kSwizzleNames, source.info.swizzle), "dxt5nm");
    SourceOptions options;
    options.r_or_a = true;
    EXPECT_EQ(read_normals(png, options).value().info.swizzle[3], Component::x);
    const std::string rgba = write("b.png", without_marks(packed(Encoding::rgba8)));
    EXPECT_EQ(read_normals(rgba, options).value().info.swizzle[0], Component::x);
    EXPECT_FALSE(read_normals(rgba).value().info.guessed);
    options.unpack.swizzle = Swizzle{Component::other, Component::y, Component::z, Component::x};
    EXPECT_EQ(read_normals(rgba, options).value().info.swizzle, *options.unpack.swizzle);
}

TEST_F(SourceFiles, OfFloatsKeepEveryBitOfAUnitVectorAndNormaliseOthers) {
    NormalMap map = wavy_map({9, 7});
    for (const char* name : {"a.exr", "a.dds", "a.ktx2"}) {
        const std::string path = write(name, pack(chain_from(copy_of(map)), {Encoding::float_}).value());
        EXPECT_TRUE(fields::same_bytes(read_normals(path).value().chain.levels.front(), map)) << name;
    }
    for (float* const component : {&map.x.at(3, 3), &map.y.at(3, 3), &map.z.at(3, 3)}) *component *= 0.5f;
    const std::string path = write("short.exr", pack(chain_from(copy_of(map)), {Encoding::float_}).value());
    const NormalMap read = std::move(read_normals(path).value().chain.levels.front());
    const float x = read.x.at(3, 3), y = read.y.at(3, 3), z = read.z.at(3, 3);
    EXPECT_NEAR(x * x + y * y + z * z, 1.0f, 1e-6f)
        << "the file says that it holds components; it does not say that they are of unit length";
    SourceOptions options;
    options.unpack.keep_length = true;
    EXPECT_TRUE(fields::same_bytes(read_normals(path, options).value().chain.levels.front(), map));
}

TEST_F(SourceFiles, OfAlphaAloneHoldNoNormals) {
    const std::string path = write("a.dds", packed(Encoding::rgba8));
    for (const bool dx10 : {false, true}) {
        std::vector<char> bytes(148 + 20 * 12);
        std::ifstream(path, std::ios::binary).read(bytes.data(), 128);
        const auto set = [&](std::size_t offset, std::uint32_t value) {
            std::memcpy(bytes.data() + offset, &value, sizeof value);
        };
        if (dx10) {
            set(80, 4);  // DDPF_FOURCC
            std::memcpy(bytes.data() + 84, "DX10", 4);
            for (const auto& [offset, value] : {std::pair<std::size_t, std::uint32_t>{128, 65}, {132, 3}, {140, 1}})
                set(offset, value);  // A8_UNORM
        } else {
            set(80, 2);  // DDPF_ALPHA
            for (const auto& [offset, value] :
                 {std::pair<std::size_t, std::uint32_t>{88, 8}, {92, 0}, {96, 0}, {100, 0}, {104, 0xff}})
                set(offset, value);
        }
        const std::size_t head = dx10 ? 148 : 128;
        for (std::size_t k = head; k < bytes.size(); ++k) bytes[k] = static_cast<char>(k * 7);
        const std::string name = folder_ + "/alpha.dds";
        std::ofstream(name, std::ios::binary)
            .write(bytes.data(), static_cast<std::streamsize>(head + std::size_t{20} * 12));
        const auto read = read_normals(name);
        ASSERT_FALSE(read);
        EXPECT_EQ(read.error().code, ErrorCode::unsupported);
        EXPECT_EQ(read.error().message(),
                  name + ": has one channel, which holds no normals (bake-normals reads heights)");
        const Image image = std::move(read_image(name).value());
        EXPECT_EQ(image.names, std::vector<std::string>{"A"});
        EXPECT_EQ(image.planes.front().at(1, 0), static_cast<float>((head + 1) * 7 % 256) / 255.0f);
    }
}

TEST_F(SourceFiles, HaveTheBaseLevelAloneWhereThatIsAskedFor) {
    const std::string path = write("a.dds", pack(build_mip_chain(wavy_map({16, 8})).value(), {Encoding::bc5}).value());
    EXPECT_EQ(read_normals(path).value().chain.levels.size(), 5u);
    EXPECT_EQ(read_normals(path, {}, true).value().chain.levels.size(), 1u);
}

TEST_F(SourceFiles, WithoutNormalsAreErrorsThatNameThem) {
    Texture grey;
    grey.format = Format::r8_unorm;
    grey.levels.push_back({{4, 4}, std::vector<std::byte>(16)});
    const Error one = read_normals(write("grey.png", grey)).error();
    EXPECT_EQ(one.code, ErrorCode::unsupported);
    EXPECT_EQ(one.message(),
              folder_ + "/grey.png: has one channel, which holds no normals (bake-normals reads heights)");
    SourceOptions options;
    options.unpack.swizzle = Swizzle{Component::z, Component::y, Component::other, Component::x};
    const Error lacking = read_normals(write("rgb.png", packed(Encoding::rgb8)), options).error();
    EXPECT_EQ(lacking.code, ErrorCode::bad_option);
    EXPECT_EQ(lacking.file, folder_ + "/rgb.png");
    EXPECT_EQ(read_normals(folder_ + "/none.png").error().code, ErrorCode::io);
}

}  // namespace
}  // namespace tex
