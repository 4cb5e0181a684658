// SPDX-License-Identifier: Apache-2.0
// camera.h: the view ray of a point of the picture.

#pragma once

#include <functional>

#include <tex/preview.h>

#include "preview/raster.h"
#include "preview/vector.h"

namespace tex::inline v1::render {

// The points origin + t direction, t > 0. The direction is not normalised.
struct Ray {
    Vec3 origin;
    Vec3 direction;
};

// A Camera (preview.h) whose picture, `pixels` large, just contains a shape. `support` returns the greatest
// dot(direction, point) of the points of the shape.
class View {
public:
    View(const Camera& camera, Extent pixels, const std::function<double(Vec3 direction)>& support);

    // The ray through (x, y), in pixels from the picture's top left corner. The centre of pixel (i, j) is at
    // (i + 0.5, j + 0.5).
    [[nodiscard]] Ray ray(double x, double y) const;

    // The unnormalised direction from `point` to the viewer.
    [[nodiscard]] Vec3 towards_viewer(Vec3 point) const { return parallel_ ? toward_ : eye_ - point; }

    // Where a point is seen. Its nearness is that of a point that is `lift` closer to the viewer.
    [[nodiscard]] Projected project(Vec3 point, double lift = 0.0) const;

    // Rotates the whole picture about the vertical axis, which is the same as rotating the shape the other way.
    void turn(double sine, double cosine);

private:
    Vec3 eye_;
    Vec3 toward_;      // unit, from the origin to the viewer
    Vec3 right_, up_;  // as long as a pixel is wide and high, in the picture plane
    Vec3 corner_;      // the picture's top left corner in the picture plane
    bool parallel_ = false;
};

}  // namespace tex::inline v1::render
