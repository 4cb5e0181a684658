// SPDX-License-Identifier: Apache-2.0

#include "mesh/meshopt.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include <tex/mesh.h>

#include "mesh/disjoint_sets.h"
#include "mesh/vectors.h"
#include "mesh/weld.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

constexpr int kTrianglesPerPiece = 1 << 13;  // triangles that a thread takes at a time

// Signs of the UVs' area, as a set: a group of triangles without area takes the sign of the first other one.
constexpr std::uint8_t kPositive = 1, kNegative = 2, kBoth = 3;

struct Direction {
    Float3 s;  // unit, or 0
    std::uint8_t sign = 0;
};

Direction direction_of(const Float3 (&p)[3], const Float2 (&uv)[3]) {
    const Float3 d1 = p[1] - p[0], d2 = p[2] - p[0];
    const float u1 = uv[1].x - uv[0].x, v1 = uv[1].y - uv[0].y;
    const float u2 = uv[2].x - uv[0].x, v2 = uv[2].y - uv[0].y;
    const Float3 s = v2 * d1 - v1 * d2;
    const float area = u1 * v2 - v1 * u2;
    if (area == 0.0f || same(p[0], p[1]) || same(p[0], p[2]) || same(p[1], p[2])) return {};
    const float sign = area > 0.0f ? 1.0f : -1.0f;
    const float size = length(s);
    return {(size != 0.0f ? sign / size : 0.0f) * s, area > 0.0f ? kPositive : kNegative};
}

// acos(x) within 5e-4 (Hastings, Approximations for Digital Computers, 1955, with two terms). The weights of
// meshoptimizer contain this error, so it belongs to the method.
float rough_angle(float x) {
    const float a = std::min(std::abs(x), 1.0f);
    const float r = (1.570337f + a * (-0.2053972f + a * 0.05147786f)) * std::sqrt(1.0f - a);
    return x < 0.0f ? 3.1415926f - r : r;
}

// 1 / x, or 0 for 0.
float inverse(float x) { return x == 0.0f ? 0.0f : 1.0f / x; }

class Meshopt {
public:
    Meshopt(const MeshPart& part, int uv_set)
        : part_(part), uvs_(part.uvs[static_cast<std::size_t>(uv_set)]), uv_set_(uv_set), groups_(part.indices.size()),
          triangle_groups_(part.triangles()) {}

    Result<std::vector<Float4>> run(const Execution& execution);

private:
    static std::uint32_t next(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
    static std::uint32_t previous(std::uint32_t corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }
    [[nodiscard]] Float3 position(std::uint32_t corner) const { return part_.positions[part_.indices[corner]]; }

    Result<void> find_directions(const Execution& execution);
    Result<void> join_groups();
    void join_around(std::span<const std::uint32_t> corners);
    bool join_signs(std::uint32_t a, std::uint32_t b);
    [[nodiscard]] Float3 term(std::uint32_t corner) const;
    std::vector<Float4> sum_up();

    const MeshPart& part_;
    const std::vector<Float2>& uvs_;
    const int uv_set_;
    std::vector<std::uint32_t> welded_;
    std::vector<Direction> directions_;
    std::vector<std::uint8_t> signs_;  // of the groups of triangles, at their roots
    DisjointSets groups_;              // of corners
    DisjointSets triangle_groups_;     // of triangles that share a sign
};

Result<void> Meshopt::find_directions(const Execution& execution) {
    directions_.resize(part_.triangles());
    return parallel_for(execution, static_cast<int>(part_.triangles()), kTrianglesPerPiece, [&](int begin, int end) {
        for (auto f = static_cast<std::size_t>(begin); f < static_cast<std::size_t>(end); ++f) {
            const std::uint32_t* v = &part_.indices[3 * f];
            directions_[f] = direction_of({part_.positions[v[0]], part_.positions[v[1]], part_.positions[v[2]]},
                                          {uvs_[v[0]], uvs_[v[1]], uvs_[v[2]]});
        }
    });
}

// Whether corners of two triangles may share a tangent. If a triangle has no sign, this decides which sign it takes.
bool Meshopt::join_signs(std::uint32_t a, std::uint32_t b) {
    if ((signs_[a] | signs_[b]) == kBoth) return false;
    if ((signs_[a] & signs_[b]) != 0) return true;
    const std::uint32_t root_a = triangle_groups_.root(a), root_b = triangle_groups_.root(b);
    if (root_a == root_b) return true;
    if ((signs_[root_a] | signs_[root_b]) == kBoth) return false;
    triangle_groups_.attach(root_b, root_a);
    signs_[root_a] = static_cast<std::uint8_t>(signs_[root_a] | signs_[root_b]);
    return true;
}

// Joins the corners of one vertex whose triangles share an edge there.
void Meshopt::join_around(std::span<const std::uint32_t> corners) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const std::uint32_t next_i = welded_[next(corners[i])], previous_i = welded_[previous(corners[i])];
        for (std::size_t j = i + 1; j < corners.size(); ++j) {
            if (welded_[next(corners[j])] != previous_i && welded_[previous(corners[j])] != next_i) continue;
            if (!join_signs(corners[i] / 3, corners[j] / 3)) continue;
            const std::uint32_t a = groups_.root(corners[i]), b = groups_.root(corners[j]);
            if (a != b) groups_.attach(b, a);
        }
    }
}

