// SPDX-License-Identifier: Apache-2.0

#include "checks/background_fill.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "checks/findings.h"
#include "rows/math.h"
#include "surface/nearest.h"

namespace tex::inline v1 {
namespace {

constexpr float kFillLength = 0.5f;   // of a vector that has a direction
constexpr float kFillMixed = 0.25f;   // sine of the angle to the mixtures: what rounding and texel blocks leave
constexpr float kFillRinging = 0.5f;  // from the value: what JPEG makes of it
constexpr float kFillAlike = 0.9f;    // cosine of the angle to a neighbour: 26 degrees
constexpr int kFillAlikeTexels = 2;   // neighbours: along a border there are two
constexpr int kFillReach = 3;         // texels: filters mix over two, and the normal that was mixed in lies beyond
constexpr double kFillTurn = 5.0;     // degrees that count as a change
constexpr std::int64_t kFillTexels = 16;
constexpr double kFillShare = 0.12;  // of the mixtures that have a direction: VERDICTS.md

struct FillVector {
    float x = 0.0f, y = 0.0f, z = 0.0f;
    [[nodiscard]] float dot(const FillVector& o) const { return x * o.x + y * o.y + z * o.z; }
    [[nodiscard]] float length() const { return std::sqrt(dot(*this)); }
    [[nodiscard]] FillVector unit() const {
        const float l = length();
        return l > 0.0f ? FillVector{x / l, y / l, z / l} : FillVector{};
    }
};

class Filling {
public:
    Filling(const Stored& stored, const Background& background)
        : stored_(stored), background_(background), extent_(stored.extent()), x_(stored.channel(Component::x)),
          y_(stored.channel(Component::y)), z_(stored.channel(Component::z)),
          value_(completed({background.value[0], background.value[1], background.value[2]})),
          is_grey_(z_ >= 0 && is_near(value_, {value_.x, value_.x, value_.x}, kTwinNear)) {}

    [[nodiscard]] Extent extent() const { return extent_; }
    [[nodiscard]] FillVector at(int i, int j) const {
        return completed(
            {stored_.component(x_, i, j), stored_.component(y_, i, j), z_ < 0 ? 0.0f : stored_.component(z_, i, j)});
    }
    // Whether the vector has a direction, and is not the value with JPEG's ringing.
    [[nodiscard]] bool has_direction(const FillVector& v) const {
        const float length = v.length();
        return length >= kFillLength && std::isfinite(length) && !is_near(v, value_, kFillRinging);
    }
    // Whether filling a hole with this vector takes a normal away.
    [[nodiscard]] bool is_own(int i, int j, const FillVector& v) const {
        const FillVector u = v.unit();
        return has_alike(i, j, u) && !is_mixture(i, j, u);
    }
    // Whether the value itself may be a normal that some tool made too long or too short, as bevels have: then there
    // are others that lean as far the other way, or it fills strips alone.
    [[nodiscard]] bool may_be_a_normal() const { return has_twins() || is_a_strip(); }

private:
    [[nodiscard]] FillVector completed(FillVector v) const {
        if (z_ < 0) v.z = std::sqrt(std::max(0.0f, 1.0f - v.x * v.x - v.y * v.y));
        return v;
    }
    template <class Visit>
    bool any_around(int i, int j, int reach, const Visit& visit) const {
        for (int y = std::max(0, j - reach); y <= std::min(extent_.height - 1, j + reach); ++y) {
            for (int x = std::max(0, i - reach); x <= std::min(extent_.width - 1, i + reach); ++x) {
                if ((x != i || y != j) && visit(x, y)) return true;
            }
        }
        return false;
    }
    [[nodiscard]] bool has_alike(int i, int j, const FillVector& u) const {
        int alike = 0;
        return any_around(i, j, 1, [&](int x, int y) {
            if (background_.holds(x, y) && !background_.is_mixed(x, y)) return false;
            const FillVector v = at(x, y);
            alike += v.length() >= kFillLength && u.dot(v.unit()) > kFillAlike ? 1 : 0;
            return alike >= kFillAlikeTexels;
        });
    }
    // Whether the direction is a sum of the value's and of a normal's near it, with positive weights.
    [[nodiscard]] bool is_mixture(int i, int j, const FillVector& u) const {
        const FillVector b = value_.length() >= kFillLength ? value_.unit() : FillVector{};
        return any_around(i, j, stored_.in_blocks ? 2 * kFillReach : kFillReach, [&](int x, int y) {
            if (background_.holds(x, y)) return false;
            const FillVector n = at(x, y).unit();
            const float nu = n.dot(u), bu = b.dot(u), nb = n.dot(b), across = 1.0f - nb * nb;
            // The nearest point of the plane of n and b, or of the rays at its sides.
            float kept = std::max({nu, bu, 0.0f});
            // JPEG blurs colours more than brightness, so that normals are mixed with grey beyond the value, too.
            const float p = nu - bu * nb, q = bu - nu * nb;
            if (across > 1e-4f && p > 0.0f && (q > 0.0f || is_grey_)) kept = std::sqrt((p * nu + q * bu) / across);
            return 1.0f - kept * kept < kFillMixed * kFillMixed;
        });
    }

