// SPDX-License-Identifier: Apache-2.0
// transfer_strips.h: casts the rays of strips of rows, and makes texels of what they hit.

#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <vector>

#include <tex/mesh.h>

#include "mesh/coverage.h"
#include "rays/high_surface.h"
#include "rays/low_triangle.h"
#include "rays/ray_casts.h"
#include "rays/ray_groups.h"
#include "rays/ray_starts.h"
#include "rays/second_rays.h"

namespace tex::inline v1 {

// In NormalMap::x, marks texels that have no normal yet.
inline constexpr float kNoNormal = std::numeric_limits<float>::quiet_NaN();

// Sets a texel of a map of vectors.
void put(NormalMap& map, int i, int j, Vector3 n);

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
        : scene_(scene), n_(scene.subsamples), result_(result) {}

    // Threads may transfer different strips at the same time.
    void run(int strip);
    // What is known only after all strips: the ranges, and the needs of missed texels.
    void finish();

private:
    // A covered sample of a texel.
    struct Sample {
        int i;
        std::size_t place;  // among the n x n samples of its texel
        Covered covered;
        int group;
    };
    // What a strip adds to the counts of the result.
    struct Found {
        std::int64_t covered_texels = 0, missed = 0, backward = 0, singular = 0, behind = 0, hopeless = 0, rays = 0;
        SeenRange heights, thickness;
        std::vector<float> needs;
    };
    // Triangles of the low mesh that were used last: a row comes back to them in the next one.
    struct Kept {
        std::int32_t number = kNoTriangle;
        LowTriangle triangle;
    };
    static constexpr std::size_t kKept = 256;
    // Strips use its memory one after the other.
    struct Strip : Found {
        std::vector<Covered> covered;  // of samples
        std::vector<Sample> samples;
        std::vector<RayStart> starts;
        std::vector<RayEnd> ends;
        // Those of one group.
        std::vector<std::size_t> chosen;
        std::vector<RayStart> chosen_starts;
        std::vector<RayEnd> chosen_ends;
        RayCaster::Scratch casts;
        SecondRays::Scratch scratch;
        HighSurface::Seen seen;
        std::vector<std::int32_t> ids;  // of the hits of a texel
        std::vector<Kept> kept = std::vector<Kept>(kKept);
    };
    // The samples of a texel that hit.
    struct Hits {
        int count = 0;
        Vector3 normal, position;
        double height = 0.0;
        Vector3 color, vertex_color;
        SecondRays::Sums second;
    };

    const LowTriangle& triangle_of(Strip& strip, const Covered& covered) const;
    void cast(Strip& strip, int first_row, int j, int begin, int end) const;
    void collect(Strip& strip, int first_row, int j, int begin, int end) const;
    void cast_groups(Strip& strip) const;
    void finish_texel(Strip& strip, int i, int j, std::size_t begin, std::size_t end) const;
    void add_hit(Strip& strip, int i, int j, std::size_t k, Hits& hits) const;
    void put_values(Strip& strip, int i, int j, const Hits& hits) const;
    void put_surface(Strip& strip, int i, int j, const Hits& hits) const;
    void miss_texel(Strip& strip, int i, int j, std::size_t begin) const;
    void encode_texel(Strip& strip, int i, int j, std::size_t begin, std::size_t end, const Hits& hits) const;
    [[nodiscard]] std::unique_ptr<Strip> take_strip();
    void add(std::unique_ptr<Strip> strip, std::int64_t overlaps);

    const TransferScene& scene_;
    const int n_;
    TransferredMaps& result_;
    std::mutex mutex_;  // guards the counts in result_, and:
    std::vector<std::unique_ptr<Strip>> idle_;
    std::vector<float> needs_;
    SeenRange heights_, thickness_;
};

}  // namespace tex::inline v1
