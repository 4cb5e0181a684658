// SPDX-License-Identifier: Apache-2.0
// Layouts that files do not state: real maps in twelve layouts, and what reading them finds. A guess may be wrong only
// if a warning says that it is one.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <tex/check.h>
#include <tex/file.h>
#include <tex/pack.h>
#include <tex/surface.h>

#include "unit/normal_maps.h"
#include "unit/streams.h"

namespace tex {
namespace {

namespace fs = std::filesystem;

constexpr Extent kCrop{256, 256};

// A texel of a layout: R, G, B, A from x, y, z, a height and an occlusion, all from 0 to 1.
using Texel = std::array<double, 4>;
using MakeTexel = std::function<Texel(double x, double y, double z, double height, double occlusion)>;

struct LayoutCase {
    const char* name;
    bool is_ktx2;  // where equal colours are x
    MakeTexel texel;
};

double unit(double component) { return (component + 1.0) / 2.0; }

const LayoutCase kCases[] = {
    {"x y z 1", false,
     [](double x, double y, double z, double, double) {
         return Texel{x, y, z, 1.0};
     }},
    {"x y z height", false,
     [](double x, double y, double z, double h, double) {
         return Texel{x, y, z, h};
     }},
    {"x y z gloss", false,
     [](double x, double y, double z, double h, double o) {
         return Texel{x, y, z, 0.2 + 0.5 * h * o};
     }},
    {"x y z mask", false,
     [](double x, double y, double z, double h, double) {
         return Texel{x, y, z, h > 0.5 ? 1.0 : 0.0};
     }},
    {"x y z 0", false,
     [](double x, double y, double z, double, double) {
         return Texel{x, y, z, 0.0};
     }},
    {"1 y 1 x", false,
     [](double x, double y, double, double, double) {
         return Texel{1.0, y, 1.0, x};
     }},
    {"0 y 0 x", false,
     [](double x, double y, double, double, double) {
         return Texel{0.0, y, 0.0, x};
     }},
    {"y y y x", false,
     [](double x, double y, double, double, double) {
         return Texel{y, y, y, x};
     }},
    {"x x x y, KTX2", true,
     [](double x, double y, double, double, double) {
         return Texel{x, x, x, y};
     }},
    {"0 y z x", false,
     [](double x, double y, double z, double, double) {
         return Texel{0.0, y, z, x};
     }},
    {"x y occlusion height", false,
     [](double x, double y, double, double h, double o) {
         return Texel{x, y, o, h};
     }},
    {"x y height 1", false,
     [](double x, double y, double, double h, double) {
         return Texel{x, y, h, 1.0};
     }},
};

struct Sample {
    std::string name;
    NormalMap map;
    Plane<float> height, occlusion;
};

Plane<float> to_unit_range(const Plane<float>& plane) {
    float least = plane.at(0, 0), greatest = least;
    for (int j = 0; j < plane.extent().height; ++j) {
        const auto [low, high] = std::minmax_element(plane.row(j), plane.row(j) + plane.extent().width);
        least = std::min(least, *low);
        greatest = std::max(greatest, *high);
    }
    Plane<float> scaled(plane.extent());
    for (int j = 0; j < plane.extent().height; ++j) {
        for (int i = 0; i < plane.extent().width; ++i)
            scaled.at(i, j) = greatest > least ? (plane.at(i, j) - least) / (greatest - least) : 1.0f;
    }
    return scaled;
}

// The middle of a real map, with the heights that it shows, and darker hollows.
Sample sample_of(const fs::path& file) {
    Sample sample;
    sample.name = file.filename().string();
    NormalMap whole = std::move(read_normals(file.string(), {}, true).value().chain.levels[0]);
    const Extent extent{std::min(kCrop.width, whole.extent().width), std::min(kCrop.height, whole.extent().height)};
    sample.map = NormalMap(extent);
    const int left = (whole.extent().width - extent.width) / 2, top = (whole.extent().height - extent.height) / 2;
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            sample.map.x.at(i, j) = whole.x.at(left + i, top + j);
            sample.map.y.at(i, j) = whole.y.at(left + i, top + j);
            sample.map.z.at(i, j) = whole.z.at(left + i, top + j);
        }
    }
    sample.height = to_unit_range(integrate(sample.map).value().field.height);
    sample.occlusion = Plane<float>(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            float around = 0.0f;
            for (const auto& [di, dj] : {std::pair(-3, 0), std::pair(3, 0), std::pair(0, -3), std::pair(0, 3)}) {
                around +=
                    sample.height.at(std::clamp(i + di, 0, extent.width - 1), std::clamp(j + dj, 0, extent.height - 1));
            }
            const float hollow = std::max(0.0f, around / 4.0f - sample.height.at(i, j));
            sample.occlusion.at(i, j) = std::clamp(1.0f - 6.0f * hollow, 0.2f, 1.0f);
        }
    }
    return sample;
}

