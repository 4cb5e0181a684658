// SPDX-License-Identifier: Apache-2.0

#include "mesh/mikktspace.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <utility>

#include <tex/mesh.h>

#include "mesh/neighbours.h"
#include "mesh/vectors.h"
#include "mesh/weld.h"
#include "rows/math.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

constexpr int kGrain = 1 << 13;                           // triangles or groups that a thread takes at a time
constexpr std::size_t kMostTerms = std::size_t{1} << 20;  // that are added for one divided group
constexpr std::uint32_t kNoGroup = ~std::uint32_t{0};

bool not_zero(float x) { return std::abs(x) > std::numeric_limits<float>::min(); }
Float3 normalized(Float3 v) { return not_zero(v.x) || not_zero(v.y) || not_zero(v.z) ? (1.0f / length(v)) * v : v; }
// The part of v in the plane of the normal n.
Float3 in_plane(Float3 n, Float3 v) { return v - dot(n, v) * n; }

// acos(x) = 2 atan(sqrt((1 - x) / (1 + x))): in double, so that the float is the nearest one nearly always.
float angle(float cosine) {
    const double x = static_cast<double>(std::min(std::max(cosine, -1.0f), 1.0f));
    return x <= -1.0 ? static_cast<float>(math::kPi)
                     : static_cast<float>(2.0 * math::atan(std::sqrt((1.0 - x) / (1.0 + x))));
}

struct Directions {
    Float3 s, t;             // unit vectors in which u and v grow, or 0
    bool preserves = false;  // u and v turn counter-clockwise
    bool joins_any = true;   // without area in UV space: belongs to any group
};

// A triangle's directions (Mikkelsen 2008, equations 18 and 19, with the reference's thresholds).
Directions directions_of(const Float3 (&p)[3], const Float2 (&uv)[3]) {
    const float t21x = uv[1].x - uv[0].x, t21y = uv[1].y - uv[0].y;
    const float t31x = uv[2].x - uv[0].x, t31y = uv[2].y - uv[0].y;
    const Float3 d1 = p[1] - p[0], d2 = p[2] - p[0];
    const float area = t21x * t31y - t21y * t31x;
    Directions result;
    result.preserves = area > 0.0f;
    if (!not_zero(area)) return result;
    const Float3 s = t31y * d1 - t21y * d2;
    const Float3 t = (-t31x) * d1 + t21x * d2;
    const float length_s = length(s), length_t = length(t);
    const float sign = result.preserves ? 1.0f : -1.0f;
    if (not_zero(length_s)) result.s = (sign / length_s) * s;
    if (not_zero(length_t)) result.t = (sign / length_t) * t;
    result.joins_any = !(not_zero(length_s / std::abs(area)) && not_zero(length_t / std::abs(area)));
    return result;
}

class Mikktspace {
public:
    Mikktspace(const MeshPart& part, int uv_set)
        : part_(part), uvs_(part.uvs[static_cast<std::size_t>(uv_set)]), uv_set_(uv_set) {}

    Result<std::vector<Float4>> run(const Execution& execution);

private:
    // Triangles are numbered without the degenerate ones; faces_ has their places in the mesh. A corner is 3 triangle
    // + k. It is named by its representative in corners_, which is a corner of the mesh.
    [[nodiscard]] Float3 position(std::uint32_t corner) const { return part_.positions[part_.indices[corner]]; }
    [[nodiscard]] Float3 normal(std::uint32_t corner) const { return part_.normals[part_.indices[corner]]; }
    [[nodiscard]] Float2 uv(std::uint32_t corner) const { return uvs_[part_.indices[corner]]; }

    void sort_out();
    Result<void> find_directions(const Execution& execution);
    void find_groups();
    void fill_group(std::uint32_t seed, std::vector<std::uint32_t>& waiting);
    Result<void> make_group_tangents(const Execution& execution);
    void make_tangents_of(std::uint32_t group);
    [[nodiscard]] bool points_one_way(std::span<const std::uint32_t> members) const;
    void divide_group(std::span<const std::uint32_t> members, bool preserves);
    [[nodiscard]] Float3 sum_of(std::span<const std::uint32_t> members) const;
    void set(std::uint32_t member, Float3 tangent, bool preserves);
    void fill_in_degenerate();

    const MeshPart& part_;
    const std::vector<Float2>& uvs_;
    const int uv_set_;
    std::vector<std::uint32_t> welded_;  // representatives of all corners
    std::vector<std::uint32_t> faces_;
    std::vector<std::uint32_t> corners_;
    std::vector<Directions> directions_;
    std::vector<std::int32_t> neighbours_;
    std::vector<std::uint32_t> group_of_;
    std::vector<std::uint32_t> members_;     // corners, group by group
    std::vector<std::uint32_t> group_ends_;  // in members_
    std::vector<Float4> tangents_;
    std::atomic<bool> too_many_{false};
};

