// SPDX-License-Identifier: Apache-2.0

#include "checks/tangent_rules.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <tex/mesh.h>

#include "checks/model_engines.h"
#include "checks/thresholds.h"

namespace tex::inline v1 {
namespace {

double length_of(const Float4& t) {
    const auto x = static_cast<double>(t.x), y = static_cast<double>(t.y), z = static_cast<double>(t.z);
    return std::sqrt(x * x + y * y + z * z);
}

// In degrees; both have a length.
double angle_between(const Float4& a, const Float4& b) {
    const auto part = [&](float of_a, float of_b) {
        return static_cast<double>(of_a) / length_of(a) - static_cast<double>(of_b) / length_of(b);
    };
    const double x = part(a.x, b.x), y = part(a.y, b.y), z = part(a.z, b.z);
    return 2.0 * kDegrees * std::asin(std::min(1.0, std::sqrt(x * x + y * y + z * z) / 2.0));
}

// What the tangents of the file are like.
struct TangentCounts {
    std::size_t zero = 0, not_unit = 0, sign_not_one = 0;       // corners
    std::size_t mixed = 0, opposite = 0, with_orientation = 0;  // triangles
    double shortest = 1.0, longest = 1.0;
    float other_sign = 1.0f;  // the first w that is neither 1 nor -1
};

TangentCounts count_tangents(const SelectedPart& selected) {
    TangentCounts counts;
    for (const Float4& t : selected.tangents) {
        const double length = length_of(t);
        if (length < 1e-6) {
            ++counts.zero;
        } else if (std::abs(length - 1.0) > thresholds::kTangentLength) {
            ++counts.not_unit;
        }
        counts.shortest = std::min(counts.shortest, length);
        counts.longest = std::max(counts.longest, length);
        if (std::abs(std::abs(static_cast<double>(t.w)) - 1.0) <= thresholds::kTangentSign) continue;
        if (counts.sign_not_one++ == 0) counts.other_sign = t.w;
    }
    for (std::size_t t = 0; t < selected.part.triangles(); ++t) {
        const Float4* const corner = &selected.tangents[3 * t];
        const bool negative = corner[0].w < 0.0f;
        if ((corner[1].w < 0.0f) != negative || (corner[2].w < 0.0f) != negative) {
            ++counts.mixed;
            continue;
        }
        const double area = area_in_map(selected.part, t);
        if (area == 0.0) continue;
        ++counts.with_orientation;
        if (negative != (area < 0.0)) ++counts.opposite;
    }
    return counts;
}

std::string of_all(std::size_t count, std::size_t all, const char* what) {
    return std::to_string(count) + " of " + std::to_string(all) + " " + what;
}

Finding& add(Findings& findings, std::string_view id, std::string message, double figure, std::string_view unit) {
    Finding& finding = findings.add(id, std::move(message));
    finding.figure = figure;
    finding.unit = unit;
    return finding;
}

// A material that mirrors or turns its map moves it away from the tangents, which stay.
std::string of_moved_uvs(const SelectedPart& selected) {
    return selected.has_transform ? "; the UVs are those that KHR_texture_transform of the material makes" : "";
}

void report(const SelectedPart& selected, const TangentCounts& counts, Findings& findings) {
    const std::size_t corners = selected.tangents.size(), triangles = selected.part.triangles();
    const auto share = [](std::size_t count, std::size_t all) {
        return static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(all, 1));
    };
    if (counts.zero + counts.not_unit > 0) {
        add(findings, "N702",
            of_all(counts.zero, corners, "corners have a tangent of length zero, ") + std::to_string(counts.not_unit) +
                " another length than 1: " + decimal(counts.shortest, 3) + " to " + decimal(counts.longest, 3),
            share(counts.zero + counts.not_unit, corners), "share");
    }
    if (counts.sign_not_one > 0) {
        add(findings, "N703",
            of_all(counts.sign_not_one, corners, "corners, the first with w = ") +
                decimal(static_cast<double>(counts.other_sign), 3),
            share(counts.sign_not_one, corners), "share");
    }
    if (counts.mixed > 0)
        add(findings, "N704", of_all(counts.mixed, triangles, "triangles"), share(counts.mixed, triangles), "share");
    const double opposite = share(counts.opposite, counts.with_orientation);
    if (opposite > thresholds::kOppositeSigns)
        add(findings, "N706", of_all(counts.opposite, counts.with_orientation, "triangles") + of_moved_uvs(selected),
            opposite, "share");
}

// Percentiles of the angles in degrees.
struct Distance {
    double median = 0.0, p99 = 0.0;
};

// Between the tangents of the file and those that `method` makes.
Result<Distance> distance_from(TangentMethod method, const SelectedPart& selected, const Execution& execution) {
    const auto made = make_tangents(selected.part, method, 0, execution);
    if (!made) return made.error();
    std::vector<double> angles;
    angles.reserve(made->size());
    for (std::size_t t = 0; t < selected.part.triangles(); ++t) {
        if (area_in_map(selected.part, t) == 0.0) continue;  // its tangents are arbitrary
        for (std::size_t c = 3 * t; c < 3 * t + 3; ++c) {
            if (length_of(selected.tangents[c]) < 1e-6) continue;
            angles.push_back(angle_between(selected.tangents[c], (*made)[c]));
        }
    }
    if (angles.empty()) return Distance{};
    std::sort(angles.begin(), angles.end());
    return Distance{angles[(angles.size() - 1) / 2], angles[(angles.size() - 1) * 99 / 100]};
}

Result<void> compare_with_methods(const SelectedPart& selected, const Execution& execution, Findings& findings) {
    if (!findings.wants("N705")) return {};
    const auto mikktspace = distance_from(TangentMethod::mikktspace, selected, execution);
    if (!mikktspace) return mikktspace.error();
    if (mikktspace->p99 <= thresholds::kTangentAngle) return {};
    const auto meshopt = distance_from(TangentMethod::meshopt, selected, execution);
    if (!meshopt) return meshopt.error();
    const auto text = [](const Distance& d) {
        return "median " + decimal(d.median, 2) + ", p99 " + decimal(d.p99, 2) + " degrees";
    };
    std::string message = "they differ by " + text(*mikktspace);
    if (meshopt->p99 < 0.5 * mikktspace->p99) message += "; meshoptimizer's fit better: " + text(*meshopt);
    Finding& finding = add(findings, "N705", message + of_moved_uvs(selected), mikktspace->p99, "degrees");
    if (mikktspace->median >= thresholds::kTangentsAside) findings.rate(finding, Severity::error);
    return {};
}

Float4 sum(const Float3& a, const Float3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z, 0.0f}; }

