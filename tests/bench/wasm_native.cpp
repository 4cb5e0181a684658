// SPDX-License-Identifier: Apache-2.0
// What wasm.mjs measures, by the native library: one thread, the least processor time of five, in Mtexel/s.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>

#include <tex/tex.h>

namespace {

constexpr int kSide = 1024;

template <class Body>
double speed(const Body& body) {
    body();
    double least = 1e9;
    for (int k = 0; k < 5; ++k) {
        const std::clock_t before = std::clock();
        body();
        least = std::min(least, static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC);
    }
    return kSide * kSide / least / 1e6;
}

}  // namespace

int main() {
    const tex::Execution alone{1, {}};
    tex::HeightField field;
    field.height = tex::Plane<float>({kSide, kSide});
    for (int j = 0; j < kSide; ++j) {
        for (int i = 0; i < kSide; ++i) {
            field.height.at(i, j) =
                static_cast<float>(std::sin(i / 7.0) * std::cos(j / 11.0) + 0.3 * std::sin((i + 2 * j) / 3.0));
        }
    }
    field.bumpiness_x = field.bumpiness_y = 4.0f;
    tex::MipChain chain;
    chain.levels.push_back(*tex::bake(field, {}, alone));
    const auto baked = [&] { return tex::bake(field, {}, alone).has_value(); };
    std::printf("bake : %.2f Mtexel/s (%s)\n", speed(baked), tex::runtime().instruction_set.c_str());
    for (const tex::Encoding encoding : {tex::Encoding::bc5, tex::Encoding::astc_4x4, tex::Encoding::uastc}) {
        for (const tex::Effort effort : {tex::Effort::fast, tex::Effort::normal}) {
            tex::PackOptions options;
            options.encoding = encoding;
            options.effort = effort;
            const auto packed = [&] { return tex::pack(chain, options, alone).has_value(); };
            std::printf("%s %s: %.2f Mtexel/s\n", std::string(tex::name_of(tex::kEncodingNames, encoding)).c_str(),
                        std::string(tex::name_of(tex::kEffortNames, effort)).c_str(), speed(packed));
        }
    }
}
