// SPDX-License-Identifier: Apache-2.0

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mesh/gltf.h"

namespace tex::inline v1 {
namespace {

using Matrix = std::array<double, 12>;  // rows of 3x4

// a after b: the point is multiplied by b first.
Matrix product(const Matrix& a, const Matrix& b) {
    Matrix result{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            double sum = j == 3 ? a[i * 4 + 3] : 0.0;
            for (std::size_t k = 0; k < 3; ++k) sum += a[i * 4 + k] * b[k * 4 + j];
            result[i * 4 + j] = sum;
        }
    }
    return result;
}

// N numbers of an array, or `otherwise` if there is no array.
template <std::size_t N>
std::optional<std::array<double, N>> numbers(JsonValue value, std::array<double, N> otherwise) {
    if (value.is_null()) return otherwise;
    std::array<double, N> result{};
    if (value.size() != N) return std::nullopt;
    for (std::size_t k = 0; k < N; ++k) {
        const std::optional<double> number = value[k].number();
        if (!number || !std::isfinite(*number)) return std::nullopt;
        result[k] = *number;
    }
    return result;
}

// Whether a quaternion is one of unit length, as exporters round it.
bool is_rotation(const std::array<double, 4>& q) {
    const double squared = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    return squared > 0.9 && squared < 1.1;
}

// Translation after rotation after scale (glTF 2.0, 3.5.3).
Matrix matrix_of_parts(const std::array<double, 3>& t, const std::array<double, 4>& q, const std::array<double, 3>& s) {
    const auto [x, y, z, w] = q;
    const double rotation[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                                   {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                                   {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
    Matrix result{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) result[i * 4 + j] = rotation[i][j] * s[j];
        result[i * 4 + 3] = t[i];
    }
    return result;
}

std::optional<Matrix> matrix_of(JsonValue node) {
    if (node["matrix"].is_null()) {
        const auto t = numbers<3>(node["translation"], {0, 0, 0});
        const auto q = numbers<4>(node["rotation"], {0, 0, 0, 1});
        const auto s = numbers<3>(node["scale"], {1, 1, 1});
        if (!t || !q || !s || !is_rotation(*q)) return std::nullopt;
        return matrix_of_parts(*t, *q, *s);
    }
    const auto m = numbers<16>(node["matrix"], {});  // in columns
    if (!m) return std::nullopt;
    Matrix result{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 4; ++j) result[i * 4 + j] = (*m)[j * 4 + i];
    }
    return result;
}

// Where the instances of a node stand in its own space (EXT_mesh_gpu_instancing).
class Instances {
public:
    static Result<Instances> of(JsonValue node, GltfBuffers& buffers) {
        Instances all;
        const JsonValue attributes = node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
        for (std::size_t k = 0; k < 3; ++k) {
            const JsonValue index = attributes[std::array{"TRANSLATION", "ROTATION", "SCALE"}[k]];
            if (index.is_null()) continue;
            const auto accessor = buffers.accessor(index);
            if (!accessor) return accessor.error();
            if ((*accessor)->components != (k == 1 ? 4 : 3)) return bad_gltf("its instances are damaged");
            all.parts_[k] = *accessor;
            if (all.count_ && *all.count_ != (*accessor)->count) return bad_gltf("its instances are damaged");
            all.count_ = (*accessor)->count;
        }
        return all;
    }

    // Nothing if the node has none.
    [[nodiscard]] std::optional<std::size_t> count() const { return count_; }
    [[nodiscard]] Matrix matrix(std::size_t instance) const {
        return matrix_of_parts(part<3>(0, instance, {0, 0, 0}), part<4>(1, instance, {0, 0, 0, 1}),
                               part<3>(2, instance, {1, 1, 1}));
    }

private:
    template <std::size_t N>
    [[nodiscard]] std::array<double, N> part(std::size_t k, std::size_t instance, std::array<double, N> values) const {
        if (parts_[k] == nullptr) return values;
        for (std::size_t c = 0; c < N; ++c)
            values[c] = static_cast<double>(parts_[k]->number(instance, static_cast<int>(c)));
        return values;
    }

    std::array<const GltfAccessor*, 3> parts_{};
    std::optional<std::size_t> count_;
};

struct Waiting {
    std::int64_t node;
    Matrix parent;
};

// Adds the nodes that an array names, last first, because the last of them waits on top. Each node comes once.
Result<void> add_children(JsonValue list, const Matrix& parent, std::vector<bool>& known,
                          std::vector<Waiting>& waiting) {
    for (std::size_t k = list.size(); k-- > 0;) {
        const std::optional<std::int64_t> child = list[k].count();
        if (!child || static_cast<std::size_t>(*child) >= known.size()) return bad_gltf("a node does not exist");
        const auto index = static_cast<std::size_t>(*child);
        if (known[index]) return bad_gltf("node " + std::to_string(index) + " has two parents, or is its own ancestor");
        known[index] = true;
        waiting.push_back({*child, parent});
    }
    return {};
}

Result<std::vector<Waiting>> roots_of(JsonValue root, std::vector<bool>& known) {
    const JsonValue nodes = root["nodes"];
    const Matrix identity = MeshNode{}.to_scene;
    std::vector<Waiting> roots;
    if (root["scenes"].size() > 0) {
        const auto scene = root["scene"].is_null() ? std::optional<std::int64_t>(0) : root["scene"].count();
        if (!scene || static_cast<std::size_t>(*scene) >= root["scenes"].size())
            return bad_gltf("its scene does not exist");
        const JsonValue list = root["scenes"][static_cast<std::size_t>(*scene)]["nodes"];
        if (const auto added = add_children(list, identity, known, roots); !added) return added.error();
        return roots;
    }
    std::vector<bool> is_child(nodes.size(), false);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        const JsonValue children = nodes[k]["children"];
        for (std::size_t c = 0; c < children.size(); ++c) {
            const auto child = children[c].count();
            if (child && static_cast<std::size_t>(*child) < nodes.size())
                is_child[static_cast<std::size_t>(*child)] = true;
        }
    }
    for (std::size_t k = nodes.size(); k-- > 0;) {
        if (is_child[k]) continue;
        known[k] = true;
        roots.push_back({static_cast<std::int64_t>(k), identity});
    }
    return roots;
}

// Adds a node, or its instances. All nodes of a file may have as many instances as it has bytes.
Result<void> add_node(JsonValue node, int mesh, const Matrix& to_scene, GltfBuffers& buffers,
                      std::vector<MeshNode>& nodes) {
    const std::string name = node["name"].text().value_or("");
    const auto instances = Instances::of(node, buffers);
    if (!instances) return instances.error();
    if (!instances->count()) {
        nodes.push_back({name, mesh, to_scene});
        return {};
    }
    if (nodes.size() + *instances->count() > buffers.bytes())
        return bad_gltf("claims more instances than it has bytes");
    for (std::size_t k = 0; k < *instances->count(); ++k)
        nodes.push_back({name + "[" + std::to_string(k) + "]", mesh, product(to_scene, instances->matrix(k))});
    return {};
}

}  // namespace

