// SPDX-License-Identifier: Apache-2.0

#include "checks/mesh_seams.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <utility>

#include "checks/seam_evidence.h"
#include "checks/tangent_rules.h"
#include "mesh/vectors.h"
#include "mesh/weld.h"

namespace tex::inline v1 {
namespace {

constexpr std::size_t kMostEdges = 1 << 14;
constexpr int kMostPlaces = 8;               // on an edge
constexpr float kSameNormal = 0.9998f;       // the cosine of a degree
constexpr double kQuantum = 0.3 / kDegrees;  // a gap that rounding to 8 bits explains

// An edge of a triangle, keyed by the numbers of its ends.
struct Edge {
    std::uint32_t low = 0, high = 0;
    std::size_t triangle = 0;
    std::size_t first = 0;  // the corner at the end `low`
    std::size_t second = 0;
};

bool same_normals(const MeshPart& part, std::uint32_t a, std::uint32_t b) {
    const Float3 &n = part.normals[a], &m = part.normals[b];
    return dot(n, m) >= kSameNormal * length(n) * length(m);
}

std::vector<Edge> edges_of(const MeshPart& part) {
    const std::vector<std::uint32_t> number = numbered_positions(part);
    std::vector<Edge> edges;
    edges.reserve(part.indices.size());
    for (std::size_t t = 0; t < part.triangles(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = (k + 1) % 3;
            const std::uint32_t p = number[part.indices[3 * t + k]], q = number[part.indices[3 * t + next]];
            if (p < q) edges.push_back({p, q, t, k, next});
            if (q < p) edges.push_back({q, p, t, next, k});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
        return std::tuple(a.low, a.high, a.triangle) < std::tuple(b.low, b.high, b.triangle);
    });
    return edges;
}

}  // namespace

std::vector<SeamEdge> find_seams(const MeshPart& part) {
    const std::vector<Edge> edges = edges_of(part);
    std::vector<SeamEdge> seams;
    for (std::size_t k = 0; k < edges.size();) {
        std::size_t end = k + 1;
        while (end < edges.size() && edges[end].low == edges[k].low && edges[end].high == edges[k].high) ++end;
        const Edge &a = edges[k], &b = edges[end - 1];
        const bool pair = end - k == 2;
        k = end;
        if (!pair) continue;
        const auto vertex = [&](const Edge& e, std::size_t corner) { return part.indices[3 * e.triangle + corner]; };
        const std::uint32_t ends[4] = {vertex(a, a.first), vertex(b, b.first), vertex(a, a.second),
                                       vertex(b, b.second)};
        const auto& uvs = part.uvs.front();
        if (same(uvs[ends[0]], uvs[ends[1]]) && same(uvs[ends[2]], uvs[ends[3]])) continue;
        if (!same_normals(part, ends[0], ends[1]) || !same_normals(part, ends[2], ends[3])) continue;
        const Float3 way = part.positions[ends[2]] - part.positions[ends[0]];
        seams.push_back(
            {{a.triangle, {a.first, a.second}}, {b.triangle, {b.first, b.second}}, static_cast<double>(length(way))});
    }
    std::sort(seams.begin(), seams.end(), [](const SeamEdge& x, const SeamEdge& y) {
        return std::tuple(x.a.triangle, x.a.corner) < std::tuple(y.a.triangle, y.a.corner);
    });
    if (seams.size() <= kMostEdges) return seams;
    std::vector<SeamEdge> spread;
    for (std::size_t k = 0; k < kMostEdges; ++k) spread.push_back(seams[k * seams.size() / kMostEdges]);
    return spread;
}

namespace {

// A bilinear filter that repeats, on vectors as stored, as engines filter them: decoders make them unit vectors.
class Texels {
public:
    Texels(const Stored& stored, double scale)
        : stored_(stored), scale_(scale), x_(stored.channel(Component::x)), y_(stored.channel(Component::y)),
          z_(stored.channel(Component::z)) {}

    // x and y in texels from the upper left corner of the map.
    [[nodiscard]] Vector3 at(double x, double y) const {
        const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
        const double s = x - 0.5 - left, t = y - 0.5 - top;
        const auto i = static_cast<std::int64_t>(left), j = static_cast<std::int64_t>(top);
        return (1.0 - t) * ((1.0 - s) * texel(i, j) + s * texel(i + 1, j)) +
               t * ((1.0 - s) * texel(i, j + 1) + s * texel(i + 1, j + 1));
    }

private:
    [[nodiscard]] Vector3 texel(std::int64_t i, std::int64_t j) const {
        const auto wrapped = [](std::int64_t k, int n) { return static_cast<int>(((k % n) + n) % n); };
        const int column = wrapped(i, stored_.extent().width), row = wrapped(j, stored_.extent().height);
        const auto component = [&](int channel) {
            return static_cast<double>(stored_.component(channel, column, row));
        };
        Vector3 n{component(x_), component(y_), 0.0};
        n.z = z_ >= 0 ? component(z_) : std::sqrt(std::max(0.0, 1.0 - n.x * n.x - n.y * n.y));
        n.x *= scale_;
        n.y *= scale_;
        return std::isfinite(dot(n, n)) ? n : Vector3{0.0, 0.0, 1.0};
    }

