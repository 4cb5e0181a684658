// SPDX-License-Identifier: Apache-2.0

#include "checks/tone_text.h"

#include <cmath>

#include "checks/findings.h"

namespace tex::inline v1 {

bool is_shift(const ToneCurve& curve) {
    return curve.gamma == 1.0 && curve.lightness == 1.0 && std::abs(curve.white - curve.black - 1.0) < 1e-9;
}

std::string curve_text(const ToneCurve& curve, std::string_view of) {
    const std::string end(of);
    if (curve.lightness != 1.0)
        return "a lightness (HSL) of " + decimal(100.0 * curve.lightness, 0) + " %" + end + " is";
    if (curve.gamma != 1.0) return "gamma " + decimal(curve.gamma, 2) + end + " is";
    if (is_shift(curve)) {
        return "a brightness of " + std::string(curve.black < 0.0 ? "+" : "-") +
               decimal(255.0 * std::abs(curve.black), 0) + " of 255" + end + " is";
    }
    return "the levels from " + decimal(100.0 * curve.black, 0) + " % to " + decimal(100.0 * curve.white, 0) + " %" +
           end + " are";
}

}  // namespace tex::inline v1
