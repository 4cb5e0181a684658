// SPDX-License-Identifier: Apache-2.0
// make_meshes: writes the sample meshes of this folder, from formulas.
//
//     make_meshes FOLDER
//
//     crate_low.glb       12 triangles   a cube with hard edges, and a chart for each face
//     crate_high.glb    6912 triangles   the same with round edges, a sunken panel and a knob on each face; no UVs
//
// Uses only + - * / and sqrt in double, so that every machine writes the same bytes. A test compares them with the
// committed files.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace {

using Point = std::array<double, 3>;

struct Vertices {
    std::vector<float> positions, normals, uvs;
    std::vector<std::uint16_t> indices;

    std::size_t count() const { return positions.size() / 3; }
};

// A face of the cube: its normal, and where s and t point.
struct Face {
    Point n, s, t;
};
constexpr Face kFaces[] = {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                           {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}}, {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
                           {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}}};
constexpr int kQuads = 24;  // along an edge of the high mesh
constexpr double kRadius = 0.12;

double step(double from, double to, double x) {
    const double k = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return k * k * (3.0 - 2.0 * k);
}

// Above the face, at s and t from -1 to 1: a panel, and a knob on it.
double height(double s, double t) {
    const double inside = step(0.78, 0.64, std::abs(s)) * step(0.78, 0.64, std::abs(t));
    const double knob = std::max(0.0, 1.0 - (s * s + t * t) / 0.2);
    return -0.06 * inside + 0.13 * knob * knob;
}

Point sum(const Point& a, double k, const Point& b) { return {a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2]}; }

Point unit(const Point& p) {
    const double n = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    return {p[0] / n, p[1] / n, p[2] / n};
}

void add(std::vector<float>& to, const Point& p) {
    for (const double value : p) to.push_back(static_cast<float>(value));
}

void add_quads(Vertices& mesh, std::size_t first, int quads) {
    for (int j = 0; j < quads; ++j) {
        for (int i = 0; i < quads; ++i) {
            const std::size_t row = static_cast<std::size_t>(quads) + 1;
            const std::size_t a = first + static_cast<std::size_t>(j) * row + static_cast<std::size_t>(i), c = a + row;
            for (const std::size_t v : {a, a + 1, c + 1, a, c + 1, c})
                mesh.indices.push_back(static_cast<std::uint16_t>(v));
        }
    }
}

Vertices low_crate() {
    Vertices mesh;
    for (std::size_t f = 0; f < 6; ++f) {
        const std::size_t first = mesh.count();
        for (int k = 0; k < 4; ++k) {
            const double s = k % 2 == 0 ? -1.0 : 1.0, t = k < 2 ? -1.0 : 1.0;
            add(mesh.positions, sum(sum(kFaces[f].n, s, kFaces[f].s), t, kFaces[f].t));
            add(mesh.normals, kFaces[f].n);
            // Charts lie in three columns and two rows; v points down in glTF.
            mesh.uvs.push_back(static_cast<float>((static_cast<double>(f % 3) + 0.5 + 0.46 * s) / 3.0));
            mesh.uvs.push_back(static_cast<float>(1.0 - (static_cast<double>(f / 3) + 0.5 + 0.46 * t) / 2.0));
        }
        add_quads(mesh, first, 1);
    }
    return mesh;
}

Vertices high_crate() {
    Vertices mesh;
    for (const Face& face : kFaces) {
        const std::size_t first = mesh.count();
        for (int j = 0; j <= kQuads; ++j) {
            for (int i = 0; i <= kQuads; ++i) {
                const double s = 2.0 * i / kQuads - 1.0, t = 2.0 * j / kQuads - 1.0;
                const double e = 1e-3, ds = (height(s + e, t) - height(s - e, t)) / (2.0 * e),
                             dt = (height(s, t + e) - height(s, t - e)) / (2.0 * e);
                const Point on_cube = sum(sum(face.n, s, face.s), t, face.t);
                Point core{};  // the cube's edges are rounded around it
                for (std::size_t k = 0; k < 3; ++k) core[k] = std::clamp(on_cube[k], kRadius - 1.0, 1.0 - kRadius);
                const Point round = unit(sum(on_cube, -1.0, core));
                add(mesh.positions, sum(sum(core, kRadius, round), height(s, t), face.n));
                add(mesh.normals, unit(sum(sum(round, -ds, face.s), -dt, face.t)));
            }
        }
        add_quads(mesh, first, kQuads);
    }
    return mesh;
}

