// SPDX-License-Identifier: Apache-2.0
// joined_rows.h: several pictures of one extent, read in step as one picture that has the planes of all of them.

#pragma once

#include <string>
#include <vector>

#include "formats/row_source.h"

namespace tex {

class JoinedRows final : public RowSource {
public:
    struct Member {
        RowSource* rows;
        const std::string* path;  // for messages
    };

    // All members have this extent and must outlive this object. Without members, the rows have no planes.
    JoinedRows(Extent extent, std::vector<Member> members);

    [[nodiscard]] int rows_together() const override { return together_; }
    [[nodiscard]] int block_rows() const override { return block_rows_; }
    [[nodiscard]] bool is_random() const override { return random_; }
    [[nodiscard]] bool can_peek() const override { return false; }
    Result<void> decode(int first, int count, std::byte* rows) override;
    Result<void> finish() override;
    void store(const std::byte* rows, int first, int end, Image& image) const override;

private:
    const std::vector<Member> members_;
    int together_ = 1;
    int block_rows_ = 1;
    bool random_ = false;
};

}  // namespace tex
