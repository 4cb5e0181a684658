// SPDX-License-Identifier: Apache-2.0

#include "stream/joined_rows.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include "blocks/extent.h"

namespace tex {
namespace {

// The bytes of `count` rows and of the extra rows that a decoder may write with them.
std::size_t room(const RowSource& rows, int count) {
    return rows.row_bytes() * static_cast<std::size_t>(rows.held_rows(count));
}

}  // namespace

JoinedRows::JoinedRows(Extent extent, std::vector<Member> members) : members_(std::move(members)) {
    std::vector<std::string> names;
    std::size_t row_bytes = 0;
    random_ = !members_.empty();
    for (const Member& member : members_) {
        names.insert(names.end(), member.rows->names().begin(), member.rows->names().end());
        row_bytes += member.rows->row_bytes();
        together_ = std::lcm(together_, member.rows->rows_together());
        block_rows_ = std::lcm(block_rows_, member.rows->block_rows());
        random_ = random_ && member.rows->is_random();
    }
    describe(extent, std::move(names), row_bytes);
}

Result<void> JoinedRows::decode(int first, int count, std::byte* rows) {
    for (const Member& member : members_) {
        const Result<void> done = member.rows->decode(first, count, rows);
        if (!done) return done.error().of(*member.path);
        rows += room(*member.rows, count);
    }
    return {};
}

Result<void> JoinedRows::finish() {
    for (const Member& member : members_) {
        if (const Result<void> done = member.rows->finish(); !done) return done.error().of(*member.path);
    }
    return {};
}

void JoinedRows::store(const std::byte* rows, int first, int end, Image& image) const {
    auto plane = image.planes.begin();
    for (const Member& member : members_) {
        const auto last = plane + static_cast<std::ptrdiff_t>(member.rows->names().size());
        Image part;
        part.planes.assign(std::make_move_iterator(plane), std::make_move_iterator(last));
        member.rows->store(rows, first, end, part);
        std::move(part.planes.begin(), part.planes.end(), plane);
        plane = last;
        rows += room(*member.rows, end - first);
    }
}

}  // namespace tex
