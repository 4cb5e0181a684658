// SPDX-License-Identifier: Apache-2.0
// kernels/corner_vectors.h: vectors between the corners of triangles, for many places at once: in double, with the
// bytes of mesh/vector3.h and mesh/frames.h, which say what they are for one place.
//
// Arrays are read and written in whole vectors: they have kMoreVectors elements more than `count`. What is in those has
// no meaning, and what is written there neither. Arrays that are written to overlap no others.

#pragma once

#include <array>
#include <cstddef>

#include <tex/mesh.h>

namespace tex::inline v1 {

// The widest vector without one of its lanes.
inline constexpr std::size_t kMoreVectors = 7;

// The components of vectors, or the weights of the three corners.
template <class T>
struct VectorArrays {
    T *x = nullptr, *y = nullptr, *z = nullptr;

    [[nodiscard]] VectorArrays from(std::size_t first) const { return {x + first, y + first, z + first}; }
    operator VectorArrays<const T>() const { return {x, y, z}; }
};

// Owns `kCount` vectors and those that may be written after them.
template <std::size_t kCount>
struct VectorBlock {
    double x[kCount + kMoreVectors] = {}, y[kCount + kMoreVectors] = {}, z[kCount + kMoreVectors] = {};

    void set(std::size_t k, double a, double b, double c) {
        x[k] = a;
        y[k] = b;
        z[k] = c;
    }
    [[nodiscard]] std::array<double, 3> at(std::size_t k) const { return {x[k], y[k], z[k]}; }
    [[nodiscard]] VectorArrays<double> all() { return {x, y, z}; }
    [[nodiscard]] VectorArrays<const double> all() const { return {x, y, z}; }
};

// A vector for each corner of a triangle: corner, axis.
using CornerVectors = double[3][3];

// The sums of the corners' vectors by weight.
void mix_corners(const CornerVectors& corners, VectorArrays<const double> weights, std::size_t count,
                 VectorArrays<double> sums);

// Mixes and normalises. Returns whether all sums have a length that is not nearly 0.
bool mix_directions(const CornerVectors& corners, VectorArrays<const double> weights, std::size_t count,
                    VectorArrays<double> directions);

// Mixes normals at places that each have their own triangle: normals[3 * corner + axis][k] belongs to place k. Normals
// are normalised before and after they are mixed. A sum without length becomes (0, 0, 0). Returns whether all sums have
// a length.
bool mix_normals(const float* const normals[9], VectorArrays<const double> weights, std::size_t count,
                 VectorArrays<double> units);

// What CornerFrames knows of a triangle.
struct FrameCorners {
    CornerVectors tangents, bitangents, normals;
    double signs[3];
    DecoderKind kind;
};

// How many vectors of encode_vectors() have no frame and become (0, 0, 1), and how many point to the back.
struct EncodedCounts {
    std::size_t singular = 0, backward = 0;
};

// units[k] becomes the normalised vectors[k], and texels[k] what encode() of mesh/frames.h makes of it.
EncodedCounts encode_vectors(const FrameCorners& frame, VectorArrays<const double> weights,
                             VectorArrays<const double> vectors, std::size_t count, VectorArrays<double> units,
                             VectorArrays<float> texels);

}  // namespace tex::inline v1
