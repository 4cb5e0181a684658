// SPDX-License-Identifier: Apache-2.0
// Every verb, every encoding in every container, and what is beside the normals: nothing, kept, dropped, given, more
// than there is room for. Kept data stay to the last bit where the depth is the same, smaller levels hold the reference
// of their kind, a channel is named exactly where it is lost, and files and memory give the same bytes.

#include <cmath>
#include <cstddef>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <tex/bake.h>
#include <tex/blend.h>
#include <tex/file.h>
#include <tex/mip.h>
#include <tex/pipeline.h>

#include "unit/normal_maps.h"
#include "unit/streams.h"

namespace tex {
namespace {

constexpr Extent kSide{16, 8};
constexpr Strength kStrength{2.0f, 2.0f};

enum class Verb { pack, mip, scale, blend, bake };
enum class Beside { nothing, kept, dropped, given_alpha, given_blue, given_length, baked_heights };

constexpr Verb kVerbs[] = {Verb::pack, Verb::mip, Verb::scale, Verb::blend, Verb::bake};
constexpr Beside kBesides[] = {Beside::nothing,    Beside::kept,         Beside::dropped,      Beside::given_alpha,
                               Beside::given_blue, Beside::given_length, Beside::baked_heights};

// What is not a question of this verb: heights have nothing beside them, and only a bake has heights.
bool applies(Verb verb, Beside beside) {
    const bool bakes = verb == Verb::bake;
    if (beside == Beside::kept || beside == Beside::dropped) return !bakes;
    return beside != Beside::baked_heights || bakes;
}

// Values of 8 bits, which every depth but half holds exactly.
Plane<float> data(int factor) {
    Plane<float> plane(kSide);
    for (int k = 0; k < kSide.texels(); ++k)
        plane.at(k % kSide.width, k / kSide.width) = static_cast<float>(factor * k % 256) / 255.0f;
    return plane;
}

// What `plane` is in the next smaller level: means of four, in double.
Plane<float> halved(const Plane<float>& plane) {
    Plane<float> half({plane.extent().width / 2, plane.extent().height / 2});
    for (int j = 0; j < half.extent().height; ++j) {
        for (int i = 0; i < half.extent().width; ++i) {
            double sum = 0.0;
            for (const auto& [di, dj] : {std::pair(0, 0), std::pair(1, 0), std::pair(0, 1), std::pair(1, 1)})
                sum += static_cast<double>(plane.at(2 * i + di, 2 * j + dj));
            half.at(i, j) = static_cast<float>(sum / 4.0);
        }
    }
    return half;
}

// A file of one channel with the codes of data(factor).
Bytes picture(int factor) {
    Texture texture;
    texture.format = Format::r8_unorm;
    texture.swizzle = {Component::other, Component::other, Component::other, Component::other};
    Level level{kSide, std::vector<std::byte>(static_cast<std::size_t>(kSide.texels()))};
    for (int k = 0; k < kSide.texels(); ++k)
        level.bytes[static_cast<std::size_t>(k)] = static_cast<std::byte>(factor * k % 256);
    texture.levels.push_back(std::move(level));
    return encode_file(texture, Container::png).value();
}

constexpr int kKept = 7, kGiven = 11, kHeights = 5;

class ExtrasMatrix : public StreamTest {
protected:
    ExtrasMatrix() {
        std::ignore = StreamTest::write("given.png", picture(kGiven));
        std::ignore = StreamTest::write("heights.png", picture(kHeights));
        for (const Encoding encoding : {Encoding::rgba8, Encoding::rgba16, Encoding::rgba32f}) {
            for (const bool has_alpha : {true, false}) {
                NormalMap map = wavy_map(kSide);
                if (has_alpha) map.alpha = data(kKept);
                const auto bytes = encode_file(pack(chain_from(std::move(map)), {encoding}).value(), Container::ktx2);
                std::ignore = StreamTest::write(name_of(encoding, has_alpha), *bytes);
            }
        }
    }
    static std::string name_of(Encoding encoding, bool has_alpha) {
        return std::string(tex::name_of(kEncodingNames, encoding)) + (has_alpha ? "-alpha" : "");
    }
    // A file of this encoding, with data in alpha unless there is to be none.
    std::string source(Encoding encoding, bool has_alpha) { return path(name_of(encoding, has_alpha)); }

