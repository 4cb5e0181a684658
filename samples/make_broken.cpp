// SPDX-License-Identifier: Apache-2.0
// make_broken: writes samples/broken, which has one file for each rule of check-normals. Only that rule reports the
// file. Rules about meshes also have a mesh, in samples/broken/meshes. Rules about models have a model. All files are
// made from the sample height map. FOLDER/options.txt lists the options for checking each file.
//
//     make_broken samples/waves.png FOLDER

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <tex/tex.h>

#include "broken_meshes.h"
#include "broken_tiff.h"
#include "reference/astc_block.h"
#include "reference/damage.h"

namespace {

using namespace tex;
using namespace tex::reference;

struct Maker {
    std::string folder;
    NormalMap base;  // 128x128, y up, tiles
    bool failed = false;

    void write(const std::string& name, std::vector<std::byte> bytes) {
        WriteOptions options;
        options.sync = false;
        if (const auto written = write_file(folder + "/" + name, bytes, options); !written) fail(written.error());
    }
    void fail(const Error& error) {
        std::fprintf(stderr, "make_broken: error: %s\n", error.message().c_str());
        failed = true;
    }
    std::vector<std::byte> encoded(const Texture& texture, Container container, WriteOptions options = {}) {
        Texture stored = texture;
        if (container == Container::dds) stored.swizzle_known = stored.y_known = false;  // as other tools write them
        auto bytes = encode_file(stored, container, options);
        if (bytes) return std::move(*bytes);
        fail(bytes.error());
        return std::vector<std::byte>(256);
    }
    void png(const std::string& name, const Codes& codes) {
        write(name + ".png", encoded(texture_of(codes), Container::png));
    }
    void dds(const std::string& name, const Texture& texture) {
        write(name + ".dds", encoded(texture, Container::dds));
    }

    [[nodiscard]] Codes codes() const { return codes_of(base); }
    [[nodiscard]] NormalMap part(int width, int height) const { return crop(base, 0, 0, {width, height}); }
    Texture packed(NormalMap map, Encoding encoding, YAxis y = YAxis::up) {
        MipChain chain;
        chain.levels.push_back(std::move(map));
        auto texture = pack(chain, {encoding, y, Effort::fast});
        if (!texture) fail(texture.error());
        return texture ? std::move(*texture) : Texture{};
    }

