// SPDX-License-Identifier: Apache-2.0

#include "stream/map_inspector.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "checks/curl.h"

namespace tex::inline v1 {
namespace {

constexpr int kGlanceWindow = 128;
constexpr int kLeastSide = 32;  // smaller maps show nothing
// In larger maps, a quarter of the texels shows what share is background or faces away, at a cost that nobody notices.
constexpr std::int64_t kMostCounted = std::int64_t{1} << 16;
constexpr int kCountedStep = 4;
constexpr float kBehindSurface = -0.1f;
constexpr double kMostBehindSurface = 0.05;                // share of texels: more is object space
constexpr double kLeastShown = 0.01;                       // share of texels: less background is not worth a warning
constexpr float kLeastSquare = 0.25f, kMostSquare = 4.0f;  // of the length of a usable normal, as slopes_of() has it

// Whether a vector is black, grey or white as unpack() reads them: all components equal, normalised (128 is not 0: grey
// becomes (0.58, 0.58, 0.58)); without a stored z,
// z is rebuilt, and x and y are shortened to the unit circle.
bool is_shade(float x, float y, float z) {
    constexpr float kSame = 0.02f, kLeast = 0.5f;
    constexpr float kNoDirection = 0.1f;  // of grey, if lengths are kept
    const float size = std::abs(x);
    if (std::max(size, std::max(std::abs(y), std::abs(z))) < kNoDirection) return true;
    return size > kLeast && std::abs(x - y) < kSame && (std::abs(std::abs(z) - size) < kSame || std::abs(z) < kSame);
}

}  // namespace

MapInspector::MapInspector(Extent extent, bool measures_y, Look look) : extent_(extent), measures_y_(measures_y) {
    if (std::min(extent.width, extent.height) < kLeastSide) return;
    windows_ = look == Look::as_check ? sample_windows(extent) : sample_windows(extent, kGlanceWindow);
    if (!measures_y) return;
    for (const Rect& window : windows_) {
        const Extent size{window.width, window.height};
        slopes_.push_back({Plane<float>(size), Plane<float>(size)});
    }
}

bool MapInspector::wants(int j) const {
    return std::any_of(windows_.begin(), windows_.end(),
                       [j](const Rect& window) { return j >= window.y && j < window.y + window.height; });
}

void MapInspector::add_row(int j, const VectorRow& row) {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t k = 0; k < windows_.size(); ++k) {
        const Rect& window = windows_[k];
        if (j < window.y || j >= window.y + window.height) continue;
        const float *const x = row.x + window.x, *const y = row.y + window.x, *const z = row.z + window.x;
        const int step = extent_.texels() > kMostCounted ? kCountedStep : 1;
        for (int i = j % step; i < window.width; i += step) {
            ++texels_;
            const bool is_background = is_shade(x[i], y[i], z[i]);
            background_ += is_background ? 1 : 0;
            behind_ += !is_background && z[i] < kBehindSurface ? 1 : 0;
        }
        if (!measures_y_) continue;
        float* const p = slopes_[k].p.row(j - window.y);
        float* const q = slopes_[k].q.row(j - window.y);
        for (int i = 0; i < window.width; ++i) {
            const float square = x[i] * x[i] + y[i] * y[i] + z[i] * z[i];
            const bool usable = z[i] >= kLeastZ && square >= kLeastSquare && square <= kMostSquare;
            p[i] = usable ? -x[i] / z[i] : kNone;
            q[i] = usable ? -y[i] / z[i] : kNone;
        }
    }
}

Slopes MapInspector::slopes_at(const Rect& part) const {
    const int x = part.x + part.width / 2, y = part.y + part.height / 2;
    for (std::size_t k = 0; k < windows_.size(); ++k) {
        const Rect& window = windows_[k];
        if (x < window.x || x >= window.x + window.width || y < window.y || y >= window.y + window.height) continue;
        const int left = std::max(part.x, window.x), right = std::min(part.x + part.width, window.x + window.width);
        const int top = std::max(part.y, window.y), bottom = std::min(part.y + part.height, window.y + window.height);
        Slopes cut{Plane<float>({right - left, bottom - top}), Plane<float>({right - left, bottom - top})};
        for (int j = top; j < bottom; ++j) {
            std::copy_n(slopes_[k].p.row(j - window.y) + (left - window.x), right - left, cut.p.row(j - top));
            std::copy_n(slopes_[k].q.row(j - window.y) + (left - window.x), right - left, cut.q.row(j - top));
        }
        return cut;
    }
    return {};
}

YVerdict MapInspector::y() {
    if (windows_.empty()) return {};
    for (Slopes& slopes : slopes_) widen_holes(slopes);
    Curl curl = measure_curl(extent_, windows_, [&](std::size_t k) {
        const Slopes& of = slopes_[k];
        return Slopes{of.p.clone(), of.q.clone()};
    });
    // Background ought not to hold normals.
    const auto others = static_cast<double>(std::max<std::int64_t>(1, texels_ - background_));
    curl.usable = std::min(1.0, curl.usable * static_cast<double>(texels_) / others);
    return verdict_of(curl, extent_, [this](const Rect& part) { return slopes_at(part); });
}

void MapInspector::report(SourceInfo& info) {
    if (texels_ == 0) return;
    const double background = static_cast<double>(background_) / static_cast<double>(texels_);
    const auto others = static_cast<double>(texels_ - background_);
    info.background = background >= kLeastShown ? background : 0.0;
    info.object_space = static_cast<double>(behind_) > kMostBehindSurface * others;
    info.y_doubtful = measures_y_ && !info.object_space && y().y == YAxis::down;
}

Result<YAxis> measured_y(const YVerdict& verdict, const SourceOptions& options) {
    if (verdict.y) return *verdict.y;
    if (verdict.mixed) {
        return Error{ErrorCode::bad_data,
                     {},
                     "green points up in one part of the map and down in another: " + verdict.mixed->text() +
                         "; no direction is right for all of it, so mend the map first, or say up or down instead of "
                         "measured"};
    }
    if (options.y_otherwise) return *options.y_otherwise;
    return Error{ErrorCode::bad_data,
                 {},
                 "which way green points does not show clearly in the texels; say up or down instead of measured, or "
                 "\"measured, else up\""};
}

Result<YAxis> measured_y(const NormalMap& map, const SourceOptions& options) {
    MapInspector inspector(map.extent(), true, Look::as_check);
    for (int j = 0; j < map.extent().height; ++j) inspector.add_row(j, {map.x.row(j), map.y.row(j), map.z.row(j)});
    return measured_y(inspector.y(), options);
}

std::optional<MapInspector> inspector_for(const SourceOptions& options, const SourceInfo& info, Extent extent) {
    const bool doubts_y = options.doubt_y && (!info.y_known || options.unpack.y_axis);
    if (!options.inspect && !doubts_y) return std::nullopt;
    return std::optional<MapInspector>(std::in_place, extent, doubts_y, doubts_y ? Look::as_check : Look::glance);
}

void inspect(const NormalMap& map, const SourceOptions& options, SourceInfo& info) {
    std::optional<MapInspector> inspector = inspector_for(options, info, map.extent());
    if (!inspector) return;
    for (int j = 0; j < map.extent().height; ++j) inspector->add_row(j, {map.x.row(j), map.y.row(j), map.z.row(j)});
    inspector->report(info);
}

}  // namespace tex::inline v1
