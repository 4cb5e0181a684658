// SPDX-License-Identifier: Apache-2.0
// strip_writer.h: strips of normals to their places in a file.

#pragma once

#include <memory>
#include <string>

#include <tex/container.h>
#include <tex/pack.h>

#include "pipeline/strips.h"

namespace tex {

class StripWriter {
public:
    StripWriter() = default;
    StripWriter(const StripWriter&) = delete;
    StripWriter& operator=(const StripWriter&) = delete;
    virtual ~StripWriter() = default;

    // Opens the output and writes what stands before the texels. Precondition: takes_strips(). Errors: io, out_of_memory; unsupported (the container cannot hold
    // the encoding).
    static Result<std::unique_ptr<StripWriter>> open(const std::string& path, Container container, Extent extent, int levels,
                                                     const PackOptions& pack, const WriteOptions& options);

    // Strips are to come from the top, one at a time; else in any order, from several threads at once.
    [[nodiscard]] virtual bool is_in_order() const = 0;

    // Packs a whole strip and puts it into its place. Errors: io, out_of_memory.
    virtual Result<void> write(Strip& strip) = 0;

    // After the last strip: the file appears. Errors: io, out_of_memory.
    virtual Result<void> commit() = 0;

    [[nodiscard]] virtual std::size_t file_bytes() const = 0;
};

// DDS and KTX2, whose strips come in any order.
[[nodiscard]] bool is_texture(Container container);

// Whether files of this kind, with so many levels, are written strip by strip: DDS, KTX2, and those that takes_rows() knows, in order.
[[nodiscard]] bool takes_strips(Container container, int levels);

}  // namespace tex
