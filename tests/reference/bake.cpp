// SPDX-License-Identifier: Apache-2.0

#include "reference/bake.h"

#include <cmath>
#include <functional>

namespace tex::reference {
namespace {

// The height at index i of an axis of n texels whose heights are h(0) to h(n - 1).
double along_axis(const std::function<double(int)>& h, Wrap wrap, int n, int i) {
    if (i >= 0 && i < n) return h(i);
    if (n == 1) return h(0);
    switch (wrap) {
        case Wrap::repeat: return along_axis(h, wrap, n, i < 0 ? i + n : i - n);
        case Wrap::mirror: return along_axis(h, wrap, n, i < 0 ? -1 - i : 2 * n - 1 - i);
        case Wrap::clamp: break;
    }
    const int border = i < 0 ? 0 : n - 1;
    return 2.0 * h(border) - along_axis(h, wrap, n, 2 * border - i);
}

// The kernels as the header writes them, element [radius + k] at offset k; y up.
struct Kernel {
    std::vector<double> derivative;
    std::vector<double> smoothing;
};

Kernel gaussian(double sigma) {
    const int radius = static_cast<int>(std::ceil(3.0 * sigma));
    Kernel kernel;
    double moment = 0.0, sum = 0.0;
    for (int k = -radius; k <= radius; ++k) {
        const double g = std::exp(-k * k / (2.0 * sigma * sigma));
        kernel.derivative.push_back(k * g);
        kernel.smoothing.push_back(g);
        moment += k * k * g;
        sum += g;
    }
    for (double& d : kernel.derivative) d /= moment;
    for (double& s : kernel.smoothing) s /= sum;
    return kernel;
}

Kernel kernel_of(const BakeOptions& options) {
    switch (options.kernel) {
        case GradientKernel::forward: return {{0, -1, 1}, {0, 1, 0}};
        case GradientKernel::central: return {{-0.5, 0, 0.5}, {0, 1, 0}};
        case GradientKernel::sobel: return {{-0.5, 0, 0.5}, {0.25, 0.5, 0.25}};
        case GradientKernel::scharr: return {{-0.5, 0, 0.5}, {3 / 16.0, 10 / 16.0, 3 / 16.0}};
        case GradientKernel::prewitt: return {{-0.5, 0, 0.5}, {1 / 3.0, 1 / 3.0, 1 / 3.0}};
        case GradientKernel::sobel5:
            return {{-1 / 8.0, -2 / 8.0, 0, 2 / 8.0, 1 / 8.0}, {1 / 16.0, 4 / 16.0, 6 / 16.0, 4 / 16.0, 1 / 16.0}};
        case GradientKernel::gaussian: return gaussian(static_cast<double>(options.gaussian_sigma));
    }
    return {};
}

double clamped_slope(double slope) { return std::fmin(std::fmax(slope, -1e15), 1e15); }

}  // namespace

double height_at(const Grid<double>& heights, Wrap wrap_x, Wrap wrap_y, int i, int j) {
    const auto in_row = [&](int row) {
        return along_axis([&](int column) { return heights.at(column, row); }, wrap_x, heights.extent.width, i);
    };
    return along_axis(in_row, wrap_y, heights.extent.height, j);
}

Grid<Vector> bake(const HeightField& field, const BakeOptions& options) {
    const Grid<double> heights = grid_of(field.height);
    const Extent extent = heights.extent;
    const Kernel kernel = kernel_of(options);
    const int radius = static_cast<int>(kernel.derivative.size()) / 2;
    const auto d = [&](int k) { return kernel.derivative[static_cast<std::size_t>(radius + k)]; };
    const auto s = [&](int k) { return kernel.smoothing[static_cast<std::size_t>(radius + k)]; };

    // The heights with as much around them as the kernel needs.
    Grid<double> wide(Extent{extent.width + 2 * radius, extent.height + 2 * radius});
    for (int j = -radius; j < extent.height + radius; ++j) {
        for (int i = -radius; i < extent.width + radius; ++i) {
            wide.at(i + radius, j + radius) = height_at(heights, field.wrap_x, field.wrap_y, i, j);
        }
    }
    const auto h = [&](int i, int j) { return wide.at(i + radius, j + radius); };

    Grid<Vector> normals(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            double du = 0.0, dv = 0.0;
            for (int a = -radius; a <= radius; ++a) {
                for (int b = -radius; b <= radius; ++b) {
                    du += d(a) * s(b) * h(i + a, j - b);  // b texels up is row j - b
                    dv += s(a) * d(b) * h(i + a, j - b);
                }
            }
            if (extent.width == 1) du = 0.0;
            if (extent.height == 1) dv = 0.0;
            const double p = clamped_slope(static_cast<double>(field.bumpiness_x) * du);
            const double q = clamped_slope(static_cast<double>(field.bumpiness_y) * dv);
            normals.at(i, j) = normalised({-p, -q, 1.0});
        }
    }
    return normals;
}

}  // namespace tex::reference
