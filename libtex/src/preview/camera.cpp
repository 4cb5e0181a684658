// SPDX-License-Identifier: Apache-2.0

#include "preview/camera.h"

#include <algorithm>

namespace tex::inline v1::render {

View::View(const Camera& camera, Extent pixels, const std::function<double(Vec3 direction)>& support) {
    const double yaw = radians(static_cast<double>(camera.yaw));
    const double pitch = radians(static_cast<double>(camera.pitch));
    const double sy = math::sin(yaw), cy = math::cos(yaw), sp = math::sin(pitch), cp = math::cos(pitch);
    toward_ = {sy * cp, sp, cy * cp};
    const Vec3 right{cy, 0.0, -sy};
    const Vec3 up = cross(toward_, right);

    // The picture plane goes through the origin. With T = tan(field of view / 2), the eye is half_height / T in front
    // of it. A point p lies below the upper edge if p.up + T p.toward <= half_height; the other edges work in the same
    // way.
    const double half_angle = radians(static_cast<double>(camera.field_of_view)) / 2.0;
    const double slope = math::sin(half_angle) / math::cos(half_angle);
    const double proportion = static_cast<double>(pixels.width) / pixels.height;
    double half_height = 0.0;
    for (const double sign : {-1.0, 1.0}) {
        half_height = std::max(half_height, support(up * sign + toward_ * slope));
        half_height = std::max(half_height, support(right * (sign / proportion) + toward_ * slope));
    }
    const double half_width = half_height * proportion;
    right_ = right * (2.0 * half_width / pixels.width);
    up_ = up * (2.0 * half_height / pixels.height);
    corner_ = up * half_height - right * half_width;

    parallel_ = !(slope > 0.0);
    if (!parallel_) eye_ = toward_ * (half_height / slope);
}

Ray View::ray(double x, double y) const {
    const Vec3 point = corner_ + right_ * x - up_ * y;
    // A parallel ray starts in front of every shape, because all shapes lie within 1000 of the origin.
    if (parallel_) return {point + toward_ * 1000.0, toward_ * -1.0};
    return {eye_, point - eye_};
}

Projected View::project(Vec3 point, double lift) const {
    // Every shape lies in front of the eye, whose distance is more than its radius.
    constexpr double kLeastDepth = 1e-3;
    double nearness = dot(point, toward_) + lift;
    if (!parallel_) {
        const Vec3 way = point - eye_;
        const double depth = std::max(-dot(way, toward_), kLeastDepth);
        nearness = 1.0 / std::max(depth - lift, kLeastDepth);
        point = eye_ + way * (dot(eye_, toward_) / depth);  // in the picture plane
    }
    const Vec3 from_corner = point - corner_;
    return {dot(from_corner, right_) / dot(right_, right_), -dot(from_corner, up_) / dot(up_, up_), nearness};
}

void View::turn(double sine, double cosine) {
    for (Vec3* v : {&eye_, &toward_, &right_, &up_, &corner_}) *v = turn_about_y(*v, sine, cosine);
}

}  // namespace tex::inline v1::render
