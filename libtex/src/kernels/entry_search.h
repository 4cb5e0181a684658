// SPDX-License-Identifier: Apache-2.0
// entry_search.h: which entries of a block of BC7 or UASTC (blocks/block_entries.h) are closest to other texels
// (rate-distortion optimisation, rows/rdo_rgb_pass.h).

#pragma once

namespace tex::inline v1 {

// Vectors of four components: those of a unit vector, and twice alpha (from 0 to 1).
inline constexpr int kEntryComponents = 4;

// A distance that says that a texel cannot have an entry.
inline constexpr float kNoEntry = 1e9f;

struct EntrySearch {
    const float (*texels)[16];   // [component][texel]
    const float (*entries)[32];  // [component][entry]
    int count;                   // of entries
    // For each entry, the row of `distances` that says which texels can have it: 0 or kNoEntry.
    const unsigned char* row;
    const float (*distances)[16];
};

// The squared distance from each texel to the closest entry that it can have, and its number.
void closest_entries(const EntrySearch& search, float squares[16], float numbers[16]);

// The squared distances between texels.
void squared_distances(const float (*texels)[16], const float (*others)[16], float squares[16]);

}  // namespace tex::inline v1
