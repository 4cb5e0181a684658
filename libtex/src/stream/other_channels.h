// SPDX-License-Identifier: Apache-2.0
// other_channels.h: looks at the channels of a map that hold no part of its normals.

#pragma once

#include <mutex>
#include <vector>

#include <tex/source.h>

#include "kernels/normal_row.h"
#include "rows/unpack_rows.h"

namespace tex {

class OtherChannels {
public:
    // `head` describes the map. Colours that the file itself states to be constant are not looked at.
    OtherChannels(const Texture& head, const Sources& sources);

    [[nodiscard]] bool empty() const { return seen_.empty(); }
    // The channels to look at: bit c is set for channel c.
    [[nodiscard]] bool wants(int channel) const;

    // Adds a row: its channels, of which those that are not wanted and hold no normals may be null, and its normals.
    // Rows may come in any order, from any thread.
    void add_row(const float* const (&channels)[4], const VectorRow& normals, int width);

    // To be called after all rows.
    [[nodiscard]] std::vector<OtherChannel> found() const;

private:
    struct Seen {
        int channel;
        float least, greatest;
        float off_x, off_y, off_z;  // the greatest difference from the channels of x and y, and from z as a code
    };
    void look(Seen& seen, const float* const (&channels)[4], const VectorRow& normals, int width) const;

    const Sources sources_;
    mutable std::mutex mutex_;
    std::vector<Seen> seen_;
};

// The channels without alpha, if that is kept.
[[nodiscard]] std::vector<OtherChannel> left_out(std::vector<OtherChannel> channels, bool keeps_alpha);

}  // namespace tex