Result<std::vector<MeshNode>> gltf_nodes(JsonValue root, GltfBuffers& buffers) {
    const JsonValue nodes = root["nodes"];
    std::vector<bool> known(nodes.size(), false);
    auto waiting = roots_of(root, known);
    if (!waiting) return waiting.error();
    std::vector<MeshNode> result;
    while (!waiting->empty()) {
        const Waiting next = waiting->back();
        waiting->pop_back();
        const auto index = static_cast<std::size_t>(next.node);
        const std::string name = "node " + std::to_string(index);
        const JsonValue node = nodes[index];
        const std::optional<Matrix> matrix = matrix_of(node);
        if (!matrix) return bad_gltf(name + ": its transform is damaged");
        const Matrix to_scene = product(next.parent, *matrix);
        if (const JsonValue mesh = node["mesh"]; !mesh.is_null()) {
            const std::optional<std::int64_t> number = mesh.count();
            if (!number || static_cast<std::size_t>(*number) >= root["meshes"].size())
                return bad_gltf(name + ": its mesh does not exist");
            if (const auto added = add_node(node, static_cast<int>(*number), to_scene, buffers, result); !added) {
                Error error = added.error();
                if (error.file.empty()) error.reason = name + ": " + error.reason;
                return error;
            }
        }
        if (const auto added = add_children(node["children"], to_scene, known, *waiting); !added) return added.error();
    }
    return result;
}

}  // namespace tex::inline v1
