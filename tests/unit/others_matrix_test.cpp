// SPDX-License-Identifier: Apache-2.0
// Every verb, every encoding, and what is beside the normals: nothing, kept, dropped, given, more than there is room
// for. Kept data stay to the last bit where the depth is the same, smaller levels hold the reference of their kind, a
// channel is named exactly where it is lost, and files and memory give the same bytes.

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <tex/blend.h>
#include <tex/file.h>
#include <tex/mip.h>
#include <tex/pipeline.h>

#include "unit/normal_maps.h"
#include "unit/streams.h"

namespace tex {
namespace {

constexpr Extent kSide{16, 8};

enum class Verb { pack, mip, scale, blend };
enum class Beside { nothing, kept, dropped, given_alpha, given_blue, given_length };

constexpr Verb kVerbs[] = {Verb::pack, Verb::mip, Verb::scale, Verb::blend};
constexpr Beside kBesides[] = {Beside::nothing,     Beside::kept,       Beside::dropped,
                               Beside::given_alpha, Beside::given_blue, Beside::given_length};

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

class OthersMatrix : public StreamTest {
protected:
    // A file of this encoding, with data in alpha unless there is to be none.
    std::string source(Encoding encoding, bool has_alpha) {
        NormalMap map = wavy_map(kSide);
        if (has_alpha) map.alpha = data(7);
        const auto bytes = encode_file(pack(chain_from(std::move(map)), {encoding}).value(), Container::ktx2);
        return StreamTest::write("in.ktx2", *bytes);
    }
    static OtherInputs inputs(Beside beside) {
        const auto give = []() -> Result<Plane<float>> { return data(11); };
        OtherInputs inputs;
        if (beside == Beside::given_alpha) inputs.alpha = OtherData{1.0f, give};
        if (beside == Beside::given_blue) inputs.blue = OtherData{1.0f, give};
        if (beside == Beside::given_length) inputs.length = OtherData{1.0f, give};
        return inputs;
    }
    SourceOptions reading(Beside beside) const {
        SourceOptions options;
        options.inspect = true;
        options.drop_others = beside == Beside::dropped;
        return options;
    }
    // From file to file. Returns the channels that were lost, as letters.
    Result<std::string> stream(Verb verb, const std::string& input, Encoding encoding, Beside beside) {
        const auto packing = [encoding](const SourceInfo&) { return PackOptions{encoding, YAxis::up, Effort::fast}; };
        const auto names = [](const SourceInfo& info) {
            std::string names;
            for (const OtherChannel& other : info.others) names += other.name;
            return names;
        };
        if (verb == Verb::blend) {
            BlendFileOptions options;
            options.source = reading(beside);
            options.layers.emplace_back().input = input;
            options.pack = packing;
            options.write.sync = false;
            options.others = inputs(beside);
            const auto done = blend_file(input, path("out"), Container::ktx2, options);
            return done ? Result<std::string>(names(done->source)) : done.error();
        }
        PackFileOptions options;
        options.source = reading(beside);
        if (verb == Verb::mip) options.mip = MipOptions();
        if (verb == Verb::scale) options.scale = Scaling{0.5f, ScaleMode::slope};
        options.pack = packing;
        options.write.sync = false;
        options.others = inputs(beside);
        const auto done = pack_file(input, path("out"), Container::ktx2, options);
        return done ? Result<std::string>(names(done->source)) : done.error();
    }
    // The same in memory.
    Bytes memory(Verb verb, const std::string& input, Encoding encoding, Beside beside) {
        MipChain chain = std::move(read_normals(input, reading(beside))->chain);
        if (verb == Verb::blend) {
            std::vector<Layer> layers(1);
            layers[0].detail = std::move(read_normals(input)->chain);
            chain = chain_from(blend(std::move(chain), std::move(layers)).value());
        }
        if (verb == Verb::scale) chain = scale(std::move(chain), 0.5f).value();
        EXPECT_TRUE(put_others(chain.levels[0], inputs(beside), encoding));
        if (verb == Verb::mip || verb == Verb::blend) chain = build_mip_chain(std::move(chain.levels[0])).value();
        return encode_file(pack(chain, {encoding, YAxis::up, Effort::fast}).value(), Container::ktx2).value();
    }
    // Compares a stored channel of all levels with the data of the base level.
    void expect_data(std::size_t channel, Plane<float> expected, const FormatInfo& format, const std::string& what) {
        const Texture texture = read_texture(path("out")).value();
        for (int level = 0; level < std::min(3, static_cast<int>(texture.levels.size())); ++level) {
            if (level > 0) expected = halved(expected);
            const bool is_exact = level == 0 && (format.bits != 16 || format.sample == SampleKind::unorm);
            const float codes = format.bits == 8 ? 255.0f : format.bits == 16 ? 2048.0f : 1e6f;
            const float most = is_exact ? 1e-7f : 0.501f / codes;
            const Image image = decode(texture, level).value();
            for (int j = 0; j < expected.extent().height; ++j) {
                for (int i = 0; i < expected.extent().width; ++i)
                    ASSERT_NEAR(image.planes[channel].at(i, j), expected.at(i, j), most) << what << ' ' << level;
            }
        }
    }
};

TEST_F(OthersMatrix, EveryVerbEveryEncodingEveryChannel) {
    const Encoding sources[] = {Encoding::rgba8, Encoding::rgba16, Encoding::rgba32f};
    for (const auto& row : kEncodingNames) {
        const OtherPlanes held = can_hold(row.value);
        const FormatInfo format = format_info(encoding_info(row.value).format);
        for (const Verb verb : kVerbs) {
            for (const Beside beside : kBesides) {
                const Encoding from = sources[(static_cast<std::size_t>(verb) + static_cast<std::size_t>(beside)) % 3];
                const std::string what = std::string(row.name) + " verb " + std::to_string(static_cast<int>(verb)) +
                                         " beside " + std::to_string(static_cast<int>(beside));
                const std::string input = source(from, beside != Beside::nothing);
                const auto lost = stream(verb, input, row.value, beside);
                const bool has_room = (beside != Beside::given_alpha || held.alpha) &&
                                      (beside != Beside::given_blue || held.blue) &&
                                      (beside != Beside::given_length || held.length);
                ASSERT_EQ(static_cast<bool>(lost), has_room) << what;
                if (!has_room) {
                    EXPECT_NE(lost.error().reason.find("these formats have: "), std::string::npos) << what;
                    continue;
                }
                const bool has_alpha = beside != Beside::nothing && beside != Beside::dropped;
                const bool keeps = has_alpha && beside != Beside::given_alpha;
                EXPECT_EQ(*lost, keeps && !held.alpha ? "A" : "") << what;
                EXPECT_EQ(bytes_of(path("out")), memory(verb, input, row.value, beside)) << what;
                if (held.alpha && keeps) expect_data(3, data(7), format, what);
                if (held.alpha && !has_alpha) expect_data(3, Plane<float>(kSide, 1.0f), format, what);
                if (beside == Beside::given_alpha) expect_data(3, data(11), format, what);
                if (beside == Beside::given_blue) expect_data(2, data(11), format, what);
            }
        }
    }
}

}  // namespace
}  // namespace tex
