// SPDX-License-Identifier: Apache-2.0
// transfer_strips.h: casts the rays of strips of rows, and makes texels of what they hit.

#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include <tex/transfer.h>

#include "kernels/corner_vectors.h"
#include "mesh/coverage.h"
#include "rays/high_surface.h"
#include "rays/hit_normals.h"
#include "rays/low_triangle.h"
#include "rays/ray_casts.h"
#include "rays/ray_groups.h"
#include "rays/ray_starts.h"
#include "rays/ray_work.h"
#include "rays/second_rays.h"

namespace tex::inline v1 {

// In NormalMap::x, marks texels that have no normal yet.
inline constexpr float kNoNormal = std::numeric_limits<float>::quiet_NaN();

// From the lowest to the highest of the numbers that it has seen.
struct SeenRange {
    float lowest = std::numeric_limits<float>::infinity(), highest = -std::numeric_limits<float>::infinity();

    void see(float value) {
        lowest = std::min(lowest, value);
        highest = std::max(highest, value);
    }
    [[nodiscard]] bool is_empty() const { return lowest > highest; }
};

// What all strips read.
struct TransferScene {
    const TangentSpace& low;
    const RayGroups& groups;
    const std::vector<RayCaster>& casters;  // of the groups
    const HighSurface& surface;
    const RayStarts& starts;
    const CoverageMap& coverage;  // of samples, without padding
    const SecondRays* second;     // null: there are none
    int subsamples;
    bool backfaces;
    std::atomic<std::int64_t>* rays;  // may be null
};

class TransferStrips {
public:
    // Both must outlive this. The maps that are wanted are not empty.
    TransferStrips(const TransferScene& scene, TransferredMaps& result)
        : scene_(scene), n_(scene.subsamples), result_(result), wants_more_(wants_more()) {}

    // Threads may transfer different strips at the same time.
    void run(int strip);
    // After all strips. Errors: unsupported (RayWork).
    [[nodiscard]] Result<void> check() const { return costly_.check(); }
    // What is known only then: the ranges, and the needs of missed texels.
    void finish();

private:
    // Rays that are cast at once: of some texels of a row.
    static constexpr std::size_t kRaysAtOnce = HitNormals::kMost;
    // A covered sample of a texel.
    struct Sample {
        int i;
        std::int32_t triangle;
        std::size_t place;  // among the n x n samples of its texel
        int group;
    };
    // A texel with a hit.
    struct Texel {
        int i;
        std::int32_t triangle;  // whose tangent space it gets
    };
    // Texels of a row, which get their tangent space together.
    struct Texels {
        std::size_t count = 0;
        std::array<Texel, kRaysAtOnce> list;
        std::vector<Vector3> bent;  // of second rays
        VectorBlock<kRaysAtOnce> weights, normals, units;
        float x[kRaysAtOnce + kMoreVectors], y[kRaysAtOnce + kMoreVectors], z[kRaysAtOnce + kMoreVectors];
    };
    // What a strip adds to the counts of the result.
    struct Found {
        std::int64_t covered_texels = 0, missed = 0, backward = 0, singular = 0, behind = 0, hopeless = 0, rays = 0;
        SeenRange heights, thickness;
        std::vector<float> needs;
    };
    // Triangles of the low mesh that were used last: a row comes back to them in the next one.
    struct CachedTriangle {
        std::int32_t number = kNoTriangle;
        LowTriangle triangle;
    };
    static constexpr std::size_t kCachedTriangles = 256;
    // The samples of a texel that hit.
    struct Hits {
        int count = 0;
        Vector3 normal;
        double height = 0.0;
    };
    // What else is wanted of them.
    struct More {
        Vector3 position, color, vertex_color;
        SecondRays::Sums second;
        std::vector<std::int32_t> ids;
    };
    // Strips use its memory one after the other.
    struct Strip : Found {
        std::vector<Covered> covered;  // of samples
        std::vector<Sample> samples;
        VectorBlock<kRaysAtOnce> weights, points, directions;  // of the samples
        std::vector<RayStart> starts;
        std::vector<RayEnd> ends;
        // What rays of one group need.
        std::vector<std::size_t> chosen;
        std::vector<RayStart> chosen_starts;
        std::vector<RayEnd> chosen_ends;
        RayWork starting;  // of directions
        RayCaster::Scratch casts;
        SecondRays::Scratch scratch;
        HitNormals normals;
        std::size_t next_hit = 0;  // in `normals`
        Texels texels;
        More more;  // of the texel
        std::vector<CachedTriangle> kept = std::vector<CachedTriangle>(kCachedTriangles);
    };

    const LowTriangle& triangle_of(Strip& strip, std::int32_t number) const;
    // Returns the mesh, if any, that makes it cost too much.
    [[nodiscard]] std::optional<RaySide> cast(Strip& strip, int first_row, int j, int begin, int end) const;
    void collect(Strip& strip, int first_row, int j, int begin, int end) const;
    void start_rays(Strip& strip, int j) const;
    void cast_groups(Strip& strip) const;
    void find_normals(Strip& strip) const;
    void finish_texel(Strip& strip, int i, int j, std::size_t begin, std::size_t end) const;
    [[nodiscard]] bool wants_more() const;
    void see_more(Strip& strip, int i, int j, std::size_t begin, std::size_t end, std::size_t hit) const;
    void see_second(Strip& strip, int i, int j, std::size_t k, std::size_t hit) const;
    void put_more(Strip& strip, int i, int j, double part) const;
    void miss_texel(Strip& strip, int i, int j, std::size_t begin) const;
    void add_texel(Strip& strip, int i, std::size_t begin, std::size_t end, const Hits& hits) const;
    void encode_texels(Strip& strip, int j) const;
    [[nodiscard]] std::unique_ptr<Strip> take_strip();
    void add(std::unique_ptr<Strip> strip, const Overlaps& overlaps);

    const TransferScene& scene_;
    const int n_;
    TransferredMaps& result_;
    const bool wants_more_;
    CostlyPiece costly_;
    std::mutex mutex_;  // guards the counts in result_, and:
    std::vector<std::unique_ptr<Strip>> idle_;
    std::vector<float> needs_;
    SeenRange heights_, thickness_;
};

}  // namespace tex::inline v1
