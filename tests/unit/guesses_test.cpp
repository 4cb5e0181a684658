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

#include "reference/real_maps.h"
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

const fs::path kSharedData = TEX_SOURCE_DIR "/../shared/data";

// All real maps but those in object space.
std::vector<std::string> files_of_maps() {
    std::vector<std::string> files;
    for (const reference::RealMap& map : reference::real_maps()) {
        if (map.path.find("OBJECTSPACE") == std::string::npos) files.push_back((kSharedData / map.path).string());
    }
    for (const char* const folder : {"mesh/FlightHelmet", "mesh/Suzanne", "trial"}) {
        for (const auto& entry : fs::directory_iterator(kSharedData / folder)) {
            const std::string name = entry.path().filename().string(), type = entry.path().extension().string();
            if ((type == ".png" || type == ".jpg") && name.find("ormal") != std::string::npos)
                files.push_back(entry.path().string());
        }
    }
    return files;
}

const std::vector<Sample>& all_samples() {
    static const std::vector<Sample> samples = [] {
        std::vector<Sample> made;
        for (const std::string& file : files_of_maps()) made.push_back(sample_of(file));
        return made;
    }();
    return samples;
}

TEST_F(Guesses, NoneIsWrongInSilence) {
    if (!fs::exists(kSharedData)) GTEST_SKIP() << "no shared data";
    const std::vector<Sample>& samples = all_samples();
    ASSERT_GT(samples.size(), 30u);
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

bool has_n219(const CheckReport& report) {
    return std::any_of(report.findings.begin(), report.findings.end(),
                       [](const Finding& finding) { return finding.rule->id == "N219"; });
}

// N219 is never found in a real map, and in most whose z other data have replaced.
TEST_F(Guesses, OtherDataInBlueAreFoundAndRealMapsAreNot) {
    if (!fs::exists(kSharedData)) GTEST_SKIP() << "no shared data";
    for (const std::string& file : files_of_maps()) EXPECT_FALSE(has_n219(check_file(file).value())) << file;
    const struct {
        LayoutCase layout;
        int least;  // maps in which it is found
    } kBlues[] = {
        {{"occlusion", false,
          [](double x, double y, double, double h, double o) {
              return Texel{x, y, o, h};
          }},
         26},
        {{"heights", false,
          [](double x, double y, double, double h, double) {
              return Texel{x, y, h, 1.0};
          }},
         28},
        {{"roughness", false,
          [](double x, double y, double, double h, double) {
              return Texel{x, y, 0.75 - 0.4 * h, 1.0};
          }},
         28},
    };
    for (const auto& [layout, least] : kBlues) {
        int found = 0;
        for (const Sample& sample : all_samples()) {
            if (has_n219(check("blue", texture_in(sample, layout)).value())) ++found;
        }
        std::printf("%s in blue: found in %d of %zu maps\n", layout.name, found, all_samples().size());
        EXPECT_GE(found, least) << layout.name;
    }
}

}  // namespace
}  // namespace tex