Result<void> Meshopt::join_groups() {
    const std::size_t count = welded_.size();
    std::vector<std::uint32_t> ends(count + 1, 0), corners(count);
    for (const std::uint32_t vertex : welded_) ++ends[vertex + 1];
    for (std::size_t v = 0; v < count; ++v) {
        if (ends[v + 1] > kMaxFan) {
            return Error{ErrorCode::unsupported,
                         {},
                         std::to_string(ends[v + 1]) + " triangles meet at one vertex: at most " +
                             std::to_string(kMaxFan) + " are supported"};
        }
        ends[v + 1] += ends[v];
    }
    for (std::size_t c = 0; c < count; ++c) corners[ends[welded_[c]]++] = static_cast<std::uint32_t>(c);
    // Now ends[v] is the end of vertex v.
    for (std::size_t v = 0; v < count; ++v) {
        const std::uint32_t begin = v == 0 ? 0 : ends[v - 1];
        if (ends[v] - begin > 1) join_around({corners.data() + begin, ends[v] - begin});
    }
    return {};
}

// What a corner adds to its group: its triangle's direction in the plane of the normal, weighted.
Float3 Meshopt::term(std::uint32_t corner) const {
    const Float3 n = part_.normals[part_.indices[corner]], p = position(corner);
    const Float3 direction = directions_[corner / 3].s;
    const Float3 s = direction - dot(direction, n) * n;
    Float3 e1 = position(next(corner)) - p, e2 = position(previous(corner)) - p;
    e1 = e1 - dot(e1, n) * n;
    e2 = e2 - dot(e2, n) * n;
    const float sizes = std::sqrt(dot(e1, e1) * dot(e2, e2));
    const float angle = rough_angle(dot(e1, e2) * inverse(sizes));
    return (angle * inverse(length(s)) * sizes) * s;
}

std::vector<Float4> Meshopt::sum_up() {
    std::vector<Float4> tangents(part_.indices.size(), {0.0f, 0.0f, 0.0f, 0.0f});
    for (std::uint32_t c = 0; c < tangents.size(); ++c) {
        if (directions_[c / 3].sign == 0) continue;
        const Float3 t = term(c);
        Float4& sum = tangents[groups_.root(c)];
        sum.x += t.x;
        sum.y += t.y;
        sum.z += t.z;
    }
    // The root of a set may come after its members, so roots are finished first.
    for (std::uint32_t c = 0; c < tangents.size(); ++c) {
        if (groups_.root(c) != c) continue;
        Float4& sum = tangents[c];
        const Float3 t{sum.x, sum.y, sum.z};
        const float size = length(t);
        const Float3 unit = inverse(size) * t;
        sum = {size == 0.0f || !is_finite(unit) ? 1.0f : unit.x, unit.y, unit.z, 0.0f};
        if (!is_finite(sum)) sum = {1.0f, 0.0f, 0.0f, 0.0f};
    }
    for (std::uint32_t c = 0; c < tangents.size(); ++c) {
        tangents[c] = tangents[groups_.root(c)];
        tangents[c].w = signs_[triangle_groups_.root(c / 3)] & kPositive ? 1.0f : -1.0f;
    }
    return tangents;
}

Result<std::vector<Float4>> Meshopt::run(const Execution& execution) {
    const Execution welding = part_of(execution, 0.0, 0.5), rest = part_of(execution, 0.5, 1.0);
    auto welded = weld_to_first(part_, uv_set_, welding);
    if (!welded) return welded.error();
    welded_ = std::move(*welded);
    if (const auto found = find_directions(rest); !found) return found.error();
    for (const Direction& d : directions_) signs_.push_back(d.sign);
    if (const auto joined = join_groups(); !joined) return joined.error();
    return sum_up();
}

}  // namespace

Result<std::vector<Float4>> meshopt_tangents(const MeshPart& part, int uv_set, const Execution& execution) {
    return Meshopt(part, uv_set).run(execution);
}

}  // namespace tex::inline v1