    const Stored& stored_;
    double scale_;
    int x_, y_, z_;
};

// The mean angle between the vector at a sample and those one texel away, in degrees.
double change_at(const TexelAt& texel_at, double x, double y, Vector3 here) {
    constexpr std::pair<double, double> kAround[] = {{1.0, 0.0}, {-1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}};
    const auto unit = [](Vector3 v) {
        const double size = std::sqrt(dot(v, v));
        return size > 0.0 ? 1.0 / size * v : Vector3{0.0, 0.0, 1.0};
    };
    double sum = 0.0;
    for (const auto& [right, down] : kAround) sum += seam_degrees(unit(here) - unit(texel_at(x + right, y + down)));
    return sum / 4.0;
}

std::array<double, 3> weights_at(const SeamSide& side, double way) {
    std::array<double, 3> weights{};
    weights[side.corner[0]] = 1.0 - way;
    weights[side.corner[1]] = way;
    return weights;
}

}  // namespace

SeamSamples::SeamSamples(const MeshPart& part, const std::vector<SeamEdge>& edges, const Stored& stored, double scale)
    : SeamSamples(part, edges, stored.extent(),
                  [texels = Texels(stored, scale)](double x, double y) { return texels.at(x, y); }) {}

SeamSamples::SeamSamples(const MeshPart& part, const std::vector<SeamEdge>& edges, Extent extent,
                         const TexelAt& texel_at)
    : part_(part), edges_(edges) {
    // The sample in the map, in texels.
    const auto corner = [&](const SeamSide& side, std::size_t end) -> std::array<double, 2> {
        const Float2 uv = part.uvs.front()[part.indices[3 * side.triangle + side.corner[end]]];
        const auto v = static_cast<double>(uv.y);
        return {static_cast<double>(uv.x) * extent.width, (part.v_axis == YAxis::up ? 1.0 - v : v) * extent.height};
    };
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const SeamSide* const sides[] = {&edges[e].a, &edges[e].b};
        double size = 0.0;
        for (const SeamSide* side : sides) {
            const auto p = corner(*side, 0), q = corner(*side, 1);
            const double across = q[0] - p[0], down = q[1] - p[1];
            size = std::max(size, std::sqrt(across * across + down * down));
        }
        const int count = static_cast<int>(std::clamp(size / 2.0, 1.0, static_cast<double>(kMostPlaces)));
        for (int k = 0; k < count; ++k) {
            const double way = (k + 0.5) / count;
            Sample sample;
            sample.edge = e;
            sample.weight = edges[e].length / count;
            for (std::size_t s = 0; s < 2; ++s) {
                const auto p = corner(*sides[s], 0), q = corner(*sides[s], 1);
                sample.weights[s] = weights_at(*sides[s], way);
                const std::array<double, 2> at = {p[0] + way * (q[0] - p[0]), p[1] + way * (q[1] - p[1])};
                sample.texel[s] = texel_at(at[0], at[1]);
                sample.change += change_at(texel_at, at[0], at[1], sample.texel[s]) / 2.0;
                if (s == 0) sample.at = at;
            }
            samples_.push_back(sample);
        }
    }
}

std::vector<Vector3> SeamSamples::gaps(const SeamSpace& space) const {
    std::vector<Vector3> gaps;
    gaps.reserve(samples_.size());
    const TangentSpace tangent_space{part_, *space.tangents, 0, space.decoder};
    std::size_t edge = std::numeric_limits<std::size_t>::max();  // whose frames these are
    CornerFrames frames[2];
    for (const Sample& sample : samples_) {
        if (sample.edge != edge) {
            edge = sample.edge;
            frames[0] = CornerFrames(tangent_space, edges_[edge].a.triangle);
            frames[1] = CornerFrames(tangent_space, edges_[edge].b.triangle);
        }
        Vector3 normal[2];
        for (std::size_t s = 0; s < 2; ++s) {
            Vector3 t = read_texel(space.decoder, sample.texel[s]);
            if (!space.y_up) t.y = -t.y;
            normal[s] = decode(frames[s].at(sample.weights[s]), t);
        }
        gaps.push_back(normal[0] - normal[1]);
    }
    return gaps;
}

SeamVerdict compare_gaps(const SeamSamples& samples, const std::vector<Vector3>& a, const std::vector<Vector3>& b) {
    const auto& places = samples.samples();
    const auto weight = [&](std::size_t k) {  // large gaps on both sides are noise
        return places[k].weight / (kQuantum * kQuantum + std::min(dot(a[k], a[k]), dot(b[k], b[k])));
    };
    double along = 0.0, square = 0.0, plain = 0.0, all = 0.0;
    for (std::size_t k = 0; k < places.size(); ++k) {
        const Vector3 change = a[k] - b[k];
        along += weight(k) * dot(a[k], change);
        square += weight(k) * dot(change, change);
        plain += places[k].weight * dot(change, change);
        all += places[k].weight;
    }
    SeamVerdict verdict;
    if (!(square > 0.0) || !(all > 0.0)) return verdict;
    verdict.slope = along / square;
    verdict.saved = kDegrees * std::sqrt(plain / all);
    // The places of an edge are not independent, so each edge counts once.
    double variance = 0.0, of_edge = 0.0;
    for (std::size_t k = 0; k < places.size(); ++k) {
        const Vector3 change = a[k] - b[k];
        of_edge += weight(k) * dot(change, a[k] - verdict.slope * change);
        if (k + 1 < places.size() && places[k + 1].edge == places[k].edge) continue;
        variance += of_edge * of_edge;
        of_edge = 0.0;
    }
    const double deviation = std::sqrt(variance) / square;
    const double z = deviation > 0.0 ? (verdict.slope - 0.5) / deviation : (verdict.slope - 0.5) * 1e9;
    verdict.confidence = 0.5 * std::erfc(-z / std::sqrt(2.0));
    return verdict;
}

}  // namespace tex::inline v1
