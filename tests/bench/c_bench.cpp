// SPDX-License-Identifier: Apache-2.0
// c_bench: the functions of tex_c.h beside the verbs of C++, on one thread. A verb makes its result and C fills memory
// of the caller, so both are timed with the memory of the result already touched: the verb keeps one result alive while
// it makes the next. Prints the least processor time of some rounds, in which the two alternate, and the ratio.
//
//     c_bench [SIDE]      1024 texels by default

#include <tex/tex_c.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <vector>

#include <tex/tex.h>

#include "unit/fields.h"

namespace {

constexpr int kRounds = 11;

// Processor time of this thread, which other programs disturb least.
double now() {
    timespec time = {};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double seconds(const std::function<void()>& body) {
    const double start = now();
    body();
    return now() - start;
}

void row(const char* name, const std::function<void()>& verb, const std::function<void()>& c) {
    verb();
    c();
    double of_verb = 1e9, of_c = 1e9;
    for (int k = 0; k < kRounds; ++k) {
        of_verb = std::min(of_verb, seconds(verb));
        of_c = std::min(of_c, seconds(c));
    }
    std::printf("| %-22s | %8.2f | %8.2f | %5.2f |\n", name, of_verb * 1e3, of_c * 1e3, of_c / of_verb);
}

tex_map view(tex::NormalMap& map) {
    return {map.x.row(0), map.y.row(0), map.z.row(0), map.x.stride(), map.extent().width, map.extent().height};
}

void check(int32_t error) {
    if (error == TEX_OK) return;
    std::fprintf(stderr, "c_bench: %s\n", tex_error_text(error));
    std::exit(1);
}

const tex::Execution kOneThread{1, {}};

void heights_and_levels(int side, const tex::NormalMap& normals) {
    const tex::Extent extent{side, side};
    tex::HeightField field;
    field.height =
        tex::fields::plane_of(extent, [](int i, int j) { return 0.5 + 0.4 * std::sin(0.05 * i + 0.03 * j); });
    tex::NormalMap out(extent), half({side / 2, side / 2});
    const tex_map to = view(out), smaller = view(half);
    const tex_plane heights = {field.height.row(0), field.height.stride(), side, side};
    std::vector<unsigned char> scratch(std::size_t{64} << 20);
    for (const int32_t kernel : {TEX_KERNEL_CENTRAL, TEX_KERNEL_SOBEL, TEX_KERNEL_GAUSSIAN}) {
        tex_bake_options options = TEX_BAKE_OPTIONS;
        options.kernel = kernel;
        tex::Result<tex::NormalMap> made = tex::NormalMap();
        row(
            kernel == TEX_KERNEL_CENTRAL ? "bake, central"
            : kernel == TEX_KERNEL_SOBEL ? "bake, sobel"
                                         : "bake, gaussian",
            [&] {
                made = tex::bake(field, {static_cast<tex::GradientKernel>(kernel), 1.0f}, kOneThread);
            },
            [&] { check(tex_bake(&heights, &options, 0, side, &to, scratch.data(), scratch.size())); });
    }
    for (const int32_t filter : {TEX_FILTER_BOX, TEX_FILTER_KAISER}) {
        tex_mip_options options = TEX_MIP_OPTIONS;
        options.filter = filter;
        tex::MipOptions verb;
        verb.filter = static_cast<tex::MipFilter>(filter);
        verb.levels = 2;
        // The verb takes its base level: what it makes is timed without copying that.
        tex::NormalMap copy = tex::fields::noise_normals(extent);
        const tex_map from = view(copy);
        row(
            filter == TEX_FILTER_BOX ? "one mip level, box" : "one mip level, kaiser",
            [&] {
                tex::NormalMap base;
                base.x = tex::Plane<float>(extent, normals.x.stride(), {std::shared_ptr<float>(), copy.x.row(0)});
                base.y = tex::Plane<float>(extent, normals.x.stride(), {std::shared_ptr<float>(), copy.y.row(0)});
                base.z = tex::Plane<float>(extent, normals.x.stride(), {std::shared_ptr<float>(), copy.z.row(0)});
                if (!tex::build_mip_chain(std::move(base), verb, kOneThread)) std::exit(1);
            },
            [&] {
                check(tex_mip_level(&from, 0, &options, 0, side / 2, &smaller, scratch.data(), scratch.size()));
                check(tex_mip_finish(&smaller, 1, &options, 0, side / 2));
            });
    }
}

void encodings(int side, tex::NormalMap& normals) {
    const tex_map map = view(normals);
    tex::MipChain chain;
    chain.levels.push_back(std::move(normals));
    tex::NormalMap out({side, side});
    const tex_map to = view(out);
    std::vector<unsigned char> bytes(std::size_t{16} * static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    std::vector<unsigned char> scratch(std::size_t{64} << 20);
    for (const tex::Encoding encoding : {tex::Encoding::bc5, tex::Encoding::dxt5nm, tex::Encoding::eac_rg11,
                                         tex::Encoding::rgb8, tex::Encoding::half}) {
        tex_encode_options options = TEX_ENCODE_OPTIONS;
        options.encoding = static_cast<int32_t>(encoding);
        tex::PackOptions verb;
        verb.encoding = encoding;
        const std::string name(tex::name_of(tex::kEncodingNames, encoding));
        tex::Result<tex::Texture> packed = tex::Texture();
        const int32_t format = tex_encoding_format(options.encoding);
        const std::size_t pitch = tex_row_bytes(format, side);
        row((name + ", encode").c_str(), [&] { packed = tex::pack(chain, verb, kOneThread); },
            [&] { check(tex_encode(&map, &options, 0, side, bytes.data(), pitch, scratch.data(), scratch.size())); });
        tex_unpack_options unpack = TEX_UNPACK_OPTIONS;
        unpack.swizzle[0] = static_cast<unsigned char>(packed->swizzle[0]);
        for (std::size_t k = 0; k < 4; ++k) unpack.swizzle[k] = static_cast<unsigned char>(packed->swizzle[k]);
        const tex_texels texels = {bytes.data(), pitch, format, side, side};
        tex::Result<tex::MipChain> unpacked = tex::MipChain();
        row((name + ", unpack").c_str(), [&] { unpacked = tex::unpack(*packed, {}, kOneThread); },
            [&] { check(tex_unpack(&texels, &unpack, 0, side, &to)); });
    }
}

}  // namespace

int main(int argc, char** argv) {
    const int side = argc > 1 ? std::atoi(argv[1]) : 1024;
    std::printf("%dx%d texels, one thread, milliseconds\n\n", side, side);
    std::printf("| what                   |      C++ |        C | ratio |\n|---|--:|--:|--:|\n");
    tex::NormalMap normals = tex::fields::noise_normals({side, side});
    heights_and_levels(side, normals);
    encodings(side, normals);
    return 0;
}
