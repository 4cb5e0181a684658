// SPDX-License-Identifier: Apache-2.0

#include "rays/ray_starts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "rows/usable.h"

namespace tex::inline v1 {
namespace {

// The picture at (x, y), from 0 to 1. Beyond the centres of its texels at the border it is constant.
double filtered(const Plane<float>& picture, double x, double y) {
    const int width = picture.extent().width, height = picture.extent().height;
    const double column = std::clamp(x * width - 0.5, 0.0, width - 1.0),
                 row = std::clamp(y * height - 0.5, 0.0, height - 1.0);
    const int i = std::min(static_cast<int>(column), std::max(width - 2, 0)),
              j = std::min(static_cast<int>(row), std::max(height - 2, 0));
    const double right = column - i, down = row - j;
    const auto value = [&](int a, int b) {
        return static_cast<double>(picture.at(std::min(a, width - 1), std::min(b, height - 1)));
    };
    return (1.0 - down) * ((1.0 - right) * value(i, j) + right * value(i + 1, j)) +
           down * ((1.0 - right) * value(i, j + 1) + right * value(i + 1, j + 1));
}

Result<void> check_picture(const Plane<float>* picture, float most, const std::string& name) {
    if (picture == nullptr) return {};
    if (picture->empty()) return bad_option(name + ": the picture is empty");
    for (int j = 0; j < picture->extent().height; ++j) {
        for (int i = 0; i < picture->extent().width; ++i) {
            const float value = picture->at(i, j);
            if (!(value >= 0.0f && value <= most && std::isfinite(value)))
                return bad_option(name + ": a value at column " + std::to_string(i) + " of row " + std::to_string(j) +
                                  (most == 1.0f ? " is not between 0 and 1" : " is negative or not finite"));
        }
    }
    return {};
}

}  // namespace

RayStart RayStarts::at(std::size_t triangle, const std::array<double, 3>& weights, Vector3 point, double x, double y,
                       RayWork& work) const {
    if (inputs_.cage != nullptr) {
        const Vector3 way = mix(Triangles::Triangle{*inputs_.cage, triangle}.corners(), weights) - point;
        const double length = std::sqrt(dot(way, way));
        if (length > 1e-30) return {point, (1.0 / length) * way, length + slack_};
    }
    double front = inputs_.cage != nullptr ? slack_ : front_;
    if (inputs_.offset != nullptr) front *= filtered(*inputs_.offset, x, y);
    const Vector3 direction = inputs_.skew != nullptr
                                  ? directions_.skewed(triangle, weights, filtered(*inputs_.skew, x, y))
                                  : directions_.at(triangle, weights, point, work);
    return {point, direction, front};
}

void RayStarts::along(std::size_t triangle, VectorArrays<const double> weights, VectorArrays<const double> points,
                      std::size_t count, VectorArrays<double> directions, RayStart* starts, RayWork& work) const {
    const auto point_of = [&](std::size_t k) { return Vector3{points.x[k], points.y[k], points.z[k]}; };
    if (inputs_.cage != nullptr) {
        for (std::size_t k = 0; k < count; ++k)
            starts[k] = at(triangle, {weights.x[k], weights.y[k], weights.z[k]}, point_of(k), 0.0, 0.0, work);
        return;
    }
    directions_.along(triangle, weights, points, count, directions, work);
    for (std::size_t k = 0; k < count; ++k)
        starts[k] = {point_of(k), {directions.x[k], directions.y[k], directions.z[k]}, front_};
}

double RayStarts::farthest(const MeshPart& low) const {
    if (inputs_.cage == nullptr) return front_;
    double squared = 0.0;
    for (std::size_t c = 0; c < low.indices.size(); ++c) {
        const Vector3 way =
            vector_of(inputs_.cage->positions[inputs_.cage->indices[c]]) - vector_of(low.positions[low.indices[c]]);
        squared = std::max(squared, dot(way, way));
    }
    return std::sqrt(squared);
}

Result<void> check_inputs(const TransferInputs& inputs, const MeshPart& low, std::size_t high_parts, RayMode rays) {
    if (inputs.cage != nullptr) {
        if (auto sound = check_part(*inputs.cage); !sound) return sound;
        if (inputs.cage->triangles() != low.triangles()) {
            return bad_option("cage: must have the triangles of the low mesh, " + std::to_string(low.triangles()) +
                              ", but has " + std::to_string(inputs.cage->triangles()));
        }
        if (inputs.skew != nullptr || inputs.offset != nullptr)
            return bad_option("cage: decides where rays start, so skew and offset mean nothing");
    }
    if (inputs.around != nullptr) {
        if (auto sound = check_part(*inputs.around); !sound) return sound;
    }
    if (inputs.skew != nullptr && rays != RayMode::straight) return bad_option("skew: needs RayMode::straight");
    if (auto sound = check_picture(inputs.skew, 1.0f, "skew"); !sound) return sound;
    if (auto sound = check_picture(inputs.offset, std::numeric_limits<float>::max(), "offset"); !sound) return sound;
    const bool has_groups = !inputs.low_groups.empty() || !inputs.high_groups.empty();
    if (has_groups && inputs.low_groups.size() != low.triangles())
        return bad_option("low_groups: must have a number for each triangle of the low mesh");
    if (has_groups && inputs.high_groups.size() != high_parts)
        return bad_option("high_groups: must have a number for each part of the high mesh");
    return {};
}

}  // namespace tex::inline v1