    void files();
    void values();
    void damages();
    void conventions();
    void levels();
    void mesh(const std::string& id, const MeshPart& part);
    void tangents();
    void seams();
    void padding();
    void model(const std::string& name, const MeshPart& part, const BrokenMaterial& material);
    void models();
};

// Every `step`-th texel becomes (r, g, b).
Codes dotted(Codes codes, int step, int r, int g, int b) {
    const int texels = static_cast<int>(codes.extent.texels());
    for (int k = 0; k < texels; k += step) {
        const int color[3] = {r, g, b};
        for (int c = 0; c < 3; ++c)
            codes.at(k % codes.extent.width, k / codes.extent.width, c) = static_cast<unsigned char>(color[c]);
    }
    return codes;
}

void set_slopes(NormalMap& map, int i, int j, double p, double q) {
    const double length = std::sqrt(p * p + q * q + 1.0);
    map.x.at(i, j) = static_cast<float>(-p / length);
    map.y.at(i, j) = static_cast<float>(-q / length);
    map.z.at(i, j) = static_cast<float>(1.0 / length);
}

// The map, with `change` applied to its slopes.
template <class Change>
NormalMap changed(const NormalMap& map, Change&& change) {
    NormalMap result(map.extent());
    for (int j = 0; j < map.extent().height; ++j) {
        for (int i = 0; i < map.extent().width; ++i) {
            double p = -map.x.at(i, j) / map.z.at(i, j), q = -map.y.at(i, j) / map.z.at(i, j);
            change(i, j, p, q);
            set_slopes(result, i, j, p, q);
        }
    }
    return result;
}

// ASTC with x, y and z in R, G and B, as colours: a block of 4x4 texels for each texel of the map.
Texture astc_colors(const NormalMap& map) {
    Texture texture;
    texture.format = Format::astc_4x4_unorm;
    texture.levels = {{{4 * map.extent().width, 4 * map.extent().height}, {}}};
    const auto code = [](float c) { return static_cast<unsigned>(std::lround((c + 1.0f) / 2.0f * 65535.0f)); };
    for (int k = 0; k < map.extent().texels(); ++k) {
        const int i = k % map.extent().width, j = k / map.extent().width;
        const AstcBlock block =
            one_color(false, {code(map.x.at(i, j)), code(map.y.at(i, j)), code(map.z.at(i, j)), 65535});
        texture.levels[0].bytes.insert(texture.levels[0].bytes.end(), block.begin(), block.end());
    }
    return texture;
}

void Maker::files() {
    std::vector<std::byte> whole = encoded(packed(part(64, 64), Encoding::bc5), Container::dds);
    auto bytes = whole;
    bytes.resize(bytes.size() / 2);
    write("N101-unreadable.dds", bytes);
    bytes = whole;
    bytes[4] = std::byte{24};  // the size of the header
    write("N102-header-disagrees.dds", bytes);
    auto chain = chain_of(part(64, 64), ChainFault::none);
    chain.resize(3);
    dds("N103-mips-incomplete", texture_of(chain));
    bytes = whole;
    bytes.resize(bytes.size() + 16);
    write("N104-trailing-bytes.dds", bytes);
    png("N105-not-power-of-two", codes_of(part(96, 64)));
    dds("N106-not-multiple-of-4", packed(part(66, 64), Encoding::bc5));
    for (const char* name : {"N107-too-large", "N108-wrong-format", "N109-wrong-levels", "N110-wrong-extent"})
        png(name, codes_of(part(64, 64)));
    WriteOptions dx10;
    dx10.dds_header = DdsHeader::dx10;
    bytes = encoded(packed(part(64, 64), Encoding::rgba8), Container::dds, dx10);
    bytes[128] = std::byte{29};  // DXGI_FORMAT_R8G8B8A8_UNORM_SRGB
    write("N111-srgb-format.dds", bytes);
    write("N112-wrong-declared-y.ktx2", encoded(packed(part(16, 16), Encoding::rgba8, YAxis::down), Container::ktx2));
    dds("N113-unfit-for-engine", packed(part(128, 128), Encoding::bc5));
    Texture texture = packed(part(16, 16), Encoding::bc5);
    texture.swizzle_known = texture.y_known = false;
    bytes = encoded(texture, Container::ktx2);
    const auto descriptor = std::to_integer<std::size_t>(bytes[48]);
    bytes[12] = bytes[13] = std::byte{0};     // VK_FORMAT_UNDEFINED
    bytes[descriptor + 12] = std::byte{166};  // KHR_DF_MODEL_UASTC
    bytes[descriptor + 31] = std::byte{4};    // KHR_DF_CHANNEL_UASTC_RRR
    for (std::size_t k = 256; k > 0; --k)
        bytes[bytes.size() - k] = static_cast<std::byte>(k % 16 == 0 ? 0x17 : k % 16 > 11 ? 0xfe - k / 16 : 0);
    write("N114-uastc-without-alpha.ktx2", bytes);
    write("N115-astc-layout.astc", encoded(astc_colors(part(16, 16)), Container::astc));
    write("N116-turned-by-tag.tif", turned_tiff(codes_of(part(32, 32))));
}

void Maker::values() {
    NormalMap shorter = part(128, 128);
    for (Plane<float>* plane : {&shorter.x, &shorter.y, &shorter.z}) {
        for (int k = 0; k < 128 * 128; ++k) plane->at(k % 128, k / 128) *= 0.9f;
    }
    png("N201-not-unit-length", codes_of(shorter));
    png("N202-z-below-zero", dotted(codes(), 101, 248, 128, 89));
    Texture texture = packed(part(128, 128), Encoding::rg8);
    for (std::size_t k = 0; k < texture.levels[0].bytes.size(); k += 202)
        texture.levels[0].bytes[k] = texture.levels[0].bytes[k + 1] = std::byte{250};
    dds("N203-beyond-unit", texture);
    texture = packed(part(64, 64), Encoding::float_);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(texture.levels[0].bytes.data() + 12000, &nan, sizeof nan);
    dds("N204-not-finite", texture);
    png("N205-null-vector", dotted(codes(), 101, 128, 128, 128));
    png("N206-constant", dotted(codes_of(part(32, 32)), 1, 140, 120, 254));
    png("N207-leaning", codes_of(changed(base, [](int, int, double& p, double&) { p += 0.4; })));
    png("N208-biased-flat", codes_of(changed(base, [](int i, int, double& p, double& q) {
            if (i < 64) p = q = 0.0;
        })));
    Codes filled = codes(), grey = codes();
    for (int k = 0; k < 128 * 128; ++k) {
        filled.at(k % 128, k / 128, 2) = 255;
        grey.at(k % 128, k / 128, 1) = grey.at(k % 128, k / 128, 2) = grey.at(k % 128, k / 128, 0);
    }
    png("N209-blue-not-z", filled);
    png("N210-grey-picture", grey);
    texture = packed(part(64, 64), Encoding::ag8);
    for (std::size_t k = 0; k < texture.levels[0].bytes.size(); k += 4) texture.levels[0].bytes[k] = std::byte{0};
    dds("N211-dxt5nm-red", texture);
    texture = packed(part(64, 64), Encoding::rgba8);
    for (std::size_t k = 3; k < texture.levels[0].bytes.size(); k += 4) texture.levels[0].bytes[k] = std::byte{200};
    dds("N212-alpha-not-one", texture);
    NormalMap object = part(128, 128);  // the same bumps on surfaces that face up, and backwards
    for (int k = 0; k < 128 * 64; ++k) {
        const int i = k % 128, j = k / 128;
        std::swap(object.y.at(i, j), object.z.at(i, j));
        object.z.at(i, j + 64) = -object.z.at(i, j + 64);
    }
    png("N213-object-space", codes_of(object));
    Codes colors = codes();  // bricks in brown and mortar in grey
    for (int k = 0; k < 128 * 128; ++k) {
        const int i = k % 128, j = k / 128, shade = colors.at(i, j, 0) / 8;
        const bool mortar = i % 32 < 3 || j % 16 < 3;
        colors.at(i, j, 0) = static_cast<unsigned char>(mortar ? 150 + shade : 140 + 2 * shade);
        colors.at(i, j, 1) = static_cast<unsigned char>(mortar ? 148 + shade : 60 + shade);
        colors.at(i, j, 2) = static_cast<unsigned char>(mortar ? 140 + shade : 45 + shade);
    }
    png("N214-not-a-normal-map", colors);
    Codes orm = codes();  // a metal grid on rough stone
    for (int k = 0; k < 128 * 128; ++k) {
        const int i = k % 128, j = k / 128, shade = orm.at(i, j, 0) / 8;
        const bool metal = i % 32 < 3 || j % 16 < 3;
        orm.at(i, j, 0) = static_cast<unsigned char>(224 + shade);
        orm.at(i, j, 1) = static_cast<unsigned char>(metal ? 60 + shade : 180 + shade);
        orm.at(i, j, 2) = metal ? 255 : 0;
    }
    png("N216-occlusion-roughness-metal", orm);
    // Alpha: the cut-out of a disc; x once more. Blue: occlusion of a grid of hollows.
    Texture mask = packed(part(64, 64), Encoding::rgba8), twice = packed(part(64, 64), Encoding::rgba8);
    for (std::size_t k = 0; k < 64 * 64; ++k) {
        const int i = static_cast<int>(k % 64) - 32, j = static_cast<int>(k / 64) - 32;
        mask.levels[0].bytes[4 * k + 3] = std::byte{i * i + j * j < 900 ? std::uint8_t{255} : std::uint8_t{0}};
        twice.levels[0].bytes[4 * k + 3] = twice.levels[0].bytes[4 * k];
    }
    write("N217-alpha-is-mask.png", encoded(mask, Container::png));
    write("N218-alpha-repeats.png", encoded(twice, Container::png));
    Codes occluded = codes();
    for (int k = 0; k < 128 * 128; ++k) {
        const int i = k % 128, j = k / 128;
        occluded.at(i, j, 2) = static_cast<unsigned char>(235 - 4 * std::abs(i % 28 - 14) - 4 * std::abs(j % 22 - 11));
    }
    png("N219-blue-other-data", occluded);
    const Codes base_codes = codes();
    Codes inverted = base_codes, from_zero = base_codes, lost = base_codes, x_ray{{128, 128}, 4, {}};
    x_ray.values.resize(4 * 128 * 128);
    const Codes steep = codes_of(*scale(part(128, 128), 3.0f));
    for (int k = 0; k < 128 * 128; ++k) {
        const int i = k % 128, j = k / 128;
        inverted.at(i, j, 2) = static_cast<unsigned char>(255 - inverted.at(i, j, 2));
        for (int c = 0; c < 2; ++c) from_zero.at(i, j, c) = steep.at(i, j, c);
        from_zero.at(i, j, 2) = static_cast<unsigned char>(std::max(0, 2 * steep.at(i, j, 2) - 255));
        lost.at(i, j, 0) = lost.at(i, j, 2) = 255;
        x_ray.at(i, j, 0) = static_cast<unsigned char>(40 + 6 * std::abs(i % 28 - 14));
        x_ray.at(i, j, 1) = base_codes.at(i, j, 2);
        x_ray.at(i, j, 2) = base_codes.at(i, j, 1);
        x_ray.at(i, j, 3) = base_codes.at(i, j, 0);
    }
    png("N220-blue-inverted", inverted);
    png("N221-blue-from-zero", from_zero);
    png("N222-x-lost", lost);
    png("N223-x-ray-layout", x_ray);
    Codes unfilled = codes();
    for (int k = 0; k < 64 * 48 * 3; ++k) unfilled.at(80 + k / 3 % 48, 64 + k / 3 / 48, k % 3) = 0;
    png("N215-background", unfilled);
}

void Maker::damages() {
    png("N301-srgb-decoded", srgb_decode(codes()));
    png("N302-srgb-encoded", srgb_encode(codes()));
    png("N303-premultiplied", with_alpha(codes(), true));
    png("N304-jpeg-blocks", jpeg(codes(), 30));
    Codes whole_codes = codes(), enlarged = whole_codes, blocks = whole_codes;
    for (int k = 0; k < 128 * 128; ++k) {
        for (int c = 0; c < 3; ++c) {
            enlarged.at(k % 128, k / 128, c) = whole_codes.at(k % 128 / 2, k / 256, c);  // each four times
            blocks.at(k % 128, k / 128, c) = whole_codes.at(k % 128, k / 512 * 4, c);    // four in 4x4
        }
    }
    const auto gamma = [](int code) { return static_cast<int>(std::floor(255.0 * std::pow(code / 255.0, 0.8) + 0.5)); };
    png("N312-scaled-up", enlarged);
    png("N313-darkened", with_curve(codes(), [](int code) { return code * 3 / 5; }));
    png("N314-levels-changed", with_curve(codes(), gamma));
    png("N315-posterised",
        with_curve(codes_of(*scale(part(128, 128), 2.0f)), [](int code) { return (code + 8) / 17 * 17; }));
    const NormalMap fine = changed(base, [](int i, int j, double& p, double& q) {
        for (double* slope : {&p, &q}) *slope += 0.35 * std::cos(2.1 * (i + j));
    });
    png("N316-chroma-subsampled", jpeg(codes_of(fine), 95));
    png("N317-palette", with_palette(codes(), 9));
    png("N305-banding", codes_of(from_heights(tex::reference::integrate(base), 64)));
    png("N306-bc-blocks", blocks);
    png("N307-seam", codes_of(part(96, 96)));
    png("N308-channels-exchanged", exchange(codes(), 0, 2));
    png("N309-turned", codes_of(turn_picture(base, 30.0)));
    png("N310-no-surface", codes_of(changed(base, [state = 1u](int, int, double& p, double& q) mutable {
            for (double* slope : {&p, &q}) *slope = ((state = state * 1664525u + 1013904223u) >> 16) / 65536.0 - 0.5;
        })));
    Texture eac = packed(part(128, 128), Encoding::eac_rg11_snorm);
    eac.format = Format::eac_rg11_unorm;
    write("N311-wrong-sign.ktx2", encoded(eac, Container::ktx2));
}

void Maker::conventions() {
    png("N401-wrong-y", flip_green(codes()));
    Codes half = codes();
    const Codes flipped = flip_green(half);
    for (int k = 0; k < 128 * 64; ++k) half.at(k % 128, k / 128, 1) = flipped.at(k % 128, k / 128, 1);
    png("N402-mixed-y", half);
    // Waves along x and waves along y: no slope changes across its own direction, whichever way green points.
    const auto waves = [](int k) { return 0.2 * std::sin(k * 0.147262) + 0.15 * std::sin(k * 0.343612 + 1.0); };
    png("N403-y-undecidable",
        codes_of(changed(base, [&](int i, int j, double& p, double& q) { p = waves(i), q = waves(j); })));
    Texture texture = packed(part(128, 128), Encoding::bc5);
    texture.y_axis = YAxis::down;
    write("N404-y-contradicts-file.ktx2", encoded(texture, Container::ktx2));
}

void Maker::levels() {
    const NormalMap steep = changed(base, [](int, int, double& p, double& q) { p *= 2.0, q *= 2.0; });
    dds("N501-level-not-unit", texture_of(chain_of(steep, ChainFault::not_normalised)));
    auto chain = chain_of(base, ChainFault::none);
    const auto other =
        chain_of(changed(base, [](int, int, double& p, double& q) { std::swap(p, q), p = -p; }), ChainFault::none);
    for (std::size_t k = 1; k < chain.size(); ++k) chain[k] = other[k];
    dds("N502-level-unrelated", texture_of(chain));
    dds("N503-level-shifted", texture_of(chain_of(base, ChainFault::shifted)));
    chain = chain_of(base, ChainFault::none);
    const auto weaken = [](int, int, double& p, double& q) { p *= 0.4, q *= 0.4; };
    const auto faded = chain_of(changed(base, weaken), ChainFault::none);
    for (std::size_t k = 2; k < chain.size(); ++k) chain[k] = faded[k];
    dds("N504-fade-unfinished", texture_of(chain));
    const Codes right = codes();
    Codes mirrored = right;  // left and right exchanged: valid normals of other heights
    for (int k = 0; k < 3 * 128 * 128; ++k) {
        const int c = k % 3, i = k / 3 % 128, j = k / 3 / 128, code = right.at(127 - i, j, c);
        mirrored.at(i, j, c) = static_cast<unsigned char>(c == 0 ? 255 - code : code);
    }
    png("N601-height-mismatch", mirrored);
    const auto invert = [](int, int, double& p, double& q) { p = -p, q = -q; };
    for (const char* name : {"N602-height-inverted", "N603-occlusion-mismatch"})
        png(name, codes_of(changed(base, invert)));
}

void Maker::mesh(const std::string& id, const MeshPart& part) {
    const std::string glb = glb_of_part(part);
    std::vector<std::byte> bytes(glb.size());
    std::memcpy(bytes.data(), glb.data(), glb.size());
    write("meshes/" + id + ".glb", std::move(bytes));
}

void Maker::tangents() {
    const auto put = [&](const char* id, const char* name, auto&& change) {
        MeshPart sheet = broken_sheet();
        change(sheet.tangents);
        mesh(id, sheet);
        png(std::string(id) + "-" + name, codes_of(part(64, 64)));
    };
    using Tangents = std::vector<Float4>;
    put("N701", "tangents-missing", [](Tangents& all) { all.clear(); });
    put("N702", "tangents-not-unit", [](Tangents& all) {
        for (std::size_t k = 0; k < all.size(); k += 3)
            all[k] = {0.5f * all[k].x, 0.5f * all[k].y, 0.5f * all[k].z, all[k].w};
    });
    put("N703", "tangent-sign-not-one", [](Tangents& all) { all[7].w = 0.5f; });
    put("N704", "tangent-sign-mixed", [](Tangents& all) { all[12].w = -all[12].w; });
    put("N705", "tangents-not-mikktspace", [](Tangents& all) {  // turned by 14 degrees about z
        for (Float4& t : all) {
            const Float3 turned = unit_vector({t.x - 0.25f * t.y, t.y + 0.25f * t.x, t.z});
            t = {turned.x, turned.y, turned.z, t.w};
        }
    });
    put("N706", "tangent-sign-opposite", [](Tangents& all) {
        for (Float4& t : all) t.w = -t.w;
    });
    MeshPart opposite = broken_sheet();
    for (Float4& t : opposite.tangents) t.w = -t.w;
    mesh("N707", opposite);
    png("N707-sign-and-green-cancel", flip_green(codes()));
}

// A cube whose normals are smooth over its edges, with bumps that depend on the place in space alone. Green points the
// wrong way.
void Maker::seams() {
    const Solid cube = smooth_cube();
    const MeshPart part = with_tangents(cube.part);
    mesh("N711", part);
    const auto tangents = stored_tangents(part);
    if (!tangents) return fail(tangents.error());
    const TangentSpace space{part, *tangents};
    NormalMap flat({128, 128});
    flat.x = Plane<float>({128, 128}, 0.0f);
    flat.y = Plane<float>({128, 128}, 0.0f);
    flat.z = Plane<float>({128, 128}, 1.0f);
    auto surface = to_object_space(flat, space);
    if (!surface) return fail(surface.error());
    NormalMap& normals = surface->map;
    for (int k = 0; k < 128 * 128; ++k) {
        float &x = normals.x.at(k % 128, k / 128), &y = normals.y.at(k % 128, k / 128),
              &z = normals.z.at(k % 128, k / 128);
        const Float3 n = unit_vector({x + 0.8f * y * z, y - 0.9f * z * x, z + 0.7f * x * y});
        x = n.x, y = n.y, z = n.z;
    }
    const auto map = to_tangent_space(normals, space);
    if (!map) return fail(map.error());
    png("N711-other-tangent-space", flip_green(codes_of(map->map)));
    mesh("N721", part);
    png("N721-object-space-on-mesh", codes_of(normals));
    mesh("N722", two_sheets(true));
    png("N722-charts-mirrored", codes_of(this->part(64, 64)));
    mesh("N723", two_sheets(false));
    png("N723-charts-overlap", codes_of(this->part(64, 64)));
    padding();
}

// A chart on a background without padding. Its rows are the same, so that the picture is small.
void Maker::padding() {
    constexpr int kSize = 256, kBorder = 11;
    MeshPart sheet = broken_sheet();
    for (Float2& uv : sheet.uvs[0]) {
        const auto place = [](float t) { return (kBorder + (kSize - 2 * kBorder) * t) / kSize; };
        uv = {place(uv.x), place(uv.y)};
    }
    mesh("N724", sheet);
    NormalMap map({kSize, kSize});
    for (int k = 0; k < kSize * kSize; ++k) {
        const int i = k % kSize, j = k / kSize;
        const bool inside = std::min({i, j, kSize - 1 - i, kSize - 1 - j}) >= kBorder;
        const float z = base.z.at(i % 128, 5), x = base.x.at(i % 128, 5);
        const Float3 n = unit_vector(inside ? Float3{x, 0.0f, z} : Float3{0.5f, 0.3f, 0.8f});
        map.x.at(i, j) = n.x, map.y.at(i, j) = n.y, map.z.at(i, j) = n.z;
    }
    png("N724-padding-too-small", codes_of(map));
    const std::string twisted =
        "v 0 0 0\nv 1 0 0.2\nv 1 1 0\nv 0 1 0.2\n"
        "vn -0.3 -0.3 1\nvn 0.3 -0.3 1\nvn -0.3 -0.3 1\nvn -0.3 0.3 1\n"
        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1/1 2/2/2 3/3/3 4/4/4\n";
    std::vector<std::byte> bytes(twisted.size());
    std::memcpy(bytes.data(), twisted.data(), twisted.size());
    write("meshes/N731.obj", std::move(bytes));
    png("N731-quads-ambiguous", codes_of(part(64, 64)));
}

void Maker::model(const std::string& name, const MeshPart& part, const BrokenMaterial& material) {
    const std::string glb = glb_of_part(part, material);
    std::vector<std::byte> bytes(glb.size());
    std::memcpy(bytes.data(), glb.data(), glb.size());
    write(name + ".glb", std::move(bytes));
}

void Maker::models() {
    const std::vector<std::byte> image = encoded(texture_of(codes_of(part(64, 64))), Container::png);
    const auto put = [&](const std::string& name, const MeshPart& on, const std::string& json, const char* uses = "") {
        model(name, on, {json, R"("source":0)", image, "image/png", uses});
    };
    const MeshPart sheet = broken_sheet();
    const std::string normal = R"("name":"stone","normalTexture":{"index":0})";
    model("N801-two-channel-in-model", sheet,
          {normal, R"("extensions":{"MSFT_texture_dds":{"source":0}})",
           encoded(packed(part(64, 64), Encoding::bc5), Container::dds), "image/vnd-ms.dds", "MSFT_texture_dds"});
    put("N802-used-as-color", sheet, normal + R"(,"pbrMetallicRoughness":{"baseColorTexture":{"index":0}})");
    put("N803-uv-set-missing", sheet, R"("name":"stone","normalTexture":{"index":0,"texCoord":1})");
    put("N804-scale-not-positive", sheet, R"("name":"stone","normalTexture":{"index":0,"scale":-1})");
    put("N805-double-sided-tangents", two_sheets(true), normal + R"(,"doubleSided":true)");
    put("N806-data-in-normal-slot", sheet, normal + R"(,"occlusionTexture":{"index":0})");
    MeshPart bare = sheet;
    bare.tangents.clear();
    put("N808-drawn-wrongly-by-engine", bare,
        R"("normalTexture":{"index":0,"extensions":{"KHR_texture_transform":{"rotation":1}}})",
        "KHR_texture_transform");
    bare.normals.clear();
    put("N807-mesh-not-examined", bare, normal);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: make_broken samples/waves.png FOLDER\n");
        return 2;
    }
    Maker maker{argv[2], {}};
    const auto image = read_image(argv[1]);
    auto field = image ? height_field(*image, {}) : Result<PictureHeights>(image.error());
    if (!field) {
        maker.fail(field.error());
        return 3;
    }
    field->bumpiness_x = field->bumpiness_y = 8.0f;
    auto base = bake(*field);
    if (!base) return 3;
    maker.base = std::move(*base);
    maker.files();
    maker.values();
    maker.damages();
    maker.conventions();
    maker.levels();
    maker.tangents();
    maker.seams();
    maker.models();
    return maker.failed ? 3 : 0;
}
