// SPDX-License-Identifier: Apache-2.0

#include "preview/renderer.h"

#include <algorithm>

#include "preview/canvas.h"
#include "preview/mesh_renderer.h"
#include "preview/shading.h"
#include "threads/parallel.h"

namespace tex::inline v1::render {
namespace {

constexpr int kRowsOfRays = 8;
constexpr int kRaysPerSide = 4;  // rays per side of a pixel on an outline

Camera camera_of(const PreviewOptions& options, bool of_mesh) {
    if (options.camera) return *options.camera;
    Camera camera;
    if (of_mesh) {
        camera.yaw = 30.0f;
        camera.pitch = 20.0f;
    }
    if (options.shape == Shape::cube) {
        camera.yaw = -35.0f;
        camera.pitch = 25.0f;
    }
    return camera;
}

// The pixels of a stage.
class Painter {
public:
    Painter(const Stage& stage, Space space, const Surface& surface) : stage_(stage), surface_(surface) {
        const double ground[3] = {kGround.r / 255.0, kGround.g / 255.0, kGround.b / 255.0};
        ground_ = {ground[0], ground[1], ground[2]};
        if (space == Space::linear) {
            ground_ = {srgb_to_linear(ground[0]), srgb_to_linear(ground[1]), srgb_to_linear(ground[2])};
        }
    }

    [[nodiscard]] Vec3 pixel(int i, int j) const {
        if (!on_outline(i, j)) return color(i + 0.5, j + 0.5);
        Vec3 sum;
        for (int b = 0; b < kRaysPerSide; ++b) {
            for (int a = 0; a < kRaysPerSide; ++a) {
                sum = sum + color(i + (a + 0.5) / kRaysPerSide, j + (b + 0.5) / kRaysPerSide);
            }
        }
        return sum * (1.0 / (kRaysPerSide * kRaysPerSide));
    }

private:
    [[nodiscard]] bool on_outline(int i, int j) const {
        const int face = stage_.body.face(stage_.view.ray(i, j));
        return face != stage_.body.face(stage_.view.ray(i + 1, j)) ||
               face != stage_.body.face(stage_.view.ray(i, j + 1)) ||
               face != stage_.body.face(stage_.view.ray(i + 1, j + 1));
    }

    [[nodiscard]] Vec3 color(double x, double y) const {
        const std::optional<Hit> hit = stage_.body.meet(stage_.view.ray(x, y));
        if (!hit) return ground_;
        return surface_(*hit, {uv_step(*hit, stage_.view.ray(x + 1.0, y)), uv_step(*hit, stage_.view.ray(x, y + 1.0))});
    }

    const Stage& stage_;
    const Surface& surface_;
    Vec3 ground_;
};

}  // namespace

Stage stage(const PreviewOptions& options, const MeshBody* mesh, Extent map, Extent size) {
    const Body body(options, map);
    const View view(camera_of(options, mesh != nullptr), size, [&](Vec3 direction) { return body.support(direction); });
    Stage result{body, mesh, view, size, illumination(options).light};
    const double angle = radians(static_cast<double>(options.spin));
    const double sine = math::sin(angle), cosine = math::cos(angle);
    if (options.shape == Shape::plane) {
        result.light = turn_about_z(result.light, -sine, cosine);  // clockwise, like the hand of a clock
    } else {
        result.light = turn_about_y(result.light, -sine, cosine);
        result.view.turn(-sine, cosine);
        result.spin_sine = sine;
        result.spin_cosine = cosine;
    }
    return result;
}

Result<Texture> render(const Stage& stage, Space space, const Surface& surface, const Execution& execution) {
    if (stage.mesh != nullptr) return render_mesh(stage, space, surface, {}, execution);
    Canvas canvas(stage.size);
    const Painter painter(stage, space, surface);
    const auto code = space == Space::linear ? srgb_code : display_code;
    const auto done = parallel_for(execution, stage.size.height, kRowsOfRays, [&](int begin, int end) {
        for (int j = begin; j < end; ++j) {
            for (int i = 0; i < stage.size.width; ++i) {
                const Vec3 color = painter.pixel(i, j);
                canvas.set(i, j, {code(color.x), code(color.y), code(color.z)});
            }
        }
    });
    if (!done) return done.error();
    return std::move(canvas).take();
}

}  // namespace tex::inline v1::render
