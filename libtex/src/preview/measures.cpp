// SPDX-License-Identifier: Apache-2.0

#include "preview/measures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "checks/curl.h"
#include "preview/vector.h"
#include "rows/curvature_rows.h"
#include "threads/parallel.h"

namespace tex::inline v1::render {
namespace {

Vec3 normal_at(const NormalMap& map, int i, int j) {
    return {static_cast<double>(map.x.at(i, j)), static_cast<double>(map.y.at(i, j)),
            static_cast<double>(map.z.at(i, j))};
}

// p and q of preview.h.
Vec2 slopes_at(const NormalMap& map, int i, int j) {
    const Vec3 n = normal_at(map, i, j);
    const double z = std::max(n.z, 1.0 / 256.0);
    return {-n.x / z, -n.y / z};
}

double slope_at(const NormalMap& map, int i, int j) { return length(slopes_at(map, i, j)); }
double tilt_at(const NormalMap& map, int i, int j) {
    const Vec3 n = normal_at(map, i, j);
    return degrees(angle_of(length(Vec2{n.x, n.y}), n.z));
}
double length_error_at(const NormalMap& map, int i, int j) { return length(normal_at(map, i, j)) - 1.0; }
double z_error_at(const NormalMap& map, int i, int j) {
    const Vec3 n = normal_at(map, i, j);
    return n.z - std::sqrt(1.0 - std::min(n.x * n.x + n.y * n.y, 1.0));
}

Result<Plane<float>> fill(Extent extent, const Execution& execution, const std::function<double(int i, int j)>& value) {
    Plane<float> plane(extent);
    const auto done = parallel_for(execution, extent.height, kRowsPerPiece, [&](int begin, int end) {
        for (int j = begin; j < end; ++j) {
            for (int i = 0; i < extent.width; ++i) plane.at(i, j) = static_cast<float>(value(i, j));
        }
    });
    if (!done) return done.error();
    return plane;
}

// The map as check-normals sees it.
struct CurlView {
    Image image;
    Curl curl;
    Slopes slopes;
};
CurlView curl_view(const NormalMap& map) {
    CurlView view;
    for (const Plane<float>* plane : {&map.x, &map.y, &map.z}) view.image.planes.push_back(plane->clone());
    view.image.names = {"R", "G", "B"};
    view.image.sample = SampleKind::floating;
    const Stored stored{&view.image, kSwizzleXyz, true};
    view.curl = measure_curl(stored);
    view.slopes = slopes_of(stored, {0, 0, map.extent().width, map.extent().height});
    return view;
}

// The two derivatives that are equal in a height field, by central differences, one-sided at the border; y points
// upwards. NaN next to texels that have no normal.
struct Mixed {
    double dq_dx, dp_dy;
};
Mixed mixed_at(const Slopes& slopes, int i, int j) {
    const Extent extent = slopes.extent();
    const int left = std::max(i - 1, 0), right = std::min(i + 1, extent.width - 1);
    const int above = std::max(j - 1, 0), below = std::min(j + 1, extent.height - 1);
    const float across = static_cast<float>(std::max(right - left, 1)),
                up = static_cast<float>(std::max(below - above, 1));
    return {static_cast<double>((slopes.q.at(right, j) - slopes.q.at(left, j)) / across),
            static_cast<double>((slopes.p.at(i, above) - slopes.p.at(i, below)) / up)};
}

std::string curl_title(const Curl& curl) {
    const std::string figure = ", r=" + number(curl.correlation);
    constexpr double kSure = 0.95;
    if (curl.confidence < kSure) return "curl: y unclear" + figure;
    return (curl.correlation > 0.0 ? "curl: y up as read" : "curl: y DOWN as read") + figure;
}

Result<Measure> measure_curl_of(const NormalMap& map, float maximum, const Execution& execution) {
    const CurlView view = curl_view(map);
    auto values = fill(map.extent(), part_of(execution, 0.0, 0.5), [&](int i, int j) {
        const Mixed mixed = mixed_at(view.slopes, i, j);
        const double curl = mixed.dq_dx - mixed.dp_dy;
        return curl == curl ? curl : 0.0;
    });
    if (!values) return values.error();
    // The scale follows the largest curl that these derivatives could have, not the actual curl, so that a sound map is
    // white.
    const auto most = fill(map.extent(), part_of(execution, 0.5, 1.0), [&](int i, int j) {
        const Mixed mixed = mixed_at(view.slopes, i, j);
        return std::abs(mixed.dq_dx) + std::abs(mixed.dp_dy);
    });
    if (!most) return most.error();
    Measure result;
    result.values = std::move(*values);
    const double greatest = maximum > 0.0f ? static_cast<double>(maximum) : round_maximum(*most, 0.01);
    result.scale = {curl_title(view.curl), -greatest, greatest, Palette::diverging};
    return result;
}

double nice(double value) {
    double power = 1e-6;
    while (power * 10.0 <= value && power < 1e15) power *= 10.0;
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (power * factor >= value) return power * factor;
    }
    return power * 10.0;
}

// The value in |values| below which this many thousandths of them lie; 0 if none is finite.
double quantile(const Plane<float>& values, std::size_t thousandths) {
    std::vector<float> sizes;
    sizes.reserve(static_cast<std::size_t>(values.extent().texels()));
    for (int j = 0; j < values.extent().height; ++j) {
        for (int i = 0; i < values.extent().width; ++i) {
            const float size = std::abs(values.at(i, j));
            if (size <= 3e38f) sizes.push_back(size);  // false for infinity and NaN
        }
    }
    if (sizes.empty()) return 0.0;
    const std::size_t rank = std::min(sizes.size() - 1, sizes.size() * thousandths / 1000);
    const auto place = sizes.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(sizes.begin(), place, sizes.end());
    return static_cast<double>(*place);
}

Result<Measure> measure_curvature(const PreviewOptions& options, const NormalMap& map, const Execution& execution) {
    Measure result;
    result.values = Plane<float>(map.extent());
    const auto done = parallel_for(execution, map.extent().height, kRowsPerPiece, [&](int begin, int end) {
        CurvatureRows rows(map, false, options.wrap_x, options.wrap_y);
        for (int j = begin; j < end; ++j) rows.make(j, result.values.row(j));
    });
    if (!done) return done.error();
    const auto maximum = static_cast<double>(options.maximum);
    // A few edges bend far more than all the rest, which they would leave white.
    const double greatest = maximum > 0.0 ? maximum : nice(std::max(quantile(result.values, 970), 1e-4));
    result.scale = {"curvature, 1/texel", -greatest, greatest, Palette::diverging};
    return result;
}

}  // namespace

