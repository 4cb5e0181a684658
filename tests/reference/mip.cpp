// SPDX-License-Identifier: Apache-2.0

#include "reference/mip.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tex::reference {
namespace {

double sinc(double x) { return x == 0.0 ? 1.0 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x); }

double mitchell_netravali(double x, double b, double c) {
    x = std::fabs(x);
    if (x < 1.0) return ((12 - 9 * b - 6 * c) * x * x * x + (-18 + 12 * b + 6 * c) * x * x + (6 - 2 * b)) / 6.0;
    if (x < 2.0) {
        return ((-b - 6 * c) * x * x * x + (6 * b + 30 * c) * x * x + (-12 * b - 48 * c) * x + (8 * b + 24 * c)) / 6.0;
    }
    return 0.0;
}

double filter_value(MipFilter filter, double x) {
    const double a = std::fabs(x);
    switch (filter) {
        case MipFilter::box: break;  // by area
        case MipFilter::triangle: return std::max(0.0, 1.0 - a);
        case MipFilter::kaiser:
            return a < 3.0 ? sinc(x) * std::cyl_bessel_i(0.0, 4.0 * std::sqrt(1.0 - x * x / 9.0)) /
                                 std::cyl_bessel_i(0.0, 4.0)
                           : 0.0;
        case MipFilter::mitchell: return mitchell_netravali(x, 1.0 / 3.0, 1.0 / 3.0);
        case MipFilter::catmull_rom: return mitchell_netravali(x, 0.0, 0.5);
        case MipFilter::lanczos3: return a < 3.0 ? sinc(x) * sinc(x / 3.0) : 0.0;
    }
    return 0.0;
}

int inside(Wrap wrap, int i, int n) {
    while (i < 0 || i >= n) {
        switch (wrap) {
            case Wrap::repeat: i = i < 0 ? i + n : i - n; break;
            case Wrap::clamp: i = i < 0 ? 0 : n - 1; break;
            case Wrap::mirror: i = i < 0 ? -1 - i : 2 * n - 1 - i; break;
        }
    }
    return i;
}

Grid<Vector> next_level(const Grid<Vector>& level, const MipOptions& options) {
    const Extent from = level.extent;
    Grid<Vector> next(Extent{std::max(1, from.width / 2), std::max(1, from.height / 2)});
    for (int j = 0; j < next.extent.height; ++j) {
        const Weights down = mip_weights(options.filter, from.height, j);
        for (int i = 0; i < next.extent.width; ++i) {
            const Weights across = mip_weights(options.filter, from.width, i);
            Vector sum;
            for (int b = 0; b < static_cast<int>(down.weights.size()); ++b) {
                for (int a = 0; a < static_cast<int>(across.weights.size()); ++a) {
                    const double w =
                        down.weights[static_cast<std::size_t>(b)] * across.weights[static_cast<std::size_t>(a)];
                    const Vector v = level.at(inside(options.wrap_x, across.first + a, from.width),
                                              inside(options.wrap_y, down.first + b, from.height));
                    sum = {sum.x + w * v.x, sum.y + w * v.y, sum.z + w * v.z};
                }
            }
            next.at(i, j) = sum;
        }
    }
    return next;
}

}  // namespace

Weights mip_weights(MipFilter filter, int n, int i) {
    if (n == 1) return {0, {1.0}};
    const double scale = static_cast<double>(n) / (n / 2);
    Weights result;
    double sum = 0.0;
    // Far more texels than any filter reaches; the weights of those out of reach are 0.
    result.first = static_cast<int>(i * scale) - 12;
    for (int s = result.first; s < result.first + 28; ++s) {
        double w = 0.0;
        if (filter == MipFilter::box) {
            w = std::max(0.0, std::min(s + 1.0, (i + 1) * scale) - std::max<double>(s, i * scale));
        } else {
            w = filter_value(filter, (s + 0.5) / scale - (i + 0.5));
        }
        result.weights.push_back(w);
        sum += w;
    }
    for (double& w : result.weights) w /= sum;
    return result;
}

std::vector<Grid<Vector>> mip_averages(const Grid<Vector>& base, const MipOptions& options) {
    std::vector<Grid<Vector>> levels = {base};
    if (options.domain == MipDomain::slope) {
        for (Vector& v : levels[0].values) {
            const double z = std::max(v.z, 1.0 / 256.0);
            v = {v.x / z, v.y / z, 0.0};
        }
    }
    const auto wanted = [&] { return options.levels == 0 || static_cast<int>(levels.size()) < options.levels; };
    while (wanted() && (levels.back().extent.width > 1 || levels.back().extent.height > 1)) {
        levels.push_back(next_level(levels.back(), options));
    }
    return levels;
}

std::vector<Grid<Vector>> build_mip_chain(const Grid<Vector>& base, const MipOptions& options) {
    std::vector<Grid<Vector>> levels = mip_averages(base, options);
    levels[0] = base;
    for (std::size_t k = 1; k < levels.size(); ++k) {
        double t = 0.0;
        if (options.fade) {
            t = (static_cast<double>(k) - options.fade->first) / (options.fade->last - options.fade->first);
            t = std::min(1.0, std::max(0.0, t));
        }
        for (Vector& v : levels[k].values) {
            if (options.domain == MipDomain::slope) v.z = 1.0;
            v.z = std::max(0.0, v.z);
            v = normalised(v);
            v = normalised({(1 - t) * v.x, (1 - t) * v.y, (1 - t) * v.z + t});
        }
    }
    return levels;
}

}  // namespace tex::reference
