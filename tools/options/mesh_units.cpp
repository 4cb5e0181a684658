// SPDX-License-Identifier: Apache-2.0

#include "options/mesh_units.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>

#include <fmt/format.h>

namespace tex::cli {
namespace {

constexpr double kFar = 0.5, kNear = 0.1;  // of the low mesh's diagonal

struct Box {
    std::array<double, 3> low, high;

    Box() {
        low.fill(std::numeric_limits<double>::infinity());
        high.fill(-std::numeric_limits<double>::infinity());
    }
    void include(const std::array<double, 3>& p) {
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], p[k]);
            high[k] = std::max(high[k], p[k]);
        }
    }
    void include(const MeshPart& part) {
        // A hint needs no more corners than these.
        constexpr std::size_t kMostCorners = 1 << 17;
        const std::size_t step = part.indices.size() / kMostCorners + 1;
        constexpr float kInfinity = std::numeric_limits<float>::infinity();
        Float3 least{kInfinity, kInfinity, kInfinity}, most{-kInfinity, -kInfinity, -kInfinity};
        for (std::size_t k = 0; k < part.indices.size(); k += step) {
            const Float3& p = part.positions[part.indices[k]];
            least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
            most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
        }
        if (part.indices.empty()) return;
        for (const Float3& p : {least, most})
            include({static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)});
    }
    void include(const Box& box, const std::array<double, 12>& to_scene) {
        for (unsigned corner = 0; corner < 8; ++corner) {
            std::array<double, 3> p{};
            for (std::size_t row = 0; row < 3; ++row) {
                p[row] = to_scene[4 * row + 3];
                for (std::size_t k = 0; k < 3; ++k)
                    p[row] += to_scene[4 * row + k] * ((corner >> k & 1) != 0 ? box.high[k] : box.low[k]);
            }
            include(p);
        }
    }
    [[nodiscard]] Box with(const MeshUnits& units) const {
        Box box;
        box.include(units.of(low));
        box.include(units.of(high));
        return box;
    }
    [[nodiscard]] double diagonal() const {
        double squared = 0.0;
        for (std::size_t k = 0; k < 3; ++k) squared += (high[k] - low[k]) * (high[k] - low[k]);
        return std::sqrt(squared);
    }
    // The largest distance along an axis between a side of both.
    [[nodiscard]] double distance(const Box& other) const {
        double most = 0.0;
        for (std::size_t k = 0; k < 3; ++k)
            most = std::max({most, std::abs(low[k] - other.low[k]), std::abs(high[k] - other.high[k])});
        return most;
    }
};

// Parts with places stand there; of each, the box of its own box counts.
Box box_of(const std::vector<MeshPart>& parts, const std::vector<PartPlace>& places) {
    Box box;
    std::vector<Box> boxes(places.empty() ? 0 : parts.size());
    for (std::size_t k = 0; k < parts.size(); ++k) (places.empty() ? box : boxes[k]).include(parts[k]);
    for (const PartPlace& place : places) box.include(boxes[place.part], place.to_scene);
    return box;
}

}  // namespace

std::array<double, 3> MeshUnits::of(const std::array<double, 3>& p) const {
    std::array<double, 3> turned = p;
    if (up == UpAxis::z) turned = {p[0], p[2], -p[1]};
    if (up == UpAxis::y) turned = {p[0], -p[2], p[1]};
    for (double& value : turned) value *= scale;
    return turned;
}

void MeshUnits::place(Mesh& mesh) const {
    if (is_plain()) return;
    if (mesh.nodes.empty()) {
        std::set<int> meshes;
        for (const MeshPart& part : mesh.parts) meshes.insert(part.mesh);
        for (const int number : meshes) mesh.nodes.push_back({{}, number});
    }
    for (MeshNode& node : mesh.nodes) {
        std::array<double, 12>& rows = node.to_scene;
        for (std::size_t column = 0; column < 4; ++column) {
            const std::array<double, 3> moved = of({rows[column], rows[column + 4], rows[column + 8]});
            for (std::size_t row = 0; row < 3; ++row) rows[4 * row + column] = moved[row];
        }
    }
}

std::string MeshUnits::arguments() const {
    std::string text;
    if (scale != 1.0) text = fmt::format("--high-scale {:.4g}", scale);
    if (up != UpAxis::same) text += fmt::format("{}--high-up {}", text.empty() ? "" : " ", name_of(kUpAxisNames, up));
    return text;
}

std::optional<MeshUnits> fitting_units(const MeshPart& low, const std::vector<MeshPart>& high,
                                       const std::vector<PartPlace>& places) {
    Box low_box;
    low_box.include(low);
    const Box high_box = box_of(high, places);
    const double diagonal = low_box.diagonal();
    if (low_box.distance(high_box) <= kFar * diagonal) return std::nullopt;
    std::optional<MeshUnits> best;
    double least = kNear * diagonal;
    for (const double scale : {1.0, 0.01, 100.0, 0.001, 1000.0, 0.1, 10.0, 0.0254, 1.0 / 0.0254, 2.54, 1.0 / 2.54}) {
        for (const UpAxis up : {UpAxis::same, UpAxis::z, UpAxis::y}) {
            const MeshUnits units{scale, up};
            const double distance = low_box.distance(high_box.with(units));
            if (distance >= least) continue;
            least = distance;
            best = units;
        }
    }
    return best;
}

std::optional<std::array<double, 3>> offset_between(const MeshPart& low, const std::vector<MeshPart>& high,
                                                    const std::vector<PartPlace>& places) {
    constexpr double kSameSize = 0.02, kApart = 0.05;  // of the low mesh's diagonal
    Box low_box;
    low_box.include(low);
    const Box high_box = box_of(high, places);
    const double diagonal = low_box.diagonal();
    std::array<double, 3> offset{};
    double squared = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double at_low = high_box.low[k] - low_box.low[k], at_high = high_box.high[k] - low_box.high[k];
        if (!(std::abs(at_high - at_low) <= kSameSize * diagonal)) return std::nullopt;
        offset[k] = (at_low + at_high) / 2.0;
        squared += offset[k] * offset[k];
    }
    return std::sqrt(squared) > kApart * diagonal ? std::optional(offset) : std::nullopt;
}

}  // namespace tex::cli
