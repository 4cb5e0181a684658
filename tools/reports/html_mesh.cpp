// SPDX-License-Identifier: Apache-2.0

#include "reports/html_mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "reports/html.h"

namespace tex::cli {
namespace {

// More triangles than fit, however many vertices they share. They are not even looked at.
constexpr std::size_t kMostTriangles = kHtmlMeshBudget / 4 * 3 / (3 * sizeof(std::uint16_t));
constexpr std::size_t kMostShortIndices = 65535;  // 65535 itself begins a new strip in WebGL 2

using Vector = std::array<double, 3>;

Vector vector_of(float x, float y, float z) {
    return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
}
Vector vector_of(const Float3& v) { return vector_of(v.x, v.y, v.z); }

double square_of(const Vector& v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

// A vector without length stays as it is.
Vector unit(Vector v) {
    const double n = std::sqrt(square_of(v));
    if (!(n > 1e-30)) return v;
    for (double& c : v) c /= n;
    return v;
}

std::int16_t code_of(double value) { return static_cast<std::int16_t>(std::floor(value * 32767.0 + 0.5)); }

// What makes a vertex: position, normal, tangent and w; u and v as their bits, so that corners can be sorted.
struct Corner {
    std::array<std::int16_t, 10> vectors{};
    std::array<std::uint32_t, 2> uv{};

    friend auto operator<=>(const Corner&, const Corner&) = default;
};

// The sphere around the mesh: as MeshBody of libtex.
struct Sphere {
    Vector centre{};
    double radius = 1.0;

    explicit Sphere(const MeshPart& part) {
        Vector low = vector_of(part.positions[part.indices.front()]), high = low;
        for (const std::uint32_t v : part.indices) {
            const Vector p = vector_of(part.positions[v]);
            for (std::size_t c = 0; c < 3; ++c) {
                low[c] = std::min(low[c], p[c]);
                high[c] = std::max(high[c], p[c]);
            }
        }
        for (std::size_t c = 0; c < 3; ++c) centre[c] = (low[c] + high[c]) * 0.5;
        double farthest = 0.0;
        for (const std::uint32_t v : part.indices)
            farthest = std::max(farthest, square_of(from_centre(part.positions[v])));
        if (farthest > 0.0) radius = std::sqrt(farthest);
    }
    [[nodiscard]] Vector from_centre(const Float3& position) const {
        const Vector p = vector_of(position);
        return {p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]};
    }
};

std::vector<Corner> corners_of(const TangentSpace& space) {
    const MeshPart& part = space.part;
    const Sphere sphere(part);
    const std::vector<Float2>& uvs = part.uvs[static_cast<std::size_t>(space.uv_set)];
    std::vector<Corner> corners(part.indices.size());
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const std::uint32_t v = part.indices[k];
        const Float4& t = space.tangents[k];
        const Vector p = sphere.from_centre(part.positions[v]);
        const Vector normal = unit(vector_of(part.normals[v])), tangent = unit(vector_of(t.x, t.y, t.z));
        Corner& corner = corners[k];
        for (std::size_t c = 0; c < 3; ++c) {
            corner.vectors[c] = code_of(p[c] / sphere.radius);
            corner.vectors[3 + c] = code_of(normal[c]);
            corner.vectors[6 + c] = code_of(tangent[c]);
        }
        corner.vectors[9] = code_of(t.w < 0.0f ? -1.0 : 1.0);
        const Float2& uv = uvs[v];
        corner.uv = {std::bit_cast<std::uint32_t>(uv.x),
                     std::bit_cast<std::uint32_t>(part.v_axis == YAxis::down ? uv.y : 1.0f - uv.y)};
    }
    return corners;
}

// For each corner, the first corner that is equal to it. Sorting takes the same time for all meshes, where a hash
// could be made to collide.
std::vector<std::uint32_t> first_equals(const std::vector<Corner>& corners) {
    std::vector<std::uint32_t> order(corners.size()), firsts(corners.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return corners[a] != corners[b] ? corners[a] < corners[b] : a < b;
    });
    for (std::size_t k = 0; k < order.size(); ++k) {
        const bool is_new = k == 0 || corners[order[k]] != corners[order[k - 1]];
        firsts[order[k]] = is_new ? order[k] : firsts[order[k - 1]];
    }
    return firsts;
}

template <class Integer>
void append(std::vector<std::byte>& bytes, Integer value) {
    for (std::size_t k = 0; k < sizeof(Integer); ++k) bytes.push_back(static_cast<std::byte>(value >> 8 * k & 255));
}

}  // namespace

std::size_t HtmlMesh::size() const { return base64_size(bytes.size()); }

Json HtmlMesh::json() const {
    Json json;
    json["arguments"] = arguments;
    json["decoder"] = name_of(kDecoderNames, decoder);
    json["vertices"] = vertices;
    json["triangles"] = triangles;
    if (place[3] != 1.0 || place[0] != 0.0 || place[1] != 0.0 || place[2] != 0.0) json["place"] = place;
    return json;
}

namespace {

std::shared_ptr<HtmlMesh> encoded_mesh(const TangentSpace& space, std::string arguments) {
    if (space.part.triangles() > kMostTriangles) return nullptr;
    const std::vector<Corner> corners = corners_of(space);
    const std::vector<std::uint32_t> firsts = first_equals(corners);
    auto mesh = std::make_shared<HtmlMesh>();
    mesh->arguments = std::move(arguments);
    mesh->decoder = space.decoder;
    mesh->triangles = space.part.triangles();
    for (std::size_t k = 0; k < firsts.size(); ++k) mesh->vertices += firsts[k] == k ? 1 : 0;
    const bool is_short = mesh->vertices <= kMostShortIndices;
    const std::size_t bytes = mesh->vertices * kHtmlVertexSize + firsts.size() * (is_short ? 2 : 4);
    if (base64_size(bytes) > kHtmlMeshBudget) return nullptr;

    mesh->bytes.reserve(bytes);
    std::vector<std::uint32_t> numbers(firsts.size());
    std::uint32_t next = 0;
    for (std::size_t k = 0; k < firsts.size(); ++k) {
        numbers[k] = firsts[k] == k ? next++ : numbers[firsts[k]];
        if (firsts[k] != k) continue;
        for (const std::int16_t code : corners[k].vectors) append(mesh->bytes, static_cast<std::uint16_t>(code));
        for (const std::uint32_t bits : corners[k].uv) append(mesh->bytes, bits);
    }
    for (const std::uint32_t number : numbers) {
        if (is_short)
            append(mesh->bytes, static_cast<std::uint16_t>(number));
        else
            append(mesh->bytes, number);
    }
    return mesh;
}

}  // namespace

std::shared_ptr<const HtmlMesh> html_mesh(const TangentSpace& space, std::string arguments) {
    return encoded_mesh(space, std::move(arguments));
}

std::shared_ptr<const HtmlMesh> html_mesh_beside(const TangentSpace& space, const MeshPart& other) {
    std::shared_ptr<HtmlMesh> mesh = encoded_mesh(space, {});
    if (mesh == nullptr) return mesh;
    const Sphere own(space.part), around(other);
    for (std::size_t c = 0; c < 3; ++c) mesh->place[c] = (own.centre[c] - around.centre[c]) / around.radius;
    mesh->place[3] = own.radius / around.radius;
    return mesh;
}

}  // namespace tex::cli