template <class T>
void append(std::string& to, const std::vector<T>& values) {
    to.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

void append_number(std::string& to, std::size_t value) {
    const auto number = static_cast<std::uint32_t>(value);
    for (int shift = 0; shift < 32; shift += 8) to += static_cast<char>(number >> shift & 255);
}

// GLB: a header, the JSON, the buffer. Little-endian, as every machine that compiles this is.
bool write_glb(const std::string& path, const std::string& name, const Vertices& mesh) {
    std::string buffer, views, accessors, attributes;
    float low[3] = {1e9f, 1e9f, 1e9f}, high[3] = {-1e9f, -1e9f, -1e9f};
    for (std::size_t k = 0; k < mesh.positions.size(); ++k) {
        low[k % 3] = std::min(low[k % 3], mesh.positions[k]);
        high[k % 3] = std::max(high[k % 3], mesh.positions[k]);
    }
    char text[400];
    const auto add_view = [&](const auto& values, int target, const char* type, int component, std::size_t count,
                              const std::string& more) {
        const char* const comma = views.empty() ? "" : ",";
        std::snprintf(text, sizeof text, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu,\"target\":%d}", comma,
                      buffer.size(), values.size() * sizeof(values[0]), target);
        views += text;
        std::snprintf(text, sizeof text, "%s{\"bufferView\":%zu,\"componentType\":%d,\"count\":%zu,\"type\":\"%s\"%s}",
                      comma, static_cast<std::size_t>(std::count(accessors.begin(), accessors.end(), '}')), component,
                      count, type, more.c_str());
        accessors += text;
        append(buffer, values);
    };
    std::snprintf(text, sizeof text, ",\"min\":[%g,%g,%g],\"max\":[%g,%g,%g]", static_cast<double>(low[0]),
                  static_cast<double>(low[1]), static_cast<double>(low[2]), static_cast<double>(high[0]),
                  static_cast<double>(high[1]), static_cast<double>(high[2]));
    const std::string bounds = text;
    add_view(mesh.positions, 34962, "VEC3", 5126, mesh.count(), bounds);
    add_view(mesh.normals, 34962, "VEC3", 5126, mesh.count(), "");
    if (!mesh.uvs.empty()) add_view(mesh.uvs, 34962, "VEC2", 5126, mesh.count(), "");
    const int indices = mesh.uvs.empty() ? 2 : 3;
    add_view(mesh.indices, 34963, "SCALAR", 5123, mesh.indices.size(), "");
    std::snprintf(text, sizeof text,
                  "{\"asset\":{\"version\":\"2.0\",\"generator\":\"make_meshes\"},\"scene\":0,"
                  "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"name\":\"%s\",\"mesh\":0}],"
                  "\"meshes\":[{\"name\":\"%s\",\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1%s},"
                  "\"indices\":%d}]}],",
                  name.c_str(), name.c_str(), mesh.uvs.empty() ? "" : ",\"TEXCOORD_0\":2", indices);
    std::string json = text;
    json += "\"accessors\":[" + accessors + "],\"bufferViews\":[" + views +
            "],\"buffers\":[{\"byteLength\":" + std::to_string(buffer.size()) + "}]}";
    json.append((4 - json.size() % 4) % 4, ' ');
    buffer.append((4 - buffer.size() % 4) % 4, '\0');
    std::string file = "glTF";
    append_number(file, 2);
    append_number(file, 12 + 8 + json.size() + 8 + buffer.size());
    append_number(file, json.size());
    file += "JSON" + json;
    append_number(file, buffer.size());
    file.append("BIN\0", 4);
    file += buffer;
    std::FILE* out = std::fopen(path.c_str(), "wb");
    const bool written = out != nullptr && std::fwrite(file.data(), 1, file.size(), out) == file.size();
    if (out == nullptr || std::fclose(out) != 0 || !written) {
        std::fprintf(stderr, "make_meshes: error: %s: cannot be written\n", path.c_str());
        return false;
    }
    return true;
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 2) {
        std::fprintf(stderr, "usage: make_meshes FOLDER\n");
        return 2;
    }
    const std::string folder = arguments[1];
    const bool written = write_glb(folder + "/crate_low.glb", "crate_low", low_crate()) &&
                         write_glb(folder + "/crate_high.glb", "crate_high", high_crate());
    return written ? 0 : 1;
}
