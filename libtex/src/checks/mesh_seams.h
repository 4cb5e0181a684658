// SPDX-License-Identifier: Apache-2.0
// mesh_seams.h: both sides of UV seams, and what a map decodes to there.

#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include <tex/check.h>

#include "checks/stored.h"
#include "mesh/frames.h"

namespace tex::inline v1 {

// One side of an edge: the triangle, and its corners at the ends of the edge.
struct SeamSide {
    std::size_t triangle = 0;
    std::array<std::size_t, 2> corner{};  // 0, 1 or 2; the ends are the same places on both sides
};

// An edge that two triangles share with equal positions and smooth normals, but different UVs.
struct SeamEdge {
    SeamSide a, b;
    double length = 0.0;  // in object space
};

// The seam edges of UV set 0, in the order of their first triangles. Edges of more than two triangles are left out. Of
// more than 2^14 edges, as many are returned, evenly spread.
std::vector<SeamEdge> find_seams(const MeshPart& part);

// How a map may be decoded: the decoder, its tangents, and which way green points.
struct SeamSpace {
    Decoder decoder = Decoder::gltf;
    const std::vector<Float4>* tangents = nullptr;  // for each corner
    bool y_up = true;
};

// The vector of a map at (x, y), in texels from its upper left corner. May be outside of the map.
using TexelAt = std::function<Vector3(double x, double y)>;

// Places on seam edges, with the map's texels on both sides.
class SeamSamples {
public:
    SeamSamples(const MeshPart& part, const std::vector<SeamEdge>& edges, Extent extent, const TexelAt& texel_at);
    // With the texels of a bilinear filter that repeats, whose x and y are multiplied by `scale`.
    SeamSamples(const MeshPart& part, const std::vector<SeamEdge>& edges, const Stored& stored, double scale = 1.0);

    struct Sample {
        std::size_t edge = 0;
        std::array<std::array<double, 3>, 2> weights{};  // of the corners of both triangles
        std::array<Vector3, 2> texel;                    // as stored
        std::array<double, 2> at{};                      // of the first side in the map, in texels
        double weight = 0.0;                             // length in object space
        double change = 0.0;  // the mean angle to the four texels around, of both sides, in degrees
    };
    [[nodiscard]] const std::vector<Sample>& samples() const { return samples_; }

    // For each sample, the difference between the decoded normals of both sides.
    [[nodiscard]] std::vector<Vector3> gaps(const SeamSpace& space) const;

private:
    const MeshPart& part_;
    const std::vector<SeamEdge>& edges_;
    std::vector<Sample> samples_;
};

// How surely gaps `b` are what the map was made for, rather than gaps `a`. If they are, a = noise + (a - b), so the
// regression of a on a - b has the slope 1; if `a` are right, it has the slope 0.
struct SeamVerdict {
    double slope = 0.0;
    double confidence = 0.5;  // that the slope is greater than a half
    double saved = 0.0;       // the root of the mean square of a - b, in degrees
};
SeamVerdict compare_gaps(const SeamSamples& samples, const std::vector<Vector3>& a, const std::vector<Vector3>& b);

}  // namespace tex::inline v1
