// SPDX-License-Identifier: Apache-2.0
// lod_bench: how far LODs are from their original to the eye.
//
//     lod_bench ORIGINAL LOD...        glTF models
//
// Each model is drawn by preview(), with its own normal maps and tangents and without its colours, from 26 directions:
// those from the centre of a cube to its sides, edges and corners. The light stands over the left shoulder of the
// viewer. Pictures are 700 pixels wide, and all models of a run are drawn in the same place and size. Pixels count that
// all of them cover, at least two pixels inside, and where the original is lit. For each LOD, the mean difference of
// the codes from those of the original is printed, and the mean angle in degrees between both normals. Materials are
// drawn one by one, and each counts as many pixels as it has. tests/bench/lods.sh makes the models.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <tex/tex.h>

namespace {

using namespace tex;

constexpr int kSide = 700, kInside = 2, kLit = 40;
constexpr double kDegrees = 57.29577951308232;

struct Box {
    Float3 low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
};

// A material of a model, ready to draw.
struct Drawn {
    std::string name;
    SelectedPart selected;
    MipChain map;
};

[[noreturn]] void fail(const std::string& why) {
    std::fprintf(stderr, "lod_bench: %s\n", why.c_str());
    std::exit(1);
}

NormalMap map_of(const Model& model, int material) {
    for (const ModelMap& map : model.maps) {
        if (map.material != material || map.slot != NormalSlot::normal || map.image < 0) continue;
        const auto texture = read_map(model, map);
        if (!texture) fail(texture.error().message());
        auto chain = unpack(*texture);
        if (!chain) fail(chain.error().message());
        auto scaled = scale(std::move(chain->levels.front()), static_cast<float>(map.scale));
        if (!scaled) fail(scaled.error().message());
        return std::move(*scaled);
    }
    NormalMap flat(Extent{4, 4});
    for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
            flat.x.at(i, j) = flat.y.at(i, j) = 0.0f;
            flat.z.at(i, j) = 1.0f;
        }
    }
    return flat;
}

std::vector<Drawn> read(const std::string& path) {
    const auto model = read_model(path);
    if (!model) fail(model.error().message());
    std::vector<Drawn> all;
    for (std::size_t m = 0; m < model->mesh.materials.size(); ++m) {
        MeshSelection selection;
        selection.material = std::to_string(m);
        selection.in_scene = true;
        auto selected = select_part(model->mesh, selection);
        if (!selected) continue;  // no triangle, or no UVs
        auto map = build_mip_chain(map_of(*model, static_cast<int>(m)), {});
        if (!map) fail(map.error().message());
        all.push_back({model->mesh.materials[m].name, std::move(*selected), std::move(*map)});
    }
    return all;
}

void include(const MeshPart& part, Box& box) {
    for (const Float3& p : part.positions) {
        box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
        box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
    }
}

// Adds a triangle without area, which nobody sees, so that all models are drawn in one place and size.
void frame(Drawn& drawn, const Box& box) {
    MeshPart& part = drawn.selected.part;
    const auto first = static_cast<std::uint32_t>(part.positions.size());
    for (const Float3& p : {box.low, box.high, box.high}) {
        part.positions.push_back(p);
        part.normals.push_back({0.0f, 0.0f, 1.0f});
        part.uvs[0].push_back({0.0f, 0.0f});
        drawn.selected.tangents.push_back({1.0f, 0.0f, 0.0f, 1.0f});
        part.indices.push_back(first + static_cast<std::uint32_t>(part.positions.size() - 1 - first));
    }
}

struct Direction {
    float yaw, pitch;
};

std::vector<Direction> directions() {
    std::vector<Direction> all;
    for (int x = -1; x <= 1; ++x) {
        for (int y = -1; y <= 1; ++y) {
            for (int z = -1; z <= 1; ++z) {
                if (x == 0 && y == 0 && z == 0) continue;
                const double flat = std::sqrt(double(x * x + z * z));
                const double yaw = std::atan2(double(x), double(z)) * kDegrees;
                const double pitch = std::atan2(double(y), flat) * kDegrees;
                all.push_back({static_cast<float>(yaw), static_cast<float>(std::clamp(pitch, -89.0, 89.0))});
            }
        }
    }
    return all;
}

