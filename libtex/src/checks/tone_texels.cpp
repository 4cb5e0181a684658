// SPDX-License-Identifier: Apache-2.0

#include "checks/tone_texels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "checks/centre.h"
#include "checks/lengths.h"
#include "checks/lightness.h"
#include "rows/math.h"

namespace tex::inline v1 {
namespace {

constexpr std::int64_t kToneTexels = 1 << 14;
constexpr double kFormLead = 2.0;          // of the error of the usual form over that of another
constexpr double kInvertedRelated = -0.3;  // a correlation

// `undo` and `redo` change whole texels.
template <class Undo, class Redo>
double mean_error(const ToneTexels& texels, ZForm form, Undo&& undo, Redo&& redo) {
    double sum = 0.0;
    for (const ToneTexel& texel : texels) {
        ToneTexel before = undo(texel);
        const double a = 2.0 * before[0] - 1.0, b = 2.0 * before[1] - 1.0, square = 1.0 - a * a - b * b;
        before[2] = stored_z(form, std::sqrt(std::max(0.0, square)));
        const ToneTexel expected = redo(before);
        double most = 0.0;  // lightness follows from z, and x and y from lightness
        for (std::size_t c = 0; c < 3; ++c) most = std::max(most, std::abs(expected[c] - texel[c]));
        sum += most + 0.5 * std::max(0.0, -square);
    }
    return 255.0 * sum / static_cast<double>(std::max<std::size_t>(1, texels.size()));
}

}  // namespace

double undone(const ToneCurve& curve, double c) {
    const double power = curve.gamma == 1.0 ? c : math::pow(c, curve.gamma);
    return curve.black + (curve.white - curve.black) * power;
}

double redone(const ToneCurve& curve, double c) {
    const double level = std::clamp((c - curve.black) / (curve.white - curve.black), 0.0, 1.0);
    return curve.gamma == 1.0 ? level : math::pow(level, 1.0 / curve.gamma);
}

ToneTexel undone(const ToneCurve& curve, const ToneTexel& texel) {
    if (curve.lightness != 1.0) return with_lightness(texel, 1.0 / curve.lightness);
    return {undone(curve, texel[0]), undone(curve, texel[1]), undone(curve, texel[2])};
}

ToneTexel redone(const ToneCurve& curve, const ToneTexel& texel) {
    if (curve.lightness != 1.0) return with_lightness(texel, curve.lightness);
    return {redone(curve, texel[0]), redone(curve, texel[1]), redone(curve, texel[2])};
}

ToneTexels tone_texels(const Stored& stored, const Background* background) {
    const int x = stored.channel(Component::x), y = stored.channel(Component::y), z = channel_like_z(stored);
    const auto& planes = stored.image->planes;
    const std::vector<Rect> windows = sample_windows(stored.extent());
    std::int64_t all = 0;
    for (const Rect& window : windows) all += std::int64_t{window.width} * window.height;
    // Odd, so that it does not follow columns of a map.
    const auto step = all > 7 * kToneTexels ? std::max<std::int64_t>(7, all / kToneTexels) | 1
                      : all > kToneTexels   ? 7
                                            : 1;
    ToneTexels texels;
    for (const Rect& window : windows) {
        for (std::int64_t k = 0; k < std::int64_t{window.width} * window.height; k += step) {
            const int i = window.x + static_cast<int>(k % window.width);
            const int j = window.y + static_cast<int>(k / window.width);
            if (background != nullptr && background->holds(i, j)) continue;
            const auto at = [&](int c) { return static_cast<double>(planes[static_cast<std::size_t>(c)].at(i, j)); };
            const std::array<double, 3> texel = {at(x), at(y), at(z)};
            const auto is_code = [](double c) { return c >= 0.0 && c <= 1.0; };
            if (std::all_of(texel.begin(), texel.end(), is_code)) texels.push_back(texel);
        }
    }
    return texels;
}

double stored_z(ZForm form, double root) {
    return form == ZForm::whole ? 0.5 + 0.5 * root : form == ZForm::inverted ? 0.5 - 0.5 * root : root;
}

double error_of(const ToneCurve& curve, const ToneTexels& texels, ZForm form) {
    if (curve.lightness != 1.0) {
        return mean_error(
            texels, form, [&](const ToneTexel& texel) { return undone(curve, texel); },
            [&](const ToneTexel& texel) { return redone(curve, texel); });
    }
    double sum = 0.0;
    for (const auto& [x, y, z] : texels) {
        const double a = 2.0 * undone(curve, x) - 1.0, b = 2.0 * undone(curve, y) - 1.0;
        const double square = 1.0 - a * a - b * b;
        const double expected = redone(curve, stored_z(form, std::sqrt(std::max(0.0, square))));
        sum += std::abs(expected - z) + 0.5 * std::max(0.0, -square);
    }
    return 255.0 * sum / static_cast<double>(std::max<std::size_t>(1, texels.size()));
}

double error_of_srgb(bool is_encoded, const ToneTexels& texels, ZForm form) {
    const auto by = [](double (*of)(double)) {
        return [of](const ToneTexel& texel) { return ToneTexel{of(texel[0]), of(texel[1]), of(texel[2])}; };
    };
    return mean_error(texels, form, by(is_encoded ? srgb_decoded : srgb_encoded),
                      by(is_encoded ? srgb_encoded : srgb_decoded));
}

double share_uncut(const ToneCurve& curve, const ToneTexels& texels, ZForm form) {
    constexpr double kEdge = 1.0 / 255.0;
    std::size_t uncut = 0;
    for (const auto& [x, y, z] : texels) {
        if (curve.lightness != 1.0) {
            uncut += z < 1.0 - kEdge ? 1 : 0;
            continue;
        }
        const double a = 2.0 * undone(curve, x) - 1.0, b = 2.0 * undone(curve, y) - 1.0;
        const double expected = redone(curve, stored_z(form, std::sqrt(std::max(0.0, 1.0 - a * a - b * b))));
        uncut += expected > kEdge && expected < 1.0 - kEdge ? 1 : 0;
    }
    return static_cast<double>(uncut) / static_cast<double>(std::max<std::size_t>(1, texels.size()));
}

double share_cut(const ToneCurve& curve, const ToneTexels& texels) {
    const auto is_cut = [&](double c) { return (curve.black > 0.0 && c <= 0.0) || (curve.white < 1.0 && c >= 1.0); };
    const auto cut = std::count_if(texels.begin(), texels.end(),
                                   [&](const auto& texel) { return is_cut(texel[0]) || is_cut(texel[1]); });
    return static_cast<double>(cut) / static_cast<double>(std::max<std::size_t>(1, texels.size()));
}

bool has_coarse_middle(const ToneTexels& texels, double middle) {
    constexpr double kCoarse = 6.0 / 255.0;
    for (const std::size_t c : {std::size_t{0}, std::size_t{1}}) {
        double below = 0.0, above = 1.0;
        for (const auto& texel : texels) {
            const bool is_below = texel[c] < middle;
            (is_below ? below : above) = is_below ? std::max(below, texel[c]) : std::min(above, texel[c]);
        }
        if (above - below >= kCoarse) return true;
    }
    return false;
}

std::vector<ZForm> possible_forms(const ToneTexels& texels) {
    // Steep vectors lie far from the middle of their colours, whatever the curve.
    double n = 0.0, middle_x = 0.0, middle_y = 0.0;
    for (const auto& [x, y, z] : texels) {
        middle_x += x;
        middle_y += y;
        n += 1.0;
    }
    if (n == 0.0) return {ZForm::whole};
    middle_x /= n;
    middle_y /= n;
    double sum = 0.0, sum_z = 0.0, squares = 0.0, squares_z = 0.0, product = 0.0;
    for (const auto& [x, y, z] : texels) {
        const double steep = (x - middle_x) * (x - middle_x) + (y - middle_y) * (y - middle_y);
        sum += steep;
        sum_z += z;
        squares += steep * steep;
        squares_z += z * z;
        product += steep * z;
    }
    const double both = (squares / n - sum * sum / n / n) * (squares_z / n - sum_z * sum_z / n / n);
    const double correlation = both > 0.0 ? -(product / n - sum * sum_z / n / n) / std::sqrt(both) : 0.0;
    if (correlation < kInvertedRelated) return {ZForm::inverted};
    return {ZForm::whole, ZForm::from_zero};
}

ZForm likeliest_form(const ToneCurve& curve, const ToneTexels& texels) {
    ZForm best = ZForm::whole;
    double least = error_of(curve, texels) / kFormLead;
    for (const ZForm form : possible_forms(texels)) {
        if (form == ZForm::whole) continue;
        const double error = error_of(curve, texels, form);
        if (error >= least) continue;
        least = error;
        best = form;
    }
    return best;
}

}  // namespace tex::inline v1
