// SPDX-License-Identifier: Apache-2.0
// other_channels.h: looks at the channels of a map that hold no part of its normals, and whether z is what it seems.

#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include <tex/source.h>

#include "kernels/normal_row.h"
#include "rows/unpack_rows.h"

namespace tex {

// Whether the channel of z follows x and y. In maps of people z correlates with sqrt(1 - x^2 - y^2) by 0.84 and more;
// occlusion in its place, by 0.55 and less. The sign of z is ignored, so that maps in object space follow, too. Sums
// are whole numbers, so that the order of rows does not matter.
class ZEvidence {
public:
    void add_row(const float* x, const float* y, const float* z, bool is_unsigned, int width);
    void add(const ZEvidence& other);
    [[nodiscard]] bool is_something_else() const;

private:
    std::int64_t count_ = 0, off_ = 0;  // of |z - rebuilt z|, in 1/1024
    std::int64_t z_ = 0, rebuilt_ = 0, z_square_ = 0, rebuilt_square_ = 0, product_ = 0;
};

class OtherChannels {
public:
    // `head` describes the map. Colours that the file itself states to be constant are not looked at.
    OtherChannels(const Texture& head, Extent extent, const Sources& sources);

    [[nodiscard]] bool empty() const { return seen_.empty() && !judges_z_; }
    // The channels to look at: bit c is set for channel c.
    [[nodiscard]] bool wants(int channel) const;

    // Adds row j: its channels, of which those that are not wanted and hold no normals may be null, and its normals.
    // Rows may come in any order, from any thread.
    void add_row(int j, const float* const (&channels)[4], const VectorRow& normals, int width);

    // To be called after all rows.
    [[nodiscard]] std::vector<OtherChannel> found() const;
    [[nodiscard]] bool z_is_something_else() const { return z_.is_something_else(); }

private:
    struct Seen {
        int channel;
        float least, greatest;
        float off_x, off_y, off_z;  // the greatest difference from the channels of x and y, and from z as a code
    };
    void look(Seen& seen, const float* const (&channels)[4], const VectorRow& normals, int width) const;

    const Sources sources_;
    const bool judges_z_;  // it is stored as a whole number
    const bool is_unsigned_;
    const int z_step_;  // distance between the rows whose z is judged
    mutable std::mutex mutex_;
    std::vector<Seen> seen_;
    ZEvidence z_;
};

// The channels without these.
[[nodiscard]] std::vector<OtherChannel> left_out(std::vector<OtherChannel> channels, OtherPlanes accounted_for);

}  // namespace tex
