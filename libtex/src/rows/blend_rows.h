// SPDX-License-Identifier: Apache-2.0
// blend_rows.h: turns rows of maps that lie on one another into rows of the blended map: see blend().

#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include <tex/blend.h>

#include "kernels/normal_row.h"
#include "rows/sampler.h"

namespace tex::inline v1 {

// Exact for right angles.
struct Rotation {
    double cosine = 1.0;
    double sine = 0.0;
};
[[nodiscard]] Rotation rotation_of(float degrees);

// The place of a layer on a result of this extent.
[[nodiscard]] UvMap uv_map_of(const Layer& layer, Extent result);

// The level at which a map of this extent is sampled, in steps of 1/256.
[[nodiscard]] double level_wanted(const UvMap& map, Extent source);

// Returns row j of a map that is available one row at a time.
using NormalRowOf = std::function<VectorRow(int j)>;

// A map and its place on the result. Either a chain, of which `level` is sampled, and the next level too if `mix` is
// above 0; or `rows` of a map of the extent `extent`, without a chain.
struct PlacedMap {
    const MipChain* chain = nullptr;
    NormalRowOf rows;
    Extent extent;
    UvMap map;
    Wrap wrap_x = Wrap::repeat;
    Wrap wrap_y = Wrap::repeat;
    std::size_t level = 0;
    float mix = 0.0f;
};

struct PlacedLayer {
    const Layer& layer;  // its detail is not used
    PlacedMap detail;
};

struct PlacedMaps {
    PlacedMap base;
    std::vector<PlacedLayer> layers;
    const BlendOptions& options;
    Extent extent;  // extent of the result
};

// Makes rows of the result, on one thread.
class BlendRows {
public:
    // `maps` must outlive this object.
    explicit BlendRows(const PlacedMaps& maps);
    ~BlendRows();
    BlendRows(BlendRows&&) noexcept;

    // Makes row j. `out` has room for whole vectors.
    void make(int j, NormalRow out);
    // Makes an extra channel at that row: that of the base, and where a layer has a mask and the same channel, that of
    // its detail, as far as the mask says. `base` is the row of the base; null: it is sampled. Precondition of null:
    // the base has a chain.
    void make_extra(Extra extra, const float* base, float* out);

private:
    class MapSampler;
    class LayerRows;

    const PlacedMaps& maps_;
    std::vector<MapSampler> base_;  // exactly one
    std::vector<LayerRows> layers_;
};

}  // namespace tex::inline v1
