// SPDX-License-Identifier: Apache-2.0

#include <tex/file.h>

#include <gtest/gtest.h>

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "scratch.h"

namespace tex {
namespace {

namespace fs = std::filesystem;

const std::string kData = TEX_SOURCE_DIR "/../shared/data";
constexpr const char* kMagick = "/usr/bin/convert";  // ImageMagick: decoders that share no code of ours

ReadOptions quick() {
    ReadOptions options;
    options.reader_timeout = 10;
    return options;
}

std::string output_of(const std::string& command) {
    FILE* pipe = popen(command.c_str(), "r");
    std::string text;
    char part[4096];
    while (const std::size_t n = fread(part, 1, sizeof part, pipe)) text.append(part, n);
    pclose(pipe);
    return text;
}

// The properties that SOURCES.md gives for the files of height/.
struct Sample {
    const char* file;
    Extent extent;
    std::vector<std::string> names;
    int bits;
    SampleKind kind;
    double low, high;  // of the first plane
};

const std::vector<std::string> kGrey = {"Y"};
const std::vector<std::string> kRgb = {"R", "G", "B"};
const std::vector<std::string> kRgba = {"R", "G", "B", "A"};

const Sample kSamples[] = {
    {"dem_puget_sound_1025x1025_u16.png", {1025, 1025}, kGrey, 16, SampleKind::unorm, 0, 0.6683},
    {"dem_mt_fuji_smart_512x512_u16.png", {512, 512}, kGrey, 16, SampleKind::unorm, 0, 1},
    {"dem_fuji_253x253_u16.png", {253, 253}, kGrey, 16, SampleKind::unorm, 0, 1},
    {"tiny_10x10_u16.png", {10, 10}, kGrey, 16, SampleKind::unorm, 0, 1},
    {"tiny_10x10_u8.png", {10, 10}, kGrey, 8, SampleKind::unorm, 0, 1},
    {"metal_plate_disp_1k_1024x1024_u16.png", {1024, 1024}, kGrey, 16, SampleKind::unorm, 0.001862, 0.9912},
    {"elevation_map_250x195_rgb16_equal.png", {250, 195}, kRgb, 16, SampleKind::unorm, 0, 1},
    {"terrain_1024x1024_rgba_float.exr", {1024, 1024}, kRgba, 32, SampleKind::floating, 0, 0.6763},
    {"stamp_terrain1_512x512_rgba_half.exr", {512, 512}, kRgba, 16, SampleKind::floating, 2.146e-06, 1},
    {"dem_landscape_200x125_f32_metres.tif", {200, 125}, kGrey, 32, SampleKind::floating, -4.732, 921.4},
    {"dem_unfinished_33x33_f32_metres.tif", {33, 33}, kGrey, 32, SampleKind::floating, -3.277e+04, 1909},
    {"dtm_283x259_f32_nodata-9999.tif", {283, 259}, kGrey, 32, SampleKind::floating, -9999, 22.12},
    {"canyon_4096x4096_rgb8_equal.jpg", {4096, 4096}, kRgb, 8, SampleKind::unorm, 0.1725, 0.2706},
    {"urho_heightmap_1025x1025_u8.png", {1025, 1025}, kGrey, 8, SampleKind::unorm, 0, 0.9922},
    {"materialx_plain_sphere_pyramid_512x512_u8.png", {512, 512}, kGrey, 8, SampleKind::unorm, 0, 0.9882},
    {"winding_valley_513x513_u8.png", {513, 513}, kGrey, 8, SampleKind::unorm, 0.02353, 1},
    {"threejs_terrain_64x64_rgba8_equal.png", {64, 64}, kRgba, 8, SampleKind::unorm, 0, 0.9686},
    {"marble_tiles_600x600_u8.jpg", {600, 600}, kGrey, 8, SampleKind::unorm, 0.2706, 1},
    {"reader_grey_12bit_73x43.tif", {73, 43}, kGrey, 12, SampleKind::unorm, 0.03491, 1},
    {"reader_rgb_planar_16bit_73x43.tif", {73, 43}, kRgb, 16, SampleKind::unorm, 0, 1},
    {"reader_nan_inf_800x800.exr", {800, 800}, kRgb, 16, SampleKind::floating, -INFINITY, INFINITY},
};

TEST(ImageIo, ReadsEveryHeightMapAsItsSourceDescribesIt) {
    if (!fs::exists(kData)) GTEST_SKIP() << "no shared data";
    std::size_t files = 0;
    for (const auto& entry : fs::directory_iterator(kData + "/height")) files += entry.is_regular_file();
    EXPECT_EQ(files, std::size(kSamples));
    for (const Sample& sample : kSamples) {
        SCOPED_TRACE(sample.file);
        const Result<Image> image = read_image(kData + "/height/" + sample.file, quick());
        ASSERT_TRUE(image) << image.error().message();
        EXPECT_EQ(image->extent(), sample.extent);
        EXPECT_EQ(image->names, sample.names);
        EXPECT_EQ(image->bits, sample.bits);
        EXPECT_EQ(image->sample, sample.kind);
        double low = INFINITY;
        double high = -INFINITY;
        for (int j = 0; j < sample.extent.height; ++j) {
            for (int i = 0; i < sample.extent.width; ++i) {
                low = std::min<double>(low, image->planes[0].at(i, j));
                high = std::max<double>(high, image->planes[0].at(i, j));
            }
        }
        if (std::isinf(sample.low)) continue;
        EXPECT_NEAR(low, sample.low, 2e-4 * std::max(1.0, std::abs(sample.low)));
        EXPECT_NEAR(high, sample.high, 2e-4 * std::max(1.0, std::abs(sample.high)));
    }
}

// Compares the values of `file` with the 16-bit values that ImageMagick decodes.
void compare_with_magick(const std::string& file, const char* map) {
    SCOPED_TRACE(file);
    const Result<Image> image = read_image(file, quick());
    ASSERT_TRUE(image) << image.error().message();
    const std::string raw = output_of(std::string(kMagick) + " '" + file + "' -auto-orient -depth 16 -endian LSB " +
                                      map + ":- 2>/dev/null");
    const std::size_t planes = image->planes.size();
    ASSERT_EQ(raw.size(), static_cast<std::size_t>(image->extent().texels()) * planes * 2);
    std::size_t at = 0;
    for (int j = 0; j < image->extent().height; ++j) {
        for (int i = 0; i < image->extent().width; ++i) {
            for (const Plane<float>& plane : image->planes) {
                const int theirs = static_cast<unsigned char>(raw[at]) | static_cast<unsigned char>(raw[at + 1]) << 8;
                at += 2;
                ASSERT_EQ(std::lround(plane.at(i, j) * 65535.0), theirs) << i << ", " << j;
            }
        }
    }
}

TEST(ImageIo, DecodesTheSameValuesAsImageMagick) {
    if (!fs::exists(kData)) GTEST_SKIP() << "no shared data";
    if (access(kMagick, X_OK) != 0) GTEST_SKIP() << "no ImageMagick";
    compare_with_magick(kData + "/height/reader_grey_12bit_73x43.tif", "gray");
    compare_with_magick(kData + "/height/reader_rgb_planar_16bit_73x43.tif", "rgb");
    compare_with_magick(kData + "/height/dem_fuji_253x253_u16.png", "gray");
    compare_with_magick(kData + "/height/elevation_map_250x195_rgb16_equal.png", "rgb");
    compare_with_magick(kData + "/height/threejs_terrain_64x64_rgba8_equal.png", "rgba");
    compare_with_magick(kData + "/normal/water1_256.tga", "rgb");
    compare_with_magick(kData + "/pairs/d3d_pom_rocks/normal_rgb_height_a.tga", "rgba");
}

// oiiotool prints "Pixel (i, j): v v v" for every texel.
void compare_with_oiiotool(const std::string& file) {
    SCOPED_TRACE(file);
    const Result<Image> image = read_image(file, quick());
    ASSERT_TRUE(image) << image.error().message();
    std::istringstream lines(output_of("/usr/bin/oiiotool --dumpdata '" + file + "' 2>/dev/null"));
    std::int64_t texels = 0;
    for (std::string line; std::getline(lines, line);) {
        int i = 0, j = 0, used = 0;
        if (std::sscanf(line.c_str(), " Pixel (%d, %d): %n", &i, &j, &used) != 2) continue;
        ++texels;
        const char* at = line.c_str() + used;
        for (const Plane<float>& plane : image->planes) {
            char* end = nullptr;
            const double theirs = std::strtod(at, &end);
            at = end;
            ASSERT_NEAR(plane.at(i, j), theirs, 1e-5 * std::max(1.0, std::abs(theirs))) << i << ", " << j;
        }
    }
    EXPECT_EQ(texels, image->extent().texels());
}

TEST(ImageIo, DecodesTheSameFloatsAsOiiotool) {
    if (!fs::exists(kData)) GTEST_SKIP() << "no shared data";
    if (access("/usr/bin/oiiotool", X_OK) != 0) GTEST_SKIP() << "no oiiotool";
    compare_with_oiiotool(kData + "/height/dem_landscape_200x125_f32_metres.tif");
    compare_with_oiiotool(kData + "/height/dem_unfinished_33x33_f32_metres.tif");
    compare_with_oiiotool(kData + "/pairs/oiio_bump/height_half.exr");
    compare_with_oiiotool(kData + "/pairs/oiio_bump/normal_YDOWN_half.exr");
}

TEST(ImageIo, AlphaNeverTouchesColour) {
    if (!fs::exists(kData)) GTEST_SKIP() << "no shared data";
    for (const std::string pair : {"d3d_pom_rocks", "d3d_pom_bump"}) {
        const std::string folder = kData + "/pairs/" + pair;
        const Result<Image> tga = read_image(folder + "/normal_rgb_height_a.tga", quick());
        const Result<Image> rgb = read_image(folder + "/derived/normal_rgb.png", quick());
        const Result<Image> height = read_image(folder + "/derived/height.png", quick());
        ASSERT_TRUE(tga && rgb && height);
        ASSERT_EQ(tga->names, kRgba);
        for (std::size_t c = 0; c < 4; ++c) {
            const Plane<float>& theirs = c < 3 ? rgb->planes[c] : height->planes[0];
            for (int j = 0; j < tga->extent().height; ++j) {
                for (int i = 0; i < tga->extent().width; ++i) ASSERT_EQ(tga->planes[c].at(i, j), theirs.at(i, j));
            }
        }
    }
}

TEST(ImageIo, HostileFilesAreRefusedOrReadInTime) {
    if (!fs::exists(kData)) GTEST_SKIP() << "no shared data";
    std::vector<std::string> files;
    for (const auto& entry : fs::directory_iterator(kData + "/bad")) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    EXPECT_GT(files.size(), 70u);
    ReadOptions options = quick();
    options.reader_timeout = 8;
    for (const std::string& file : files) {
        const auto begin = std::chrono::steady_clock::now();
        const Result<Image> image = read_image(file, options);
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
        EXPECT_LT(took.count(), 10.0) << file;
        if (image) continue;
        const ErrorCode code = image.error().code;
        EXPECT_TRUE(code == ErrorCode::bad_data || code == ErrorCode::unsupported) << image.error().message();
        EXPECT_EQ(image.error().file, file);
        EXPECT_FALSE(image.error().reason.empty());
        EXPECT_EQ(image.error().reason.find('\n'), std::string::npos);
    }
}

class ImageIoFiles : public testing::Test, protected Scratch {};

TEST_F(ImageIoFiles, TruncationAtEveryPowerOfTwoIsDamage) {
    if (!fs::exists(kData)) GTEST_SKIP() << "no shared data";
    for (const std::string name : {"dem_fuji_253x253_u16.png", "stamp_terrain1_512x512_rgba_half.exr",
                                   "threejs_terrain_64x64_rgba8_equal.png", "terrain_1024x1024_rgba_float.exr"}) {
        std::stringstream whole;
        whole << std::ifstream(kData + "/height/" + name, std::ios::binary).rdbuf();
        for (std::size_t n = 4; n < whole.str().size(); n *= 2) {
            const std::string path = write("cut", whole.str().substr(0, n));
            const Result<Image> image = read_image(path, quick());
            ASSERT_FALSE(image) << name << ", " << n;
            EXPECT_EQ(image.error().code, ErrorCode::bad_data) << name << ", " << n << ": " << image.error().reason;
        }
    }
}

TEST_F(ImageIoFiles, TheContentDecidesNotTheName) {
    if (!fs::exists(kData)) GTEST_SKIP() << "no shared data";
    const std::string misnamed = folder_ + "/really_a.tga";
    fs::copy_file(kData + "/height/tiny_10x10_u8.png", misnamed);
    EXPECT_TRUE(read_image(misnamed));
    const std::string tiff = folder_ + "/really_a.png";
    fs::copy_file(kData + "/height/dem_unfinished_33x33_f32_metres.tif", tiff);
    EXPECT_TRUE(read_image(tiff));
}

TEST_F(ImageIoFiles, RefusesWhatIsNoPicture) {
    for (const std::string text : {"hello, world", "#version 330\n", "%PDF-1.4", "x",
                                   "\x7f"
                                   "ELF\2\1\1"}) {
        const Result<Image> image = read_image(write("a.png", text));
        ASSERT_FALSE(image);
        EXPECT_EQ(image.error().code, ErrorCode::bad_data);
        EXPECT_EQ(image.error().reason, "not a picture, or of a type that is not supported");
    }
    const auto unread = [&](const std::string& bytes) { return read_image(write("a.png", bytes)).error(); };
    const std::string four(4, '\0');
    EXPECT_EQ(unread(four + "ftypavif").code, ErrorCode::unsupported);
    EXPECT_EQ(unread(four + "ftypavif").reason,
              "AVIF is not supported; \"avifdec\" makes PNG of it, with the losses that it has");
    EXPECT_EQ(unread(four + "ftypheic").reason.substr(0, 4), "HEIF");
    EXPECT_EQ(unread("\xff\x0a" + four).reason.substr(0, 7), "JPEG XL");
    EXPECT_EQ(read_image(write("a.ktx", "\xabKTX 11\xbb\r\n\x1a\n")).error().reason,
              "truncated: the KTX header is not complete");
    EXPECT_EQ(read_image(write("empty.png", "")).error().reason, "is empty");
    EXPECT_EQ(read_image(folder_).error().reason, "is a directory; name its files");
    EXPECT_EQ(read_image(folder_ + "/missing.png").error().code, ErrorCode::io);
}

TEST_F(ImageIoFiles, ReadsFromAFifoInEveryWay) {
    if (!fs::exists(kData)) GTEST_SKIP() << "no shared data";
    const std::string fifo = folder_ + "/fifo";
    ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
    for (const std::string name : {"tiny_10x10_u16.png", "reader_nan_inf_800x800.exr", "reader_grey_12bit_73x43.tif"}) {
        const std::string source = kData + "/height/" + name;
        std::thread writer(
            [&] { std::ofstream(fifo, std::ios::binary) << std::ifstream(source, std::ios::binary).rdbuf(); });
        const Result<Image> image = read_image(fifo, quick());
        writer.join();
        EXPECT_TRUE(image) << name << ": " << (image ? "" : image.error().message());
    }
}

TEST_F(ImageIoFiles, ReadsTheBaseLevelOfTextures) {
    Texture texture;
    texture.format = Format::rgba8_unorm;
    texture.levels.push_back({{2, 1},
                              {std::byte{255}, std::byte{0}, std::byte{51}, std::byte{102}, std::byte{0}, std::byte{0},
                               std::byte{0}, std::byte{255}}});
    texture.levels.push_back({{1, 1}, std::vector<std::byte>(4)});
    for (const char* name : {"a.dds", "a.ktx2"}) {
        const auto bytes = encode_file(texture, *container_of(name));
        ASSERT_TRUE(bytes) << bytes.error().message();
        ASSERT_TRUE(write_file(folder_ + "/" + name, *bytes));
        const Result<Image> image = read_image(folder_ + "/" + name);
        ASSERT_TRUE(image) << image.error().message();
        ASSERT_EQ(image->names, kRgba);
        EXPECT_EQ(image->extent(), (Extent{2, 1}));
        EXPECT_EQ(image->planes[0].at(0, 0), 1.0f);
        EXPECT_EQ(image->planes[2].at(0, 0), 51.0f / 255.0f);
        EXPECT_EQ(image->planes[3].at(1, 0), 1.0f);
    }
}

}  // namespace
}  // namespace tex