Texture draw(const Drawn& drawn, const Direction& from, Show show, bool is_mask) {
    PreviewScene scene;
    scene.map = &drawn.map;
    const TangentSpace space{drawn.selected.part, drawn.selected.tangents};
    scene.mesh = &space;
    PreviewOptions options;
    options.show = show;
    options.size = {kSide, kSide};
    options.legend = false;
    options.camera = Camera{from.yaw, from.pitch, 30.0f};
    options.material.specular = {0.1f, 0.1f, 0.1f};
    // From the viewer's space to the world's.
    const double yaw = static_cast<double>(from.yaw) / kDegrees, pitch = static_cast<double>(from.pitch) / kDegrees;
    const double x = -0.6, y = 0.7, z = 1.0;
    const double up = y * std::cos(pitch) + z * std::sin(pitch), out = z * std::cos(pitch) - y * std::sin(pitch);
    options.light.x = static_cast<float>(x * std::cos(yaw) + out * std::sin(yaw));
    options.light.y = static_cast<float>(up);
    options.light.z = static_cast<float>(out * std::cos(yaw) - x * std::sin(yaw));
    if (is_mask) {
        options.ambient = {10.0f, 10.0f, 10.0f};
        options.material.albedo = {1.0f, 1.0f, 1.0f};
    }
    auto picture = preview(scene, options);
    if (!picture) fail(picture.error().message());
    return std::move(*picture);
}

int code(const Texture& picture, int i, int j, int channel) {
    return static_cast<int>(picture.levels.front().bytes[static_cast<std::size_t>((j * kSide + i) * 3 + channel)]);
}

// Pixels that are white, at least kInside from others.
std::vector<bool> inside(const Texture& mask) {
    std::vector<bool> covered(std::size_t{kSide} * kSide), result(covered.size());
    for (int j = 0; j < kSide; ++j) {
        for (int i = 0; i < kSide; ++i)
            covered[static_cast<std::size_t>(j * kSide + i)] = code(mask, i, j, 0) == 255 && code(mask, i, j, 2) == 255;
    }
    for (int j = kInside; j < kSide - kInside; ++j) {
        for (int i = kInside; i < kSide - kInside; ++i) {
            bool all = true;
            for (int y = j - kInside; all && y <= j + kInside; ++y) {
                for (int x = i - kInside; all && x <= i + kInside; ++x)
                    all = covered[static_cast<std::size_t>(y * kSide + x)];
            }
            result[static_cast<std::size_t>(j * kSide + i)] = all;
        }
    }
    return result;
}

double angle(const Texture& a, const Texture& b, int i, int j) {
    double product = 0.0, first = 0.0, second = 0.0;
    for (int c = 0; c < 3; ++c) {
        const double x = code(a, i, j, c) / 127.5 - 1.0, y = code(b, i, j, c) / 127.5 - 1.0;
        product += x * y;
        first += x * x;
        second += y * y;
    }
    return kDegrees * std::acos(std::clamp(product / std::sqrt(first * second), -1.0, 1.0));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) fail("ORIGINAL LOD...");
    std::vector<std::vector<Drawn>> models;
    Box box;
    for (int k = 1; k < argc; ++k) {
        models.push_back(read(argv[k]));
        for (const Drawn& drawn : models.back()) include(drawn.selected.part, box);
    }
    for (auto& model : models) {
        for (Drawn& drawn : model) frame(drawn, box);
    }
    std::vector<double> light(models.size()), turned(models.size());
    double count = 0.0;
    for (const Drawn& original : models.front()) {
        std::vector<const Drawn*> same = {&original};
        for (std::size_t k = 1; k < models.size(); ++k) {
            for (const Drawn& drawn : models[k])
                if (same.size() == k && drawn.name == original.name) same.push_back(&drawn);
        }
        if (same.size() != models.size()) continue;
        for (const Direction& from : directions()) {
            std::vector<Texture> lit, normals;
            std::vector<bool> counts(std::size_t{kSide} * kSide, true);
            for (const Drawn* const drawn : same) {
                lit.push_back(draw(*drawn, from, Show::plain, false));
                normals.push_back(draw(*drawn, from, Show::world_normals, false));
                const std::vector<bool> own = inside(draw(*drawn, from, Show::plain, true));
                for (std::size_t p = 0; p < counts.size(); ++p) counts[p] = counts[p] && own[p];
            }
            for (int j = 0; j < kSide; ++j) {
                for (int i = 0; i < kSide; ++i) {
                    if (!counts[static_cast<std::size_t>(j * kSide + i)] || code(lit[0], i, j, 1) < kLit) continue;
                    count += 1.0;
                    for (std::size_t k = 1; k < models.size(); ++k) {
                        light[k] += std::abs(code(lit[k], i, j, 1) - code(lit[0], i, j, 1));
                        turned[k] += angle(normals[k], normals[0], i, j);
                    }
                }
            }
        }
    }
    if (count == 0.0) fail("no pixel is lit in all of them");
    for (std::size_t k = 1; k < models.size(); ++k)
        std::printf("%s\t%.2f\t%.2f\n", argv[k + 1], light[k] / count, turned[k] / count);
    return 0;
}
