// SPDX-License-Identifier: Apache-2.0

#include "c/call_bake.h"

#include <cmath>

#include "kernels/bake.h"
#include "rows/whole_vectors.h"

namespace tex::inline v1 {
namespace {

// Hands out rows of heights, and notes whether they are finite.
struct CheckedHeights {
    const tex_plane& plane;
    bool finite = true;

    const float* row(int j) {
        const float* const heights = row_of(plane, j);
        const int whole = plane.width / kWhole * kWhole;
        float end[kWhole] = {};
        std::copy_n(heights + whole, plane.width - whole, end);
        finite = finite && are_finite(heights, whole) && are_finite(end, kWhole);
        return heights;
    }
};

}  // namespace

bool is_bake(int32_t kernel, float gaussian_sigma, int32_t wrap_x, int32_t wrap_y) {
    if (!is_one_of(kernel, kGradientKernelNames) || !is_one_of(wrap_x, kWrapNames) || !is_one_of(wrap_y, kWrapNames))
        return false;
    return kernel != TEX_KERNEL_GAUSSIAN || (gaussian_sigma > 0.0f && gaussian_sigma <= kMaxGaussianSigma);
}

BakeOptions bake_options(int32_t kernel, float gaussian_sigma) {
    return {static_cast<GradientKernel>(kernel), gaussian_sigma};
}

int gradient_radius(const BakeOptions& options) {
    switch (options.kernel) {
        case GradientKernel::sobel5: return 2;
        case GradientKernel::gaussian:
            return static_cast<int>(std::ceil(3.0 * static_cast<double>(options.gaussian_sigma)));
        default: return 1;
    }
}

void add_gradient(ScratchSize& size, int radius) {
    for (int k = 0; k < 2; ++k) size.vector<double>(radius + 1);
    for (int k = 0; k < 3; ++k) size.vector<float>(radius + 1);
}

void add_bake_rows(ScratchSize& size, int width, int radius) {
    const int window = 2 * radius + 1, lead = (radius + kWhole - 1) / kWhole * kWhole;
    size.plane(2 * lead + width, window);
    size.plane(width, window);
    size.plane(2 * lead + width, 1);
    for (int k = 0; k < 2; ++k) size.vector<const float*>(window);
}

}  // namespace tex::inline v1

using namespace tex;

size_t tex_bake_size(int32_t width, int32_t height, const tex_bake_options* options) {
    tex_bake_options o;
    if (!is_extent(width, height) || copy_options(options, o) != TEX_OK) return 0;
    if (!is_bake(o.kernel, o.gaussian_sigma, o.wrap_x, o.wrap_y)) return 0;
    const int radius = gradient_radius(bake_options(o.kernel, o.gaussian_sigma));
    ScratchSize size;
    add_gradient(size, radius);
    add_bake_rows(size, width, radius);
    return size.bytes();
}

int32_t tex_bake(const tex_plane* heights, const tex_bake_options* options, int32_t first, int32_t end,
                 const tex_map* out, void* scratch, size_t scratch_size) {
    if (!is_plane(heights) || !is_map(out) || !same_extent(*heights, *out) || !are_rows(first, end, out->height))
        return TEX_BAD_ARGUMENT;
    tex_bake_options o;
    if (const int32_t error = copy_options(options, o); error != TEX_OK) return error;
    if (!is_bake(o.kernel, o.gaussian_sigma, o.wrap_x, o.wrap_y)) return TEX_BAD_OPTION;
    if (!std::isfinite(o.bumpiness_x) || !std::isfinite(o.bumpiness_y)) return TEX_BAD_OPTION;
    const std::size_t wanted = tex_bake_size(out->width, out->height, options);
    return with_scratch(scratch, scratch_size, wanted, [&] {
        CheckedHeights checked{*heights};
        const Gradient gradient = gradient_of(bake_options(o.kernel, o.gaussian_sigma));
        const HeightFieldHead head{o.bumpiness_x, o.bumpiness_y, static_cast<Wrap>(o.wrap_x),
                                   static_cast<Wrap>(o.wrap_y)};
        BakeRows rows(
            {out->width, out->height}, [&checked](int j) { return checked.row(j); }, gradient, head, first);
        for (int j = first; j < end; ++j) rows.bake_exactly(j, row_of(*out, j));
        return checked.finite ? TEX_OK : TEX_BAD_DATA;
    });
}