    // Mirrored along an axis or a diagonal, the value is frequent, too.
    [[nodiscard]] bool has_twins() const {
        constexpr double kLeastTwins = 0.05;
        const auto [x, y, z] = value_;
        std::vector<FillVector> twins;
        for (const FillVector& twin : {FillVector{-x, y, z}, FillVector{x, -y, z}, FillVector{-x, -y, z},
                                       FillVector{y, x, z}, FillVector{-y, -x, z}}) {
            if (!is_near(twin, value_, 2.0f * kTwinNear)) twins.push_back(twin);
        }
        std::int64_t count = 0;
        for (int j = 0; j < extent_.height && !twins.empty(); ++j) {
            for (int i = 0; i < extent_.width; ++i) {
                const FillVector v = at(i, j);
                const auto is_like = [&](const FillVector& twin) { return is_near(twin, v, kTwinNear); };
                count += std::any_of(twins.begin(), twins.end(), is_like) ? 1 : 0;
            }
        }
        return static_cast<double>(count) > kLeastTwins * static_cast<double>(background_.texels);
    }

    // It leans, points outwards, is no primary colour, and is nowhere as wide as seven texels.
    [[nodiscard]] bool is_a_strip() const {
        constexpr float kLean = 0.3f, kPrimary = 0.97f;
        constexpr int kHalfWidth = 3;
        constexpr double kMostWide = 0.02;
        const float lean = std::max(std::abs(value_.x), std::abs(value_.y));
        const float least = std::min({std::abs(value_.x), std::abs(value_.y), std::abs(value_.z)});
        if (!(value_.z > 0.0f && lean > kLean) || least > kPrimary) return false;
        const auto holds = [&](int i, int j) {
            return background_.holds(std::clamp(i, 0, extent_.width - 1), std::clamp(j, 0, extent_.height - 1));
        };
        std::int64_t wide = 0;
        for (int j = 0; j < extent_.height; ++j) {
            for (int i = 0; i < extent_.width; ++i) {
                if (!holds(i, j)) continue;
                wide += holds(i - kHalfWidth, j) && holds(i + kHalfWidth, j) && holds(i, j - kHalfWidth) &&
                                holds(i, j + kHalfWidth)
                            ? 1
                            : 0;
            }
        }
        return static_cast<double>(wide) < kMostWide * static_cast<double>(background_.masked);
    }

    static constexpr float kTwinNear = 8.0f / 127.5f;
    static bool is_near(const FillVector& a, const FillVector& b, float within) {
        return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)}) <= within;
    }

    const Stored& stored_;
    const Background& background_;
    const Extent extent_;
    const int x_, y_, z_;
    const FillVector value_;
    const bool is_grey_;  // black and white, too
};

double fill_turn(const FillVector& a, const FillVector& b) {
    const FillVector apart{a.x - b.x, a.y - b.y, a.z - b.z}, sum{a.x + b.x, a.y + b.y, a.z + b.z};
    const double half =
        math::atan(static_cast<double>(apart.length()) / std::max(1e-6, static_cast<double>(sum.length())));
    return 2.0 * half * 180.0 / math::kPi;
}

}  // namespace

bool FillHarm::is_any() const { return texels > 0 || may_be_a_normal; }

std::string FillHarm::text() const {
    if (may_be_a_normal)
        return "the colour may be that of bevels, too long or too short: texels that lean as far the other way are "
               "frequent, or it fills strips alone; filling would delete them";
    return "filling would turn " + std::to_string(texels) +
           " texels at the edge of charts that hold normals of their own, as bevels do, by up to " +
           decimal(degrees, 0) + " degrees; the first at " + texel_text(column, row);
}

Result<FillHarm> harm_of_filling(const Stored& stored, const Background& background, const Execution& execution) {
    const Filling filling(stored, background);
    const Extent extent = filling.extent();
    FillHarm harm;
    harm.may_be_a_normal = filling.may_be_a_normal();
    if (harm.may_be_a_normal || background.masked == extent.texels()) return harm;
    Plane<float> holes(extent);
    std::int64_t mixed = 0;
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            holes.at(i, j) = background.holds(i, j) ? std::numeric_limits<float>::quiet_NaN() : 0.0f;
            mixed += background.is_mixed(i, j) ? 1 : 0;
        }
    }
    if (mixed < kFillTexels) return harm;
    // Holes become the angles by which they turn, or -1 if they have a direction, but not their own.
    const auto fill = [&](const NearestTexel& hole) {
        float& degrees = holes.at(hole.i, hole.j);
        degrees = 0.0f;
        if (!background.is_mixed(hole.i, hole.j)) return;
        const FillVector v = filling.at(hole.i, hole.j);
        if (!filling.has_direction(v)) return;
        degrees = -1.0f;
        const double turn = fill_turn(v.unit(), filling.at(hole.column, hole.row).unit());
        if (turn >= kFillTurn && filling.is_own(hole.i, hole.j, v)) degrees = static_cast<float>(turn);
    };
    if (auto done = visit_holes(holes.view(), Wrap::clamp, Wrap::clamp, execution.quiet(), {}, fill); !done)
        return done.error();
    std::int64_t directed = 0;
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            directed += holes.at(i, j) != 0.0f ? 1 : 0;
            if (!(holes.at(i, j) > 0.0f)) continue;
            if (harm.texels++ == 0) harm.column = i, harm.row = j;
            harm.degrees = std::max(harm.degrees, static_cast<double>(holes.at(i, j)));
        }
    }
    if (harm.texels < std::max(kFillTexels, static_cast<std::int64_t>(kFillShare * static_cast<double>(directed))))
        harm.texels = 0;
    return harm;
}

}  // namespace tex::inline v1
