// SPDX-License-Identifier: Apache-2.0

#include "reference/roughness.h"

#include <algorithm>
#include <cmath>

#include "reference/mip.h"

namespace tex::reference {

double rougher_alpha2(RoughnessModel model, double m, double alpha2) {
    if (m >= 1.0 || alpha2 >= 1.0) return alpha2;
    if (model == RoughnessModel::vmf) {
        const double kappa = (3.0 * m - m * m * m) / (1.0 - m * m);
        return std::min(1.0, alpha2 + 1.0 / (2.0 * kappa));
    }
    double power = m / (1.0 - m);  // of a mirror
    if (alpha2 > 0.0) {
        const double s = 2.0 / alpha2 - 2.0;
        power = s * m / (m + s * (1.0 - m));
    }
    return 2.0 / (power + 2.0);
}

std::vector<Grid<double>> build_roughness_chain(const Grid<Vector>& base, const Grid<double>& roughness,
                                                RoughnessModel model, const MipOptions& options) {
    MipOptions averaging = options;
    averaging.domain = MipDomain::vector;
    Grid<Vector> squares(base.extent);
    for (std::size_t k = 0; k < squares.values.size(); ++k) squares.values[k].x = std::pow(roughness.values[k], 4.0);
    const auto vectors = mip_averages(base, averaging);
    const auto alphas = mip_averages(squares, averaging);
    std::vector<Grid<double>> levels = {roughness};
    for (std::size_t level = 1; level < vectors.size(); ++level) {
        Grid<double>& out = levels.emplace_back(vectors[level].extent);
        for (std::size_t k = 0; k < out.values.size(); ++k) {
            const Vector v = vectors[level].values[k];
            const double m = std::min(1.0, std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z));
            const double alpha2 = std::clamp(alphas[level].values[k].x, 0.0, 1.0);
            out.values[k] = std::pow(rougher_alpha2(model, m, alpha2), 0.25);
        }
    }
    return levels;
}

}  // namespace tex::reference
