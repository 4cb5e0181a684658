// SPDX-License-Identifier: Apache-2.0
// Compares the block encoders of pack() with a plain fit of each block, which is implemented here again.

#include <tex/pack.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "blocks/bc1.h"
#include "unit/packing.h"

namespace {

using packing::bumpy;
using packing::chain_of;
using packing::decode_codes;
using packing::pack_bytes;
using tex::Effort;
using tex::Encoding;
using tex::MipChain;

// The plain fit: endpoints at the extremes and indices of the nearest values; then twice a least-squares fit of the
// endpoints with new indices, if this reduces the error.
double plain_fit(const std::vector<double>& values, int steps, int codes, const auto& widen) {
    const auto narrow = [&](double value) {
        return std::clamp(static_cast<int>(std::floor(value * (codes - 1) / 255.0 + 0.5)), 0, codes - 1);
    };
    int low = narrow(*std::min_element(values.begin(), values.end()));
    int high = narrow(*std::max_element(values.begin(), values.end()));
    double least = 1e30;
    for (int round = 0; round < 3; ++round) {  // two refinements
        double error = 0, aa = 0, ab = 0, bb = 0, av = 0, bv = 0;
        for (const double value : values) {
            const double span = widen(high) - widen(low);
            const double position = span > 0 ? (value - widen(low)) / span * steps : 0;
            const int index = std::clamp(static_cast<int>(std::floor(position + 0.5)), 0, steps);
            const double off = (widen(low) * (steps - index) + widen(high) * index) / steps - value;
            const double distance = off * off;
            error += distance;
            const double b = static_cast<double>(index) / steps;
            aa += (1 - b) * (1 - b), ab += (1 - b) * b, bb += b * b;
            av += (1 - b) * value, bv += b * value;
        }
        if (error >= least) break;
        least = error;
        const double determinant = aa * bb - ab * ab;
        if (std::abs(determinant) < 1e-9) break;
        low = narrow((av * bb - bv * ab) / determinant);
        high = narrow((bv * aa - av * ab) / determinant);
    }
    return least;
}

// The root mean square error of the exact palette with `steps` spacings between the extremes, which are moved inwards
// by a part of the range; and the range.
struct Unrefined {
    double error, range;
};
Unrefined unrefined(const std::vector<double>& values, int steps, double part) {
    const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
    const double range = *greatest - *least;
    const double spacing = range * (1 - 2 * part) / steps;
    double sum = 0;
    for (const double value : values) {
        const double from = value - *least - part * range;
        const double index = spacing > 0 ? std::clamp(std::floor(from / spacing + 0.5), 0.0, 1.0 * steps) : 0;
        sum += (from - index * spacing) * (from - index * spacing);
    }
    return {std::sqrt(sum / 16), range};
}

// The errors of the two channels of every block, those of the plain fit, and those of the palettes between the
// extremes.
struct Errors {
    double x = 0, y = 0, plain_x = 0, plain_y = 0;
    Unrefined unrefined_x{}, unrefined_y{};
};
std::vector<Errors> block_errors(const MipChain& chain, Effort effort) {
    const int across = chain.levels[0].extent().width / 4;
    const int down = chain.levels[0].extent().height / 4;
    const auto bytes = pack_bytes(chain, {Encoding::dxt5nm, tex::YAxis::up, effort});
    const double unit = effort == Effort::best ? tex::kCodeUnit : 128.0;  // encoders first round to this part of a code
    std::vector<Errors> errors;
    for (int block = 0; block < across * down; ++block) {
        std::vector<double> x(16), y(16);
        float decoded_x[16], decoded_y[16];
        decode_codes(bytes.data() + 16 * block, Encoding::dxt5nm, decoded_x, decoded_y);
        Errors e;
        for (int k = 0; k < 16; ++k) {
            const int i = block % across * 4 + k % 4;
            const int j = block / across * 4 + k / 4;
            const auto t = static_cast<std::size_t>(k);
            x[t] = std::floor((chain.levels[0].x.at(i, j) * 127.5 + 127.5) * unit + 0.5) / unit;
            y[t] = std::floor((chain.levels[0].y.at(i, j) * 127.5 + 127.5) * unit + 0.5) / unit;
            e.x += (x[t] - decoded_x[k]) * (x[t] - decoded_x[k]);
            e.y += (y[t] - decoded_y[k]) * (y[t] - decoded_y[k]);
        }
        e.plain_x = plain_fit(x, 7, 256, [](int code) { return static_cast<double>(code); });
        e.plain_y = plain_fit(y, 3, 64, [](int code) { return static_cast<double>(tex::widen_green(code)); });
        e.unrefined_x = unrefined(x, 7, 0);
        e.unrefined_y = unrefined(y, 3, 1.0 / 16);
        errors.push_back(e);
    }
    return errors;
}

TEST(Pack, NoBlockIsWorseThanAPlainFitWithLeastSquaresOrInFastThanOneWithout) {
    for (const float steepness : {0.02f, 0.3f, 1.0f}) {
        MipChain chain = chain_of(bumpy({256, 256}, 21));
        for (int j = 0; j < 256; ++j) {
            for (int i = 0; i < 256; ++i) {
                chain.levels[0].x.at(i, j) *= steepness;
                chain.levels[0].y.at(i, j) *= steepness;
            }
        }
        // fast may be worse, but by no more than fit.h says.
        for (const Errors& e : block_errors(chain, Effort::fast)) {
            const double alpha_rounding = e.unrefined_x.range < 1 ? 1.0 : 0.5;
            ASSERT_LE(std::sqrt(e.x / 16), e.unrefined_x.error + alpha_rounding + e.unrefined_x.range / 400);
            ASSERT_LE(std::sqrt(e.y / 16), e.unrefined_y.error + 2.8 + e.unrefined_y.range / 400);
        }
        for (const Effort effort : {Effort::normal, Effort::best}) {
            for (const Errors& e : block_errors(chain, effort)) {
                ASSERT_LE(e.x, 1.001 * e.plain_x + 0.01) << tex::name_of(tex::kEffortNames, effort) << " " << steepness;
                ASSERT_LE(e.y, 1.001 * e.plain_y + 0.01) << tex::name_of(tex::kEffortNames, effort) << " " << steepness;
            }
        }
    }
}

TEST(Pack, NormalIsBetterThanAPlainFitAndFastHardlyWorse) {
    const MipChain chain = chain_of(bumpy({256, 64}, 21));
    for (const Effort effort : {Effort::fast, Effort::normal}) {
        Errors sum;
        for (const Errors& e : block_errors(chain, effort)) {
            sum.x += e.x, sum.y += e.y, sum.plain_x += e.plain_x, sum.plain_y += e.plain_y;
        }
        const double limit = effort == Effort::normal ? 0.95 : 1.1;
        EXPECT_LT(sum.x, limit * sum.plain_x);
        EXPECT_LT(sum.y, limit * sum.plain_y);
    }
}

}  // namespace