void Mikktspace::sort_out() {
    for (std::uint32_t f = 0; f < part_.triangles(); ++f) {
        const std::uint32_t* c = &welded_[3 * std::size_t{f}];
        const Float3 p[3] = {position(c[0]), position(c[1]), position(c[2])};
        if (same(p[0], p[1]) || same(p[0], p[2]) || same(p[1], p[2])) continue;
        faces_.push_back(f);
        corners_.insert(corners_.end(), c, c + 3);
    }
}

Result<void> Mikktspace::find_directions(const Execution& execution) {
    directions_.resize(faces_.size());
    return parallel_for(execution, static_cast<int>(faces_.size()), kGrain, [&](int begin, int end) {
        for (auto f = static_cast<std::size_t>(begin); f < static_cast<std::size_t>(end); ++f) {
            const std::uint32_t* c = &corners_[3 * f];
            directions_[f] =
                directions_of({position(c[0]), position(c[1]), position(c[2])}, {uv(c[0]), uv(c[1]), uv(c[2])});
        }
    });
}

// Gathers the group that begins with the corner `seed`: all corners of its vertex that edges between triangles of equal
// sign connect.
void Mikktspace::fill_group(std::uint32_t seed, std::vector<std::uint32_t>& waiting) {
    const std::uint32_t vertex = corners_[seed];
    const auto group = static_cast<std::uint32_t>(group_ends_.size());
    const bool preserves = directions_[seed / 3].preserves;
    const auto add = [&](std::uint32_t corner) {
        group_of_[corner] = group;
        members_.push_back(corner);
        const std::uint32_t first = corner - corner % 3, k = corner % 3;
        // The edge from this corner comes first, then the edge to it. Triangles wait in reverse.
        for (const std::uint32_t edge : {first + (k + 2) % 3, corner}) {
            if (neighbours_[edge] != kNoNeighbour) waiting.push_back(static_cast<std::uint32_t>(neighbours_[edge]));
        }
    };
    add(seed);
    while (!waiting.empty()) {
        const std::uint32_t triangle = waiting.back();
        waiting.pop_back();
        const std::uint32_t first = 3 * triangle;
        const std::uint32_t corner = corners_[first] == vertex       ? first
                                     : corners_[first + 1] == vertex ? first + 1
                                                                     : first + 2;
        if (group_of_[corner] != kNoGroup) continue;
        Directions& d = directions_[triangle];
        if (d.joins_any && group_of_[first] == kNoGroup && group_of_[first + 1] == kNoGroup &&
            group_of_[first + 2] == kNoGroup)
            d.preserves = preserves;
        if (d.preserves == preserves) add(corner);
    }
}

void Mikktspace::find_groups() {
    group_of_.assign(corners_.size(), kNoGroup);
    members_.reserve(corners_.size());
    std::vector<std::uint32_t> waiting;
    for (std::uint32_t c = 0; c < corners_.size(); ++c) {
        if (directions_[c / 3].joins_any || group_of_[c] != kNoGroup) continue;
        fill_group(c, waiting);
        group_ends_.push_back(static_cast<std::uint32_t>(members_.size()));
    }
}

// The tangent of a group: the sum of its triangles' directions, weighted by their angles. (The reference does the same
// with t, whose sum only a caller of its other interface sees.)
Float3 Mikktspace::sum_of(std::span<const std::uint32_t> members) const {
    Float3 sum;
    for (const std::uint32_t corner : members) {
        const Directions& d = directions_[corner / 3];
        if (d.joins_any) continue;
        const std::uint32_t first = corner - corner % 3, k = corner % 3;
        const std::uint32_t here = corners_[corner];
        const Float3 n = normal(here), p = position(here);
        const Float3 s = normalized(in_plane(n, d.s));
        const Float3 before = normalized(in_plane(n, position(corners_[first + (k + 2) % 3]) - p));
        const Float3 after = normalized(in_plane(n, position(corners_[first + (k + 1) % 3]) - p));
        sum = sum + angle(dot(before, after)) * s;
    }
    return normalized(sum);
}

void Mikktspace::set(std::uint32_t member, Float3 tangent, bool preserves) {
    if (!is_finite(tangent)) tangent = {1.0f, 0.0f, 0.0f};  // of coordinates whose squares are infinite
    tangents_[3 * std::size_t{faces_[member / 3]} + member % 3] = {tangent.x, tangent.y, tangent.z,
                                                                   preserves ? 1.0f : -1.0f};
}

// Whether it is certain that no two members have directions that are exactly opposite in float: all are within 89
// degrees of the first.
bool Mikktspace::points_one_way(std::span<const std::uint32_t> members) const {
    const Float3 n = normal(corners_[members[0]]);
    Float3 first_s, first_t;
    bool any = false;
    for (const std::uint32_t corner : members) {
        const Directions& d = directions_[corner / 3];
        if (d.joins_any) continue;
        const Float3 s = normalized(in_plane(n, d.s)), t = normalized(in_plane(n, d.t));
        if (!any) first_s = s, first_t = t;
        any = true;
        if (!(dot(first_s, s) > 0.02f && dot(first_t, t) > 0.02f)) return false;
    }
    return true;
}