// Half-way between two unit normals, however long they are stored.
Float4 between(const Float3& a, const Float3& b) {
    const auto unit = [](const Float3& n) {
        const auto length = static_cast<float>(length_of({n.x, n.y, n.z, 0.0f}));
        return length > 0.0f ? Float3{n.x / length, n.y / length, n.z / length} : n;
    };
    return sum(unit(a), unit(b));
}

void check_quads(const MeshPart& part, Findings& findings) {
    std::size_t ambiguous = 0;
    double largest = 0.0;
    for (const std::uint32_t t : part.quads) {
        const auto normal = [&](std::size_t c) { return part.normals[part.indices[3 * std::size_t{t} + c]]; };
        const Float4 one = between(normal(0), normal(2)), other = between(normal(1), normal(5));
        if (length_of(one) < 1e-6 || length_of(other) < 1e-6) continue;
        const double angle = angle_between(one, other);
        largest = std::max(largest, angle);
        ambiguous += angle > thresholds::kQuadAngle ? 1 : 0;
    }
    if (ambiguous == 0) return;
    add(findings, "N731",
        of_all(ambiguous, part.quads.size(), "quads: the normals at their centres differ by up to ") +
            decimal(largest, 1) + " degrees",
        largest, "degrees");
}

}  // namespace

double area_in_map(const MeshPart& part, std::size_t triangle) {
    std::array<double, 3> u{}, v{};
    for (std::size_t k = 0; k < 3; ++k) {
        const Float2 uv = part.uvs.front()[part.indices[3 * triangle + k]];
        u[k] = static_cast<double>(uv.x);
        v[k] = static_cast<double>(uv.y);
    }
    const double area = (u[1] - u[0]) * (v[2] - v[0]) - (v[1] - v[0]) * (u[2] - u[0]);
    return part.v_axis == YAxis::up ? area : -area;
}

Result<void> check_tangent_rules(const CheckContext& context, Findings& findings) {
    const SelectedPart& selected = context.options.mesh->selected;
    check_quads(selected.part, findings);
    if (selected.has_normal_map && !selected.has_tangents && misses_tangents(context)) {
        findings.add("N701", std::string("they come from ") +
                                 std::string(name_of(kTangentSourceNames, selected.source)) + " here");
    }
    if (selected.source != TangentSource::file) return {};
    report(selected, count_tangents(selected), findings);
    return compare_with_methods(selected, context.execution, findings);
}

}  // namespace tex::inline v1
