// SPDX-License-Identifier: Apache-2.0

#include "rays/high_surface.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "mesh/frames.h"
#include "rows/usable.h"

namespace tex::inline v1 {
namespace {

// A triangle of a picture that repeats: two columns, two rows, and the parts of the second ones.
struct Sampled {
    int i[2], j[2];
    double right, down;

    // x and y in texels. Their whole repeats are taken off before they become whole numbers.
    Sampled(Extent extent, double x, double y) {
        right = around(x, extent.width, i);
        down = around(y, extent.height, j);
    }
    [[nodiscard]] double of(const Plane<float>& plane) const {
        const auto at = [&](int column, int row) { return static_cast<double>(plane.at(i[column], j[row])); };
        return (1.0 - down) * ((1.0 - right) * at(0, 0) + right * at(1, 0)) +
               down * ((1.0 - right) * at(0, 1) + right * at(1, 1));
    }

private:
    static double around(double x, int size, int* places) {
        double triangle = (x - 0.5) / size;
        triangle = (triangle - std::floor(triangle)) * size;
        const double first = std::min(std::floor(triangle), size - 1.0);
        places[0] = static_cast<int>(first);
        places[1] = (places[0] + 1) % size;
        return triangle - first;
    }
};

Sampled sampled(const Triangles::Triangle& triangle, const HighSurface::Weights& weights, int uv_set, Extent extent) {
    double u = 0.0, v = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Float2 uv = triangle.part.uvs[static_cast<std::size_t>(uv_set)][triangle.vertex(k)];
        u += weights[k] * static_cast<double>(uv.x);
        v += weights[k] * static_cast<double>(uv.y);
    }
    if (triangle.part.v_axis == YAxis::up) v = 1.0 - v;
    return {extent, u * extent.width, v * extent.height};
}

// The tangent frames at the corners. For a part that is drawn in several places, its own normals and tangents are
// turned to the place, as in_scene() does.
CornerFrames frames_at(const Triangles::Triangle& triangle, const HighDetail& detail) {
    const NodeTransform* const placement = triangle.placement();
    if (placement == nullptr)
        return {{triangle.part, *detail.tangents, detail.uv_set, detail.decoder}, triangle.number};
    std::array<Float3, 3> normals{};
    std::array<Float4, 3> tangents{};
    for (std::size_t k = 0; k < 3; ++k) {
        normals[k] = triangle.normal(k);
        tangents[k] = placement->tangent((*detail.tangents)[3 * triangle.number + triangle.stored(k)]);
    }
    return {normals, tangents, detail.decoder};
}

Result<void> check_detail(const HighDetail& detail, const MeshPart& part) {
    if (detail.alpha != nullptr) {
        if (detail.alpha->empty()) return bad_option("has alpha without texels");
        if (!std::isfinite(detail.alpha_cutoff)) return bad_option("alpha_cutoff must be finite");
        if (detail.alpha_uv_set < 0 || static_cast<std::size_t>(detail.alpha_uv_set) >= part.uvs.size())
            return bad_option("has no such set of UVs");
    }
    if (detail.normals == nullptr && detail.color == nullptr) return {};
    if (detail.color != nullptr) {
        if (auto usable = check_usable(*detail.color); !usable) return usable;
    }
    if (detail.uv_set < 0 || static_cast<std::size_t>(detail.uv_set) >= part.uvs.size())
        return bad_option("has no such set of UVs");
    if (detail.normals == nullptr) return {};
    if (auto usable = check_usable(*detail.normals); !usable) return usable;
    if (detail.tangents == nullptr) return bad_option("has a normal map, but no tangents");
    return check_space({part, *detail.tangents, detail.uv_set, detail.decoder});
}

}  // namespace

