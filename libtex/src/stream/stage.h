// SPDX-License-Identifier: Apache-2.0
// stage.h: the stages through which rows go from sources to targets (see flow.h), and the strips that they hand over.

#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <tex/format.h>
#include <tex/types.h>

#include "kernels/normal_row.h"
#include "rows/extra_rows.h"
#include "threads/pool.h"

namespace tex::inline v1 {

// The planes of a strip of normals after x, y and z are extra channels, in the order of Extra.
inline constexpr int kFirstExtraPlane = 3;
[[nodiscard]] constexpr int plane_of(Extra extra) { return kFirstExtraPlane + static_cast<int>(extra); }

// Consecutive rows that a stage has made. Which of the members it uses is up to the stage.
struct Strip {
    int first = 0;   // its first row
    int height = 0;  // the number of its rows
    Image image;     // the values that a file stores, a plane for each channel
    NormalMap map;   // otherwise: x, y, z, alpha, blue, length
    std::vector<std::byte> bytes;

    // Row k of the strip.
    [[nodiscard]] float* row(int plane, int k) {
        if (!image.planes.empty()) return image.planes[static_cast<std::size_t>(plane)].row(k);
        if (plane >= kFirstExtraPlane) return map[static_cast<Extra>(plane - kFirstExtraPlane)].row(k);
        return (plane == 0 ? map.x : plane == 1 ? map.y : map.z).row(k);
    }
    [[nodiscard]] NormalRow normals(int k) { return {map.x.row(k), map.y.row(k), map.z.row(k)}; }
};

class Stage;

// Rows [first, end) of another stage.
struct Need {
    const Stage* stage;
    int first;
    int end;
};

// Makes rows [begin, height) of a picture, in strips. A stage says how far it reaches: which rows of the stages before
// it a strip is made from. Strips are made by any thread and in any order, unless the stage is in_order().
class Stage {
public:
    // `level`: a strip has as many rows as are made, `level` levels below another picture, of one strip of that one.
    Stage(Extent extent, int planes, int level = 0, int begin = 0)
        : extent_(extent), planes_(planes), extras_(extras_with([=](Extra extra) { return planes > plane_of(extra); })),
          level_(level), begin_(begin) {}
    // A stage that makes normals, and these data beside them.
    Stage(Extent extent, ExtraSet extras, int level = 0)
        : extent_(extent), planes_(3), extras_(extras), level_(level), begin_(0) {}
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;
    virtual ~Stage() = default;

    [[nodiscard]] Extent extent() const { return extent_; }
    [[nodiscard]] ExtraSet extras() const { return extras_; }
    [[nodiscard]] int level() const { return level_; }
    [[nodiscard]] int begin() const { return begin_; }

    // What this stage has made. Precondition: needs() of the stage that asks has named the row, or the strip.
    [[nodiscard]] Strip& strip_of(int j) const { return *made_[static_cast<std::size_t>((j - begin_) / strip_rows_)]; }
    [[nodiscard]] const float* row(int plane, int j) const {
        Strip& strip = strip_of(j);
        return strip.row(plane, j - strip.first);
    }
    [[nodiscard]] VectorRow normals(int j) const { return {row(0, j), row(1, j), row(2, j)}; }

    // What rows [first, end) are made from.
    [[nodiscard]] virtual std::vector<Need> needs(int first, int end) const = 0;
    // Makes the rows of the strip: strip.first and strip.height are set. May throw std::bad_alloc.
    virtual Result<void> make(Strip& strip) = 0;
    // Whether a strip is made only after the one before it.
    [[nodiscard]] virtual bool in_order() const { return false; }
    // Whether the stage reads rows, which must not get far ahead of the stages after it.
    [[nodiscard]] virtual bool reads() const { return false; }
    // Whether the stage goes on when a stage has found that no result can be made: it only counts.
    [[nodiscard]] virtual bool counts() const { return false; }
    // To be called after the last strip. Errors: bad_data.
    [[nodiscard]] virtual Result<void> check() const { return {}; }

protected:
    // The rows of a strip, if a strip of a picture of this width has `texels` texels, and strips consist of `together`
    // rows or a multiple.
    [[nodiscard]] virtual int choose_strip_rows(int texels, int together) const;
    // An empty strip with room for so many rows.
    [[nodiscard]] virtual std::unique_ptr<Strip> new_strip(int rows) const;

private:
    friend class FlowPlan;
    friend class FlowRun;

    const Extent extent_;
    const int planes_;
    const ExtraSet extras_;
    const int level_;
    const int begin_;
    std::size_t line_ = 0;  // its place in the flow
    int strip_rows_ = 1;
    int held_rows_ = 1;                         // the room of a strip
    std::vector<std::shared_ptr<Strip>> made_;  // strips that somebody still needs
    Pool<Strip> pool_;
};

}  // namespace tex::inline v1