Texture texture_in(const Sample& sample, const LayoutCase& layout) {
    Texture texture;
    texture.format = Format::rgba8_unorm;
    texture.swizzle = kSwizzleXyz;
    texture.x_in_grey = layout.is_ktx2;
    const Extent extent = sample.map.extent();
    Level level{extent, std::vector<std::byte>(level_bytes(texture.format, extent))};
    std::byte* out = level.bytes.data();
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const auto at = [&](const Plane<float>& plane) { return static_cast<double>(plane.at(i, j)); };
            const Texel texel = layout.texel(unit(at(sample.map.x)), unit(at(sample.map.y)), unit(at(sample.map.z)),
                                             at(sample.height), at(sample.occlusion));
            for (const double value : texel) *out++ = static_cast<std::byte>(std::lround(value * 255.0));
        }
    }
    texture.levels.push_back(std::move(level));
    return texture;
}

enum class Outcome { right, warned, wrong };

class Guesses : public StreamTest {
protected:
    Outcome judge(const Sample& sample, const LayoutCase& layout) const {
        const Texture texture = texture_in(sample, layout);
        Source source;
        if (layout.is_ktx2) {
            UnpackOptions options;
            options.swizzle = guess_swizzle(texture).value();
            source.info.guessed = true;
            source.chain = unpack(texture, options).value();
        } else {
            const std::string file = StreamTest::write("guess.png", encode_file(texture, Container::png).value());
            SourceOptions options;
            options.inspect = true;
            source = read_normals(file, options).value();
        }
        const auto compared = compare(sample.map, source.chain.levels[0]);
        constexpr double kRight = 3.0;  // degrees: rounding, and z that is rebuilt
        if (compared->error.mean <= kRight) return Outcome::right;
        return !layout.is_ktx2 && (source.info.guessed || source.info.z_doubtful || source.info.object_space)
                   ? Outcome::warned
                   : Outcome::wrong;
    }
};

TEST_F(Guesses, NoneIsWrongInSilence) {
    const fs::path data = TEX_SOURCE_DIR "/../shared/data";
    if (!fs::exists(data)) GTEST_SKIP() << "no shared data";
    std::vector<Sample> samples;
    for (const fs::path& folder : {data / "normal", data / "mesh/FlightHelmet", data / "mesh/Suzanne"}) {
        for (const auto& entry : fs::directory_iterator(folder)) {
            const std::string name = entry.path().filename().string(), type = entry.path().extension().string();
            const bool is_picture = type == ".png" || type == ".tga" || type == ".jpg";
            const bool is_normal_map = folder.filename() == "normal" || name.find("ormal") != std::string::npos;
            if (is_picture && is_normal_map && name.find("OBJECTSPACE") == std::string::npos)
                samples.push_back(sample_of(entry.path()));
        }
    }
    ASSERT_GT(samples.size(), 15u);
    std::printf("%-24s right  warned  wrong, of %zu maps\n", "layout", samples.size());
    for (const LayoutCase& layout : kCases) {
        std::map<Outcome, int> count;
        for (const Sample& sample : samples) {
            const Outcome outcome = judge(sample, layout);
            ++count[outcome];
            EXPECT_NE(outcome, Outcome::wrong) << layout.name << ": " << sample.name;
        }
        std::printf("%-24s %5d %7d %6d\n", layout.name, count[Outcome::right], count[Outcome::warned],
                    count[Outcome::wrong]);
    }
}

}  // namespace
}  // namespace tex