double round_maximum(const Plane<float>& values, double least) { return nice(std::max(quantile(values, 995), least)); }

double round_angle(double degrees) {
    constexpr double kAngles[] = {0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 20.0, 30.0, 45.0, 60.0, 90.0, 180.0};
    return *std::lower_bound(std::begin(kAngles), std::end(kAngles) - 1, degrees);
}

namespace {

// A measure of each texel by itself.
struct TexelMeasure {
    Show show;
    const char* title;
    Palette palette;
    double (*value)(const NormalMap& map, int i, int j);
    double (*greatest)(const Plane<float>& values);  // of the scale, if nobody chose it
};

double hundredths(const Plane<float>& values) { return round_maximum(values, 0.01); }
double angle(const Plane<float>& values) { return round_angle(quantile(values, 999)); }

constexpr TexelMeasure kTexelMeasures[] = {
    {Show::slope, "slope, rise per texel", Palette::viridis, slope_at, hundredths},
    {Show::tilt, "tilt, degrees", Palette::viridis, tilt_at, angle},
    {Show::length, "length - 1", Palette::diverging, length_error_at, hundredths},
    {Show::z_error, "z - z(x, y)", Palette::diverging, z_error_at, hundredths},
};

Result<Measure> measure_texels(const TexelMeasure& how, const NormalMap& map, float maximum,
                               const Execution& execution) {
    auto values = fill(map.extent(), execution, [&](int i, int j) { return how.value(map, i, j); });
    if (!values) return values.error();
    Measure result;
    result.values = std::move(*values);
    const double greatest = maximum > 0.0f ? static_cast<double>(maximum) : how.greatest(result.values);
    result.scale = {how.title, how.palette == Palette::diverging ? -greatest : 0.0, greatest, how.palette};
    return result;
}

}  // namespace

Result<Measure> measure(const PreviewOptions& options, const NormalMap& map, const Execution& execution) {
    if (options.show == Show::curl) return measure_curl_of(map, options.maximum, execution);
    if (options.show == Show::curvature) return measure_curvature(options, map, execution);
    const auto* const how = std::find_if(std::begin(kTexelMeasures), std::end(kTexelMeasures),
                                         [&](const TexelMeasure& row) { return row.show == options.show; });
    return measure_texels(*how, map, options.maximum, execution);
}

}  // namespace tex::inline v1::render
