// SPDX-License-Identifier: Apache-2.0

#include "kernels/corner_vectors.h"

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/frames.h"
#include "rays/hit_normals.h"
#include "unit/targets.h"

namespace tex {
namespace {

constexpr std::size_t kMost = 40;
constexpr std::size_t kCounts[] = {1, 2, 7, 8, 9, 17, 33, 40};
using Block = VectorBlock<kMost>;

class Numbers {
public:
    explicit Numbers(unsigned seed) : random_(seed * 7919 + 1) {}
    float next() { return static_cast<float>(random_() >> 4) / static_cast<float>(0x7fffffffU >> 5) - 1.0f; }
    Float3 vector() { return {next(), next(), next()}; }

private:
    std::minstd_rand random_;
};

void fill_weights(Numbers& numbers, Block& weights) {
    for (std::size_t k = 0; k < kMost; ++k) {
        const double a = 0.5 + 0.5 * static_cast<double>(numbers.next()),
                     b = 0.5 + 0.5 * static_cast<double>(numbers.next());
        weights.set(k, a, b, 1.0 - a - b);
    }
    weights.set(0, 1.0, 0.0, 0.0);
}

// A triangle whose corners have frames of all kinds; every fourth one has no frame.
struct Framed {
    MeshPart part;
    std::vector<Float4> tangents;

    Framed(Numbers& numbers, unsigned kind) {
        part.indices = {0, 1, 2};
        for (std::uint32_t k = 0; k < 3; ++k) {
            part.normals.push_back(numbers.vector());
            const Float3 t = kind % 4 == 0 ? part.normals[k] : numbers.vector();
            tangents.push_back({t.x, t.y, t.z, (kind >> k) % 2 == 0 ? 1.0f : -1.0f});
        }
        part.positions.resize(3);
        part.uvs.assign(1, {{0.0f, 0.0f}, {1.0f, 0.0f}, {0.0f, 1.0f}});
        if (kind == 5) part.normals[0] = part.normals[1] = part.normals[2] = {};
    }
};

void expect_same(const std::array<double, 3>& is, Vector3 wanted) {
    EXPECT_EQ(is[0], wanted.x);
    EXPECT_EQ(is[1], wanted.y);
    EXPECT_EQ(is[2], wanted.z);
}

TEST(CornerVectors, AreWhatEachPlaceHasByItself) {
    on_every_target([] {
        for (const std::size_t count : kCounts) {
            Numbers numbers(static_cast<unsigned>(count));
            Block weights, sums, directions;
            fill_weights(numbers, weights);
            std::array<Vector3, 3> corners;
            for (Vector3& corner : corners) corner = vector_of(numbers.vector());
            CornerVectors rows;
            copy_to(corners, rows);
            mix_corners(rows, weights.all(), count, sums.all());
            EXPECT_TRUE(mix_directions(rows, weights.all(), count, directions.all()));
            for (std::size_t k = 0; k < count; ++k) {
                expect_same(sums.at(k), mix(corners, weights.at(k)));
                expect_same(directions.at(k), normalized(mix(corners, weights.at(k))));
            }
            // One of them cancels out; what comes after the last one does not count.
            corners[2] = -1.0 * corners[1];
            copy_to(corners, rows);
            weights.set(count - 1, 0.0, 0.5, 0.5);
            EXPECT_FALSE(mix_directions(rows, weights.all(), count, directions.all()));
            weights.set(count - 1, 1.0, 0.0, 0.0);
            weights.set(count, 0.0, 0.5, 0.5);
            EXPECT_TRUE(mix_directions(rows, weights.all(), count, directions.all()));
        }
    });
}

TEST(CornerVectors, EncodeAsOneFrameDoes) {
    constexpr Decoder kDecoders[] = {Decoder::gltf, Decoder::unity_builtin, Decoder::unreal, Decoder::blender,
                                     Decoder::substance_fragment};
    on_every_target([&] {
        for (unsigned kind = 0; kind < 16; ++kind) {
            const Decoder decoder = kDecoders[kind % std::size(kDecoders)];
            Numbers numbers(kind + 50);
            const Framed framed(numbers, kind);
            const CornerFrames frames({framed.part, framed.tangents, 0, decoder}, 0);
            Block weights, vectors, units;
            fill_weights(numbers, weights);
            for (std::size_t k = 0; k < kMost; ++k) {
                const Float3 v = numbers.vector();
                vectors.set(k, static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z));
            }
            vectors.set(3, 0.0, 0.0, 0.0);
            for (const std::size_t count : kCounts) {
                std::array<float, kMost + kMoreVectors> x{}, y{}, z{};
                const EncodedCounts counts = encode_vectors(frames.corners(), weights.all(), vectors.all(), count,
                                                            units.all(), {x.data(), y.data(), z.data()});
                EncodedCounts wanted;
                for (std::size_t k = 0; k < count; ++k) {
                    const Vector3 n = normalized(vector_of(vectors.at(k)));
                    expect_same(units.at(k), n);
                    const auto t = encode(frames.at(weights.at(k)), n);
                    wanted.singular += t ? 0 : 1;
                    wanted.backward += t && t->z < 0.0 ? 1 : 0;
                    const Vector3 flat = t.value_or(Vector3{0.0, 0.0, 1.0});
                    EXPECT_EQ(x[k], static_cast<float>(flat.x)) << kind << " " << k;
                    EXPECT_EQ(y[k], static_cast<float>(flat.y));
                    EXPECT_EQ(z[k], static_cast<float>(flat.z));
                }
                EXPECT_EQ(counts.singular, wanted.singular);
                EXPECT_EQ(counts.backward, wanted.backward);
            }
        }
    });
}

// Corners with normals, with normals that cancel out, and without any.
TEST(HitNormals, AreThoseOfEachHit) {
    Numbers numbers(9);
    std::vector<MeshPart> high(2);
    for (MeshPart& part : high) {
        for (int k = 0; k < 3; ++k) part.positions.push_back(numbers.vector());
        part.indices = {0, 1, 2, 2, 1, 0};
    }
    for (int k = 0; k < 3; ++k) high[0].normals.push_back(numbers.vector());
    high[0].normals[1] = {-high[0].normals[0].x, -high[0].normals[0].y, -high[0].normals[0].z};
    const TransferInputs inputs;
    const HighSurface surface(high, inputs);
    on_every_target([&] {
        for (const std::size_t count : kCounts) {
            Block weights;
            fill_weights(numbers, weights);
            weights.set(count / 2, 0.5, 0.5, 0.0);
            HitNormals normals;
            for (std::size_t k = 0; k < count; ++k)
                normals.add(surface, {high[k % 5 == 1 ? 1 : 0], k % 2}, weights.at(k));
            normals.find(surface);
            for (std::size_t k = 0; k < count; ++k) {
                const Vector3 wanted = surface.normal_at(normals.triangle(k), weights.at(k));
                EXPECT_NEAR(dot(wanted, wanted), 1.0, 1e-12);
                expect_same({normals.at(k).x, normals.at(k).y, normals.at(k).z}, wanted);
            }
        }
    });
}

}  // namespace
}  // namespace tex
