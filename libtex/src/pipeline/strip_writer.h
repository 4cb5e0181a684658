// SPDX-License-Identifier: Apache-2.0
// strip_writer.h: strips of normals to their places in a DDS or KTX2 file.

#pragma once

#include <string>

#include <tex/container.h>
#include <tex/pack.h>

#include "base/atomic_file.h"
#include "containers/file_layout.h"
#include "pipeline/strips.h"

namespace tex {

class StripWriter {
public:
    // Opens the output and writes what stands before the levels. `container` is dds or ktx2. Errors: io, out_of_memory.
    static Result<StripWriter> open(const std::string& path, Container container, Extent extent, int levels,
                                    const PackOptions& pack, const WriteOptions& options);

    // Packs a whole strip and puts it into its place. Several threads may call at once, with different strips. Errors: io, out_of_memory.
    Result<void> write(Strip& strip);

    // After the last strip: the file appears. Errors: io, out_of_memory.
    Result<void> commit() { return file_.commit(); }

    [[nodiscard]] std::size_t file_bytes() const { return layout_.size; }

private:
    StripWriter(AtomicFile file, FileLayout layout, const PackOptions& pack);

    AtomicFile file_;
    FileLayout layout_;
    PackOptions pack_;
};

}  // namespace tex
