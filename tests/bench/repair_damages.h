// SPDX-License-Identifier: Apache-2.0
// repair_damages.h: damages of normal maps in double, what undoes them, and which of them can stand together.

#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <tex/types.h>

namespace tex::reference {

// A picture of stored values, 0 to 1: R, G, B (and A).
struct Values {
    Extent extent;
    int channels = 3;
    std::vector<double> of;
};

using Change = std::function<void(double* texel)>;

inline Values each(Values values, const Change& change) {
    for (std::size_t k = 0; k < values.of.size(); k += static_cast<std::size_t>(values.channels)) change(&values.of[k]);
    return values;
}

// What a damage is about. Two of the same family are one damage of another size, so that they make no pair.
enum class Family { direction, z, order, tone, alpha };

struct Damage {
    std::string name;
    Family family;
    Change plant, undo;
    bool likely = false;      // undone with RepairOptions::likely
    bool needs_y = false;     // is about the direction of green
    bool needs_blue = false;  // z must be stored
    bool with_alpha = false;
    bool needs_heights = false;
};

inline Change of_colors(const std::function<double(double)>& by) {
    return [by](double* t) { std::transform(t, t + 3, t, [&](double c) { return std::clamp(by(c), 0.0, 1.0); }); };
}

inline double srgb_curve(double c) { return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055; }
inline double srgb_curve_back(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }

inline Change inverted(int channel) {
    return [channel](double* t) { t[channel] = 1.0 - t[channel]; };
}

inline Change exchanged(int a, int b) {
    return [a, b](double* t) { std::swap(t[a], t[b]); };
}

inline double rebuilt_z(const double* t) {
    const double x = 2.0 * t[0] - 1.0, y = 2.0 * t[1] - 1.0;
    return 0.5 + 0.5 * std::sqrt(std::max(0.0, 1.0 - x * x - y * y));
}

// Levels from `black` to `white`, as image editors stretch them. Where z was cut off, it follows from x and y.
inline Damage levels(const std::string& name, double black, double white) {
    const double span = white - black;
    Damage damage{name, Family::tone, of_colors([=](double c) { return (c - black) / span; }), {}, true, false, true};
    damage.undo = [=](double* t) {
        const bool is_cut = t[2] >= 254.5 / 255.0 && white < 1.0;
        for (int c = 0; c < 3; ++c) t[c] = black + span * t[c];
        if (is_cut) t[2] = rebuilt_z(t);
    };
    return damage;
}

inline Damage gamma(const std::string& name, double by) {
    return {name,
            Family::tone,
            of_colors([=](double c) { return std::pow(std::max(0.0, c), 1.0 / by); }),
            of_colors([=](double c) { return std::pow(std::max(0.0, c), by); }),
            true,
            false,
            true};
}

// A picture that was turned by a quarter of a circle, beside its vectors: as if they were turned back.
inline Damage turned(const std::string& name, bool left) {
    const auto turn = [](bool is_left) {
        return [is_left](double* t) {
            std::swap(t[0], t[1]);
            t[is_left ? 0 : 1] = 1.0 - t[is_left ? 0 : 1];
        };
    };
    return {name, Family::direction, turn(!left), turn(left), false, true, false, false, true};
}

inline const std::vector<Damage>& damages() {
    static const std::vector<Damage> kDamages = {
        {"sRGB encoded", Family::tone, of_colors(srgb_curve), of_colors(srgb_curve_back)},
        {"sRGB decoded", Family::tone, of_colors(srgb_curve_back), of_colors(srgb_curve)},
        gamma("gamma 1.2", 1.2),
        gamma("gamma 0.8", 0.8),
        levels("levels to 90 %", 0.0, 0.9),
        levels("levels from 10 %", 0.1, 1.0),
        levels("levels 10 to 90 %", 0.1, 0.9),
        {"darkened to 0.8", Family::tone, of_colors([](double c) { return 0.8 * c; }),
         of_colors([](double c) { return c / 0.8; }), false, false, true},
        {"premultiplied", Family::alpha,
         [](double* t) {
             for (int c = 0; c < 3; ++c) t[c] *= t[3];
         },
         [](double* t) {
             for (int c = 0; c < 3; ++c) t[c] = t[3] > 0.0 ? std::min(1.0, t[c] / t[3]) : c == 2 ? 1.0 : 0.5;
         },
         false, false, true, true},
        {"BGR", Family::order, exchanged(0, 2), exchanged(0, 2), false, false, true},
        {"z from 0 to 1", Family::z, [](double* t) { t[2] = std::max(0.0, 2.0 * t[2] - 1.0); },
         [](double* t) { t[2] = 0.5 + 0.5 * t[2]; }, false, false, true},
        {"blue is 1", Family::z, [](double* t) { t[2] = 1.0; }, [](double* t) { t[2] = rebuilt_z(t); }, false, false,
         true},
        {"blue inverted", Family::z, inverted(2), inverted(2), true, false, true},
        {"green inverted", Family::direction, inverted(1), inverted(1), true, true},
        {"x and y exchanged", Family::direction, exchanged(0, 1), exchanged(0, 1), true, true},
        {"red, with heights", Family::direction, inverted(0), inverted(0), false, true, false, false, true},
        {"green, with heights", Family::direction, inverted(1), inverted(1), false, true, false, false, true},
        turned("turned left, with heights", true),
        turned("turned right, with heights", false),
    };
    return kDamages;
}

// Pairs of different families; the first one happened first. A constant blue leaves nothing that shows a change of
// levels.
inline std::vector<Damage> damage_pairs() {
    constexpr Family kOrder[] = {Family::direction, Family::z, Family::order, Family::tone, Family::alpha};
    const auto place = [&](const Damage& d) { return std::find(std::begin(kOrder), std::end(kOrder), d.family); };
    std::vector<Damage> all;
    for (const Damage& a : damages()) {
        for (const Damage& b : damages()) {
            if (place(a) >= place(b) || a.needs_heights || b.needs_heights) continue;
            if (a.name == "blue is 1" && b.family == Family::tone) continue;
            Damage& both = all.emplace_back();
            both.name = a.name + ", " + b.name;
            both.plant = [a, b](double* t) { a.plant(t), b.plant(t); };
            both.undo = [a, b](double* t) { b.undo(t), a.undo(t); };
            both.likely = true;  // two damages can hide each other
            both.needs_y = a.needs_y || b.needs_y;
            both.needs_blue = true;
            both.with_alpha = a.with_alpha || b.with_alpha;
        }
    }
    return all;
}

}  // namespace tex::reference
