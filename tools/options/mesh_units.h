// SPDX-License-Identifier: Apache-2.0
// mesh_units.h: the unit and the axes of one mesh, as another one has them: --high-scale, --high-up.

#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <tex/mesh.h>

namespace tex::cli {

// The axis that points up in the mesh, where the other one does in the mesh that it must fit.
enum class UpAxis { same, y, z };

inline constexpr Named<UpAxis> kUpAxisNames[] = {
    {UpAxis::same, "same", "that of the low mesh"},
    {UpAxis::y, "y", "y, where the low mesh has z"},
    {UpAxis::z, "z", "z, where the low mesh has y"},
};

struct MeshUnits {
    double scale = 1.0;
    UpAxis up = UpAxis::same;

    [[nodiscard]] bool is_plain() const { return scale == 1.0 && up == UpAxis::same; }
    // (x, y, z) as the other mesh has it.
    [[nodiscard]] std::array<double, 3> of(const std::array<double, 3>& p) const;
    // Moves what the scene of the mesh shows.
    void place(Mesh& mesh) const;
    // "--high-scale 0.01 --high-up z"
    [[nodiscard]] std::string arguments() const;
};

// The units with which the box of the high mesh is that of the low one, nearly, if both are far apart without them.
// `places` are those of the parts of the high mesh in its scene.
[[nodiscard]] std::optional<MeshUnits> fitting_units(const MeshPart& low, const std::vector<MeshPart>& high,
                                                     const std::vector<PartPlace>& places = {});

// How far the box of the high mesh lies from that of the low one, if both have one size and do not lie on each other: a
// translation is missing in one of them.
[[nodiscard]] std::optional<std::array<double, 3>> offset_between(const MeshPart& low,
                                                                  const std::vector<MeshPart>& high,
                                                                  const std::vector<PartPlace>& places = {});

}  // namespace tex::cli