    // What is given: planes in memory, or files that are read with the rows of the normals.
    ExtraInputs inputs(Beside beside, bool from_file) const {
        ExtraData data_given;
        if (from_file) {
            data_given.picture = ExtraPicture{path("given.png")};
        } else {
            data_given.map = []() -> Result<Plane<float>> { return data(kGiven); };
        }
        ExtraInputs inputs;
        if (beside == Beside::given_alpha) inputs.alpha = data_given;
        if (beside == Beside::given_blue) inputs.blue = data_given;
        if (beside == Beside::given_length) inputs.length = data_given;
        if (beside == Beside::baked_heights) inputs.alpha = ExtraData{1.0f, {}, true};
        return inputs;
    }
    SourceOptions reading(Beside beside) const {
        SourceOptions options;
        options.inspect = true;
        options.drop_others = beside == Beside::dropped;
        return options;
    }
    // From file to file. Returns the channels that were lost, as letters.
    Result<std::string> stream(Verb verb, const std::string& input, Encoding encoding, Container container,
                               Beside beside) {
        const PackOptions packing{encoding, YAxis::up, Effort::fast};
        const auto pack_by = [packing](const SourceInfo&) { return packing; };
        const auto names = [](const SourceInfo& info) {
            std::string letters;
            for (const ExtraChannel& other : info.others) letters += other.name;
            return letters;
        };
        if (verb == Verb::bake) {
            BakeFileOptions options;
            options.strength = [](Extent) { return kStrength; };
            options.pack = packing;
            options.write.sync = false;
            options.others = inputs(beside, true);
            const auto done = bake_file(path("heights.png"), path("out"), container, options);
            return done ? Result<std::string>(std::string()) : done.error();
        }
        if (verb == Verb::blend) {
            BlendFileOptions options;
            options.source = reading(beside);
            options.layers.emplace_back().input = input;
            options.pack = pack_by;
            options.write.sync = false;
            options.others = inputs(beside, true);
            const auto done = blend_file(input, path("out"), container, options);
            return done ? Result<std::string>(names(done->source)) : done.error();
        }
        PackFileOptions options;
        options.source = reading(beside);
        if (verb == Verb::mip) options.mip = MipOptions();
        if (verb == Verb::scale) options.scale = Scaling{0.5f, ScaleMode::slope};
        options.pack = pack_by;
        options.write.sync = false;
        options.others = inputs(beside, true);
        const auto done = pack_file(input, path("out"), container, options);
        return done ? Result<std::string>(names(done->source)) : done.error();
    }
    // The verbs in memory.
    Bytes memory(Verb verb, const std::string& input, Encoding encoding, Container container, Beside beside) {
        MipChain chain;
        if (verb == Verb::bake) {
            HeightField field = height_field(read_image(path("heights.png")).value(), {}).value();
            field.bumpiness_x = kStrength.x;
            field.bumpiness_y = kStrength.y;
            chain = chain_from(bake(field).value());
            if (beside == Beside::baked_heights) chain.levels[0].alpha = std::move(field.height);
        } else {
            chain = std::move(read_normals(input, reading(beside))->chain);
        }
        if (verb == Verb::blend) {
            std::vector<Layer> layers(1);
            layers[0].detail = std::move(read_normals(input)->chain);
            chain = chain_from(blend(std::move(chain), std::move(layers)).value());
        }
        if (verb == Verb::scale) chain = scale(std::move(chain), 0.5f).value();
        if (beside != Beside::baked_heights) {
            EXPECT_TRUE(put_others(chain.levels[0], inputs(beside, false), encoding));
        }
        const bool builds = verb != Verb::pack && verb != Verb::scale;
        if (builds && can_hold_levels(container)) chain = build_mip_chain(std::move(chain.levels[0])).value();
        return encode_file(pack(chain, {encoding, YAxis::up, Effort::fast}).value(), container).value();
    }
    // One case.
    void check(Verb verb, Encoding encoding, Container container, Beside beside) {
        const Encoding sources[] = {Encoding::rgba8, Encoding::rgba16, Encoding::rgba32f};
        const Encoding from = sources[(static_cast<std::size_t>(verb) + static_cast<std::size_t>(beside)) % 3];
        const ExtraSet held = can_hold(encoding);
        const FormatInfo format = format_info(encoding_info(encoding).format);
        const std::string what = std::string(tex::name_of(kEncodingNames, encoding)) + " in " +
                                 std::string(tex::name_of(kContainerNames, container)) + ", verb " +
                                 std::to_string(static_cast<int>(verb)) + ", beside " +
                                 std::to_string(static_cast<int>(beside));
        const std::string input = source(from, beside != Beside::nothing);
        const auto lost = stream(verb, input, encoding, container, beside);
        const bool is_alpha = beside == Beside::given_alpha || beside == Beside::baked_heights;
        const bool has_room = (!is_alpha || held.alpha) && (beside != Beside::given_blue || held.blue) &&
                              (beside != Beside::given_length || held.length);
        ASSERT_EQ(static_cast<bool>(lost), has_room) << what << (lost ? "" : lost.error().message());
        if (!has_room) {
            EXPECT_NE(lost.error().reason.find("these formats have: "), std::string::npos) << what;
            return;
        }
        const bool has_alpha = verb != Verb::bake && beside != Beside::nothing && beside != Beside::dropped;
        const bool keeps = has_alpha && beside != Beside::given_alpha;
        EXPECT_EQ(*lost, keeps && !held.alpha ? "A" : "") << what;
        EXPECT_EQ(bytes_of(path("out")), memory(verb, input, encoding, container, beside)) << what;
        if (held.alpha && keeps) expect_data(3, data(kKept), format, what);
        const bool leaves_out_ones = container == Container::webp;
        if (held.alpha && !has_alpha && !is_alpha && !leaves_out_ones)
            expect_data(3, Plane<float>(kSide, 1.0f), format, what);
        if (beside == Beside::given_alpha) expect_data(3, data(kGiven), format, what);
        if (beside == Beside::baked_heights) expect_data(3, data(kHeights), format, what);
        if (beside == Beside::given_blue) expect_data(2, data(kGiven), format, what);
    }
    // Compares a stored channel of all levels with the data of the base level.
    void expect_data(std::size_t channel, Plane<float> expected, const FormatInfo& format, const std::string& what) {
        const Texture texture = read_texture(path("out")).value();
        for (int level = 0; level < std::min(3, static_cast<int>(texture.levels.size())); ++level) {
            if (level > 0) expected = halved(expected);
            const bool is_exact = level == 0 && (format.bits != 16 || format.sample == SampleKind::unorm);
            const float codes = format.bits == 8 ? 255.0f : format.bits == 16 ? 2048.0f : 1e6f;
            // Blocks hold four by four values, which here jump from 0 to 1, only nearly.
            const float most = format.has_blocks() ? 0.25f : is_exact ? 1e-7f : 0.501f / codes;
            const Image image = decode(texture, level).value();
            for (int j = 0; j < expected.extent().height; ++j) {
                for (int i = 0; i < expected.extent().width; ++i)
                    ASSERT_NEAR(image.planes[channel].at(i, j), expected.at(i, j), most) << what << ' ' << level;
            }
        }
    }
};

TEST_F(ExtrasMatrix, EveryVerbEveryEncodingEveryChannel) {
    for (const auto& row : kEncodingNames) {
        for (const Verb verb : kVerbs) {
            for (const Beside beside : kBesides) {
                if (applies(verb, beside)) check(verb, row.value, Container::ktx2, beside);
            }
        }
    }
}

// The encodings that have room, in all files that hold them. TIFF and WebP are written by another process, which takes
// time.
TEST_F(ExtrasMatrix, EveryContainer) {
    int files = 0;
    for (const auto& encoding : kEncodingNames) {
        if (!can_hold(encoding.value).blue) continue;
        for (const auto& container : kContainerNames) {
            if (container.value == Container::ktx2 || container.value == Container::jpeg) continue;  // JPEG loses
            if (!can_hold(container.value, encoding.value)) continue;
            ++files;
            for (const Verb verb : kVerbs) {
                const bool is_apart = container.value == Container::tiff || container.value == Container::webp;
                const bool is_slow = is_apart && verb != Verb::pack && verb != Verb::bake;
                for (const Beside beside : kBesides) {
                    if (applies(verb, beside) && !is_slow) check(verb, encoding.value, container.value, beside);
                }
            }
        }
    }
    EXPECT_GE(files, 25) << "DDS, PNG, EXR, TIFF, TGA, BMP";
}

// What is beside the normals is written to a file of its own, as it is in memory.
TEST_F(ExtrasMatrix, ApartInEveryContainer) {
    for (const Encoding encoding : {Encoding::rgba8, Encoding::rgba16, Encoding::rgba32f}) {
        const std::string input = source(encoding, true);
        for (const auto& container : kContainerNames) {
            for (const Format format : {Format::r8_unorm, Format::r16_unorm, Format::r16_float, Format::r32_float}) {
                if (container.value == Container::jpeg || !can_hold(container.value, format)) continue;
                PackFileOptions options;
                options.source.inspect = true;
                options.write.sync = false;
                options.pack = [](const SourceInfo&) { return PackOptions{Encoding::rgb8}; };
                options.apart.alpha = ExtraFile{path("apart"), container.value, format};
                const auto done = pack_file(input, path("out"), Container::png, options);
                ASSERT_TRUE(done) << container.name << done.error().message();
                EXPECT_TRUE(done->source.others.empty()) << container.name;
                // In memory: the plane that unpacking finds, packed alone.
                RoughnessChain alone;
                alone.levels.push_back(std::move(read_normals(input)->chain.levels[0].alpha));
                const Texture expected = pack_roughness(alone, format).value();
                ReadOptions read;  // what the name of such files says, and theirs does not
                if (container.value == Container::r16) read.raw = "16x8,u16le";
                if (container.value == Container::r32) read.raw = "16x8,f32le";
                const Image stored = read_image(path("apart"), read).value();
                const Image wanted = decode(expected, 0).value();
                for (int k = 0; k < kSide.texels(); ++k) {
                    ASSERT_EQ(stored.planes[0].at(k % kSide.width, k / kSide.width),
                              wanted.planes[0].at(k % kSide.width, k / kSide.width))
                        << container.name;
                }
            }
        }
    }
}

}  // namespace
}  // namespace tex
