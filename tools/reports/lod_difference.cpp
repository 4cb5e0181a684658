// SPDX-License-Identifier: Apache-2.0

#include "reports/lod_difference.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <utility>

#include <tex/tex.h>

namespace tex::cli {
namespace {

constexpr double kDegrees = 57.29577951308232;

// The map of a material of glTF, or nothing.
Result<void> add_map(const Model& model, int material, const ReadOptions& options, const Execution& execution,
                     LodMaterial& to) {
    NormalMap base(Extent{4, 4});
    for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
            base.x.at(i, j) = base.y.at(i, j) = 0.0f;
            base.z.at(i, j) = 1.0f;
        }
    }
    const auto found = std::find_if(model.maps.begin(), model.maps.end(), [&](const ModelMap& map) {
        return map.material == material && map.slot == NormalSlot::normal && map.image >= 0;
    });
    if (found != model.maps.end()) {
        auto texture = read_map(model, *found, options);
        if (!texture) return texture.error();
        auto chain = unpack(*texture, {}, execution);
        if (!chain) return chain.error();
        auto scaled = scale(std::move(chain->levels.front()), static_cast<float>(found->scale), ScaleMode::slope,
                            {execution.threads, {}});
        if (!scaled) return scaled.error();
        base = std::move(*scaled);
    }
    auto map = build_mip_chain(std::move(base), {}, {execution.threads, {}});
    if (!map) return map.error();
    to.map = std::move(*map);
    return {};
}

Result<Texture> draw(const LodMaterial& of, const LodView& view, Show show, bool is_mask, int side,
                     const Execution& execution) {
    PreviewScene scene;
    scene.map = &of.map;
    const TangentSpace space{of.selected.part, of.selected.tangents};
    scene.mesh = &space;
    PreviewOptions options;
    options.show = show;
    options.size = {side, side};
    options.legend = false;
    options.camera = Camera{view.yaw, view.pitch, 30.0f};
    options.material.specular = {0.1f, 0.1f, 0.1f};
    const Float3 light = lod_light(view);
    options.light.x = light.x;
    options.light.y = light.y;
    options.light.z = light.z;
    if (is_mask) {
        options.ambient = {10.0f, 10.0f, 10.0f};
        options.material.albedo = {1.0f, 1.0f, 1.0f};
    }
    return preview(scene, options, execution);
}

int code(const Texture& picture, std::size_t pixel, std::size_t channel) {
    return static_cast<int>(picture.levels.front().bytes[pixel * 3 + channel]);
}

std::vector<bool> covered_by(const Texture& mask) {
    std::vector<bool> covered(mask.levels.front().bytes.size() / 3);
    for (std::size_t p = 0; p < covered.size(); ++p) covered[p] = code(mask, p, 0) == 255 && code(mask, p, 2) == 255;
    return covered;
}

double angle(const Texture& a, const Texture& b, std::size_t pixel) {
    double product = 0.0, first = 0.0, second = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
        const double x = code(a, pixel, c) / 127.5 - 1.0, y = code(b, pixel, c) / 127.5 - 1.0;
        product += x * y;
        first += x * x;
        second += y * y;
    }
    return kDegrees * std::acos(std::clamp(product / std::sqrt(first * second), -1.0, 1.0));
}

// Sums over the pixels of all views.
struct Sums {
    std::vector<LodDifference> of;
    double pixels = 0.0;
};

Result<void> compare_from(const LodView& view, const std::vector<const LodMaterial*>& same, int side,
                          const Execution& execution, Sums& sums) {
    std::vector<Texture> lit, normals;
    std::vector<bool> counts(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), true);
    for (const LodMaterial* const one : same) {
        auto plain = draw(*one, view, Show::plain, false, side, execution);
        auto turned = draw(*one, view, Show::world_normals, false, side, execution);
        const auto mask = draw(*one, view, Show::plain, true, side, execution);
        for (const Result<Texture>* const drawn : {&std::as_const(plain), &std::as_const(turned), &mask})
            if (!*drawn) return drawn->error();
        const std::vector<bool> own = far_inside(covered_by(*mask), side);
        for (std::size_t p = 0; p < counts.size(); ++p) counts[p] = counts[p] && own[p];
        lit.push_back(std::move(*plain));
        normals.push_back(std::move(*turned));
    }
    for (std::size_t p = 0; p < counts.size(); ++p) {
        if (!counts[p] || code(lit[0], p, 1) < kLodLit) continue;
        sums.pixels += 1.0;
        for (std::size_t k = 1; k < same.size(); ++k) {
            sums.of[k - 1].codes += std::abs(code(lit[k], p, 1) - code(lit[0], p, 1));
            sums.of[k - 1].degrees += angle(normals[k], normals[0], p);
        }
    }
    return {};
}

}  // namespace

