// SPDX-License-Identifier: Apache-2.0
// gathering_writer.h: strips to files that are encoded as a whole.

#pragma once

#include <vector>

#include "stream/strip_writer.h"

namespace tex {

// Strips come in any order, and wait, packed.
class GatheringWriter final : public StripWriter {
public:
    // `names` and `options` must outlive this. May throw std::bad_alloc.
    GatheringWriter(const OutputNames& names, Container container, StripPacking packing, const WriteOptions& options);

    [[nodiscard]] bool is_in_order(const Strip&) const override { return false; }
    Result<void> write(Strip& strip) override;
    Result<void> commit() override;
    [[nodiscard]] std::size_t file_bytes() const override { return bytes_; }

private:
    const OutputNames names_;
    const Container container_;
    const StripPacking packing_;
    const WriteOptions& options_;
    std::vector<Level> levels_;
    std::size_t bytes_ = 0;
};

}  // namespace tex
