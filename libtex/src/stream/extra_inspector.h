// SPDX-License-Identifier: Apache-2.0
// extra_inspector.h: looks at the channels of a map that hold no part of its normals, whether z is what it seems, and
// whether floats are finite.

#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <mutex>
#include <vector>

#include <tex/file.h>

#include "kernels/normal_row.h"
#include "rows/unpack_rows.h"
#include "rows/z_evidence.h"

namespace tex::inline v1 {

class ExtraInspector {
public:
    // `head` describes the map. Colours that the file itself states to be constant are not looked at. With
    // options.drop_others, only floats are.
    ExtraInspector(const Texture& head, Extent extent, const Sources& sources, const SourceOptions& options);

    [[nodiscard]] bool empty() const { return seen_.empty() && !judges_z_ && !lengths_ && !is_floating_; }
    // The channels to look at: bit c is set for channel c.
    [[nodiscard]] bool wants(int channel) const;

    // Whether add_row() does anything with row j.
    [[nodiscard]] bool wants_row(int j) const {
        return !seen_.empty() || lengths_ || is_floating_ || (judges_z_ && j % z_step_ == 0);
    }

    // Adds row j: its channels, of which those that are not wanted and hold no normals may be null, and its normals.
    // Rows may come in any order, from any thread.
    void add_row(int j, const float* const (&channels)[4], const VectorRow& normals, int width);

    // To be called after all rows: says what was found, and returns the channels.
    [[nodiscard]] std::vector<ExtraChannel> report(SourceInfo& info) const;

private:
    struct Seen {
        int channel;
        float least, greatest;
        float off_x, off_y, off_z;  // the greatest difference from the channels of x and y, and from z as a code
    };
    void count_not_finite(const float* const (&channels)[4], int width);
    void look_at_lengths(const float* const (&channels)[4], int width);
    void look(Seen& seen, const float* const (&channels)[4], const VectorRow& normals, int width) const;

    [[nodiscard]] std::vector<ExtraChannel> found() const;

    const Sources sources_;
    const bool is_floating_;
    const bool judges_z_;  // it is stored as a whole number
    const bool is_unsigned_;
    const int z_step_;  // distance between the rows whose z is judged
    const bool lengths_;
    mutable std::mutex mutex_;
    std::vector<Seen> seen_;
    float shortest_ = std::numeric_limits<float>::infinity(), longest_ = 0.0f;  // what the lengths hold
    ZEvidence z_;
    std::atomic<std::int64_t> not_finite_{0};
};

// The channels without these.
[[nodiscard]] std::vector<ExtraChannel> left_out(std::vector<ExtraChannel> channels, ExtraSet accounted_for);

}  // namespace tex::inline v1