Result<std::vector<LodMaterial>> lod_materials(const std::string& model, const ReadOptions& options,
                                               const Execution& execution) {
    MeshReadOptions how;
    how.reader = options;
    auto read = is_model(model) ? read_model(model, how) : Result<Model>(Model{});
    if (read && !is_model(model)) {
        auto mesh = read_mesh(model, how);
        if (!mesh) return mesh.error();
        read->mesh = std::move(*mesh);
    }
    if (!read) return read.error();
    std::vector<LodMaterial> all;
    for (std::size_t m = 0; m < read->mesh.materials.size(); ++m) {
        MeshSelection selection;
        selection.material = std::to_string(m);
        selection.in_scene = true;
        auto selected = select_part(read->mesh, selection);
        if (!selected) continue;  // no triangle, or no UVs
        LodMaterial made;
        made.name = read->mesh.materials[m].name;
        made.selected = std::move(*selected);
        if (auto added = add_map(*read, static_cast<int>(m), options, execution, made); !added) return added.error();
        all.push_back(std::move(made));
    }
    return all;
}

void frame_together(const std::vector<std::vector<LodMaterial>*>& models) {
    constexpr float kFar = 1e30f;
    Float3 low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};
    for (const auto* const model : models) {
        for (const LodMaterial& material : *model) {
            for (const Float3& p : material.selected.part.positions) {
                low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
                high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
            }
        }
    }
    for (auto* const model : models) {
        for (LodMaterial& material : *model) {
            MeshPart& part = material.selected.part;
            for (const Float3& p : {low, high, high}) {
                part.indices.push_back(static_cast<std::uint32_t>(part.positions.size()));
                part.positions.push_back(p);
                part.normals.push_back({0.0f, 0.0f, 1.0f});
                part.uvs[0].push_back({0.0f, 0.0f});
                material.selected.tangents.push_back({1.0f, 0.0f, 0.0f, 1.0f});
            }
        }
    }
}

std::vector<LodView> lod_views() {
    std::vector<LodView> all;
    for (int k = 0; k < 27; ++k) {
        const int x = k / 9 - 1, y = k / 3 % 3 - 1, z = k % 3 - 1;
        if (x == 0 && y == 0 && z == 0) continue;
        const double flat = std::sqrt(static_cast<double>(x * x + z * z));
        const double yaw = std::atan2(static_cast<double>(x), static_cast<double>(z)) * kDegrees;
        const double pitch = std::atan2(static_cast<double>(y), flat) * kDegrees;
        all.push_back({static_cast<float>(yaw), static_cast<float>(std::clamp(pitch, -89.0, 89.0))});
    }
    return all;
}

Float3 lod_light(const LodView& view) {
    const double yaw = static_cast<double>(view.yaw) / kDegrees, pitch = static_cast<double>(view.pitch) / kDegrees;
    const double x = -0.6, y = 0.7, z = 1.0;
    const double up = y * std::cos(pitch) + z * std::sin(pitch), out = z * std::cos(pitch) - y * std::sin(pitch);
    return {static_cast<float>(x * std::cos(yaw) + out * std::sin(yaw)), static_cast<float>(up),
            static_cast<float>(out * std::cos(yaw) - x * std::sin(yaw))};
}

std::vector<bool> far_inside(const std::vector<bool>& covered, int side) {
    std::vector<bool> result(covered.size());
    for (int j = kLodInside; j < side - kLodInside; ++j) {
        for (int i = kLodInside; i < side - kLodInside; ++i) {
            bool all = true;
            for (int y = j - kLodInside; all && y <= j + kLodInside; ++y) {
                for (int x = i - kLodInside; all && x <= i + kLodInside; ++x)
                    all = covered[static_cast<std::size_t>(y * side + x)];
            }
            result[static_cast<std::size_t>(j * side + i)] = all;
        }
    }
    return result;
}

Result<std::vector<LodDifference>> lod_differences(const std::vector<LodMaterial>& original,
                                                   const std::vector<const std::vector<LodMaterial>*>& lods, int side,
                                                   const Execution& execution) {
    Sums sums;
    sums.of.resize(lods.size());
    for (const LodMaterial& first : original) {
        std::vector<const LodMaterial*> same = {&first};
        for (const auto* const lod : lods) {
            const auto found = std::find_if(lod->begin(), lod->end(),
                                            [&](const LodMaterial& other) { return other.name == first.name; });
            if (found != lod->end()) same.push_back(&*found);
        }
        if (same.size() != lods.size() + 1) continue;
        for (const LodView& view : lod_views()) {
            if (auto compared = compare_from(view, same, side, execution, sums); !compared) return compared.error();
        }
    }
    if (sums.pixels == 0.0) return std::vector<LodDifference>{};
    for (LodDifference& one : sums.of) {
        one.codes /= sums.pixels;
        one.degrees /= sums.pixels;
    }
    return sums.of;
}

}  // namespace tex::cli
