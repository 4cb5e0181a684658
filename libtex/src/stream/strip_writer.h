// SPDX-License-Identifier: Apache-2.0
// strip_writer.h: writes strips of normals to their places in a file.

#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <tex/container.h>
#include <tex/pack.h>
#include <tex/pipeline.h>

#include "blocks/extent.h"
#include "files/output_file.h"
#include "formats/file_layout.h"
#include "rows/rdo_rows.h"
#include "stream/strips.h"

namespace tex {

// Where levels go: all into `output`, or each into its own file if of_level is set.
struct OutputNames {
    const std::string& output;
    const LevelNames& of_level;
};

// How strips are packed into texels.
struct StripPacking {
    TextureHead head;
    std::function<void(const Strip& strip, std::byte* out)> pack;
    int rows_together = 1;            // strips consist of so many rows of texels, or of whole blocks
    std::shared_ptr<RdoTally> tally;  // of blocks that are optimised; otherwise null
};
StripPacking packing_of(const PackOptions& options, Extent extent, int levels);
StripPacking packing_of(const RoughnessFile& options, Extent extent, int levels);

class StripWriter {
public:
    StripWriter() = default;
    StripWriter(const StripWriter&) = delete;
    StripWriter& operator=(const StripWriter&) = delete;
    virtual ~StripWriter() = default;

    // Opens the output and writes what comes before the texels. Errors: io, out_of_memory; unsupported (the container
    // cannot hold the encoding, or this number of levels).
    static Result<std::unique_ptr<StripWriter>> open(const OutputNames& names, Container container,
                                                     StripPacking packing, const WriteOptions& options,
                                                     Opened when = Opened::at_once);

    // Passes strips to one of two writers, depending on their content. Files of roughness appear after those of
    // normals.
    static std::unique_ptr<StripWriter> pair(std::unique_ptr<StripWriter> normals,
                                             std::unique_ptr<StripWriter> roughness);

    // If true, strips with this content and level must come one at a time, preferably from the top. If false, they may
    // come in any order, from several threads at once.
    [[nodiscard]] virtual bool is_in_order(const Strip& strip) const = 0;

    // Strips consist of rows of blocks with this many rows of texels. Only the last strip of a level may end within
    // one.
    [[nodiscard]] virtual int block_rows() const { return kBlockEdge; }

    // Packs a whole strip and writes it to its place. Errors: io, out_of_memory.
    virtual Result<void> write(Strip& strip) = 0;

    // To be called after the last strip. The file appears, or the files appear one after the other. Errors: io,
    // out_of_memory.
    virtual Result<void> commit() = 0;

    [[nodiscard]] virtual std::size_t file_bytes() const = 0;
    [[nodiscard]] virtual std::size_t roughness_bytes() const { return 0; }
    // What optimisation has done to the first file whose blocks are optimised. To be called after commit().
    [[nodiscard]] virtual std::optional<RdoReport> rdo() const { return std::nullopt; }
};

// Whether strips may be written in any order: DDS, KTX2.
[[nodiscard]] bool takes_any_order(Container container);

// Whether all levels are written, rather than the base level alone.
[[nodiscard]] bool holds_levels(Container container, const LevelNames& names);

}  // namespace tex