HighSurface::HighSurface(const std::vector<MeshPart>& high, const TransferInputs& inputs)
    : high_(high), inputs_(inputs) {
    const auto has_color = [](const HighDetail& detail) { return detail.color != nullptr; };
    has_colors_ = std::any_of(inputs.high_details.begin(), inputs.high_details.end(), has_color);
    const auto has_alpha = [](const HighDetail& detail) { return detail.alpha != nullptr; };
    has_cutouts_ = std::any_of(inputs.high_details.begin(), inputs.high_details.end(), has_alpha);
}

bool HighSurface::is_open_at(const Triangles::Triangle& triangle, const Weights& weights) const {
    const HighDetail* const detail = detail_of(triangle);
    if (detail == nullptr || detail->alpha == nullptr) return false;
    const Sampled at = sampled(triangle, weights, detail->alpha_uv_set, detail->alpha->extent());
    return at.of(*detail->alpha) < static_cast<double>(detail->alpha_cutoff);
}

Vector3 HighSurface::face_normal(const Triangles::Triangle& triangle) {
    const auto corners = triangle.corners();
    return normalized(cross(corners[1] - corners[0], corners[2] - corners[0]));
}

Vector3 HighSurface::normal_at(const Triangles::Triangle& triangle, const Weights& weights) const {
    const HighDetail* const detail = detail_of(triangle);
    if (detail != nullptr && detail->normals != nullptr) {
        const NormalMap& map = *detail->normals;
        const Sampled at = sampled(triangle, weights, detail->uv_set, map.extent());
        const Vector3 t = read_texel(detail->decoder, {at.of(map.x), at.of(map.y), at.of(map.z)});
        return decode(frames_at(triangle, *detail).at(weights), t);
    }
    if (!triangle.part.normals.empty()) {
        Vector3 sum;
        for (std::size_t k = 0; k < 3; ++k) sum = sum + weights[k] * normalized(vector_of(triangle.normal(k)));
        if (dot(sum, sum) > 1e-12) return normalized(sum);
    }
    return face_normal(triangle);
}

Vector3 HighSurface::color_at(const Triangles::Triangle& triangle, const Weights& weights) const {
    const HighDetail* const detail = detail_of(triangle);
    if (detail == nullptr || detail->color == nullptr) return {1.0, 1.0, 1.0};
    const std::vector<Plane<float>>& planes = detail->color->planes;
    const Sampled at = sampled(triangle, weights, detail->uv_set, planes.front().extent());
    if (planes.size() < 3) {
        const double grey = at.of(planes.front());
        return {grey, grey, grey};
    }
    return {at.of(planes[0]), at.of(planes[1]), at.of(planes[2])};
}

Vector3 HighSurface::vertex_color_at(const Triangles::Triangle& triangle, const Weights& weights) {
    if (triangle.part.colors.empty()) return {1.0, 1.0, 1.0};
    Vector3 sum;
    for (std::size_t k = 0; k < 3; ++k) sum = sum + weights[k] * vector_of(triangle.part.colors[triangle.vertex(k)]);
    return sum;
}

Result<void> check_details(const TransferInputs& inputs, const std::vector<MeshPart>& high) {
    const std::size_t standing = inputs.high_places.empty() ? high.size() : inputs.high_places.size();
    if (!inputs.high_ids.empty() && inputs.high_ids.size() != standing)
        return bad_option("high_ids: must have a number for each part of the high mesh");
    if (std::any_of(inputs.high_ids.begin(), inputs.high_ids.end(), [](std::int32_t id) { return id < 0; }))
        return bad_option("high_ids: must be 0 or more");
    if (inputs.high_details.empty()) return {};
    if (inputs.high_details.size() != high.size())
        return bad_option("high_details: must have one for each part of the high mesh");
    for (std::size_t k = 0; k < high.size(); ++k) {
        if (auto fits = check_detail(inputs.high_details[k], high[k]); !fits) {
            Error error = fits.error();
            error.reason = "high_details: part " + std::to_string(k) + ": " + error.reason;
            return error;
        }
    }
    return {};
}

}  // namespace tex::inline v1