// For each member, the tangent of all members but those that point exactly the other way. Equal subsets share a sum.
void Mikktspace::divide_group(std::span<const std::uint32_t> members, bool preserves) {
    if (members.size() > kMaxFan) {
        too_many_ = true;
        return;
    }
    const Float3 n = normal(corners_[members[0]]);
    std::vector<std::pair<Float3, Float3>> projected;
    for (const std::uint32_t corner : members) {
        const Directions& d = directions_[corner / 3];
        projected.emplace_back(normalized(in_plane(n, d.s)), normalized(in_plane(n, d.t)));
    }
    std::map<std::vector<std::uint32_t>, Float3> sums;
    std::vector<std::uint32_t> left_out, chosen;  // a subset is named by what it leaves out, which is little
    for (std::size_t a = 0; a < members.size(); ++a) {
        left_out.clear();
        for (std::size_t b = 0; b < members.size(); ++b) {
            const bool any = directions_[members[a] / 3].joins_any || directions_[members[b] / 3].joins_any;
            const bool close = dot(projected[a].first, projected[b].first) > -1.0f &&
                               dot(projected[a].second, projected[b].second) > -1.0f;
            if (!any && a != b && !close) left_out.push_back(members[b]);
        }
        auto sum = sums.find(left_out);
        if (sum == sums.end()) {
            if (sums.size() * members.size() >= kMostTerms) {
                too_many_ = true;
                return;
            }
            chosen.clear();
            std::set_difference(members.begin(), members.end(), left_out.begin(), left_out.end(),
                                std::back_inserter(chosen));
            sum = sums.emplace(left_out, sum_of(chosen)).first;
        }
        set(members[a], sum->second, preserves);
    }
}

void Mikktspace::make_tangents_of(std::uint32_t group) {
    const std::uint32_t begin = group == 0 ? 0 : group_ends_[group - 1];
    const std::span<std::uint32_t> members(members_.data() + begin, group_ends_[group] - begin);
    const bool preserves = directions_[members[0] / 3].preserves;
    std::sort(members.begin(), members.end());  // the reference adds in the order of triangles
    if (!points_one_way(members)) return divide_group(members, preserves);
    const Float3 tangent = sum_of(members);
    for (const std::uint32_t corner : members) set(corner, tangent, preserves);
}

Result<void> Mikktspace::make_group_tangents(const Execution& execution) {
    const auto made = parallel_for(execution, static_cast<int>(group_ends_.size()), kGrain, [&](int begin, int end) {
        for (int group = begin; group < end; ++group) make_tangents_of(static_cast<std::uint32_t>(group));
    });
    if (!made) return made.error();
    if (too_many_) {
        return Error{ErrorCode::unsupported,
                     {},
                     "more than " + std::to_string(kMaxFan) +
                         " triangles whose tangents point in opposite directions meet at one vertex"};
    }
    return {};
}

void Mikktspace::fill_in_degenerate() {
    if (faces_.size() == part_.triangles()) return;
    std::vector<std::uint32_t> first(welded_.size(), ~std::uint32_t{0});
    for (std::size_t c = corners_.size(); c-- > 0;) first[corners_[c]] = static_cast<std::uint32_t>(c);
    std::size_t next = 0;
    for (std::uint32_t f = 0; f < part_.triangles(); ++f) {
        if (next < faces_.size() && faces_[next] == f) {
            ++next;
            continue;
        }
        for (std::size_t c = 3 * std::size_t{f}; c < 3 * std::size_t{f} + 3; ++c) {
            const std::uint32_t source = first[welded_[c]];
            if (source == ~std::uint32_t{0}) continue;
            tangents_[c] = tangents_[3 * std::size_t{faces_[source / 3]} + source % 3];
        }
    }
}

Result<std::vector<Float4>> Mikktspace::run(const Execution& execution) {
    const Execution welding = part_of(execution, 0.0, 0.4), pairing = part_of(execution, 0.4, 0.5);
    const Execution summing = part_of(execution, 0.5, 1.0);
    auto welded = weld_corners(part_, uv_set_, welding);
    if (!welded) return welded.error();
    welded_ = std::move(*welded);
    sort_out();
    if (const auto found = find_directions(execution.quiet()); !found) return found.error();
    auto neighbours = find_neighbours(corners_, pairing);
    if (!neighbours) return neighbours.error();
    neighbours_ = std::move(*neighbours);
    find_groups();
    neighbours_ = {};
    group_of_ = {};
    tangents_.assign(part_.indices.size(), {1.0f, 0.0f, 0.0f, -1.0f});
    if (const auto made = make_group_tangents(summing); !made) return made.error();
    fill_in_degenerate();
    return std::move(tangents_);
}

}  // namespace

Result<std::vector<Float4>> mikktspace_tangents(const MeshPart& part, int uv_set, const Execution& execution) {
    return Mikktspace(part, uv_set).run(execution);
}

}  // namespace tex::inline v1
