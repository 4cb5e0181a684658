// SPDX-License-Identifier: Apache-2.0
// level_writer.h: writes rows of levels to their places in a file.

#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tex/file.h>
#include <tex/pack.h>
#include <tex/pipeline.h>

#include "blocks/extent.h"
#include "files/output_file.h"
#include "formats/file_layout.h"
#include "rows/extra_rows.h"
#include "rows/rdo_rows.h"
#include "rows/roughness_rows.h"

namespace tex::inline v1 {

enum class Content { normals, roughness };

// Consecutive rows of a level of the file. They begin at row `first`, which is the first row of a row of blocks.
struct LevelRows {
    Content content;
    int level;
    int first;
    int height;
    const NormalMap& map;             // rows 0 to height - 1, with room for whole blocks; roughness uses x alone
    std::vector<std::byte>& scratch;  // room for the code that packs the rows
};

// How rows are packed into texels.
struct LevelPacking {
    TextureHead head;
    // If blocks are optimised, `plain` gets them as they are without that, unless it is null.
    std::function<void(const LevelRows& rows, std::byte* out, std::byte* plain)> pack;
    int rows_together = 1;                // strips consist of so many rows of texels, or of whole blocks
    std::shared_ptr<RdoTallies> tallies;  // of blocks that are optimised; otherwise null
};
LevelPacking packing_of(const PackOptions& options, ExtraSet extras, Extent extent, int levels);
LevelPacking packing_of(const ExtraFile& options, Extra extra, Extent extent, int levels);
// `kept` must outlive the packing; null if nothing is kept. Precondition: options.format is set.
LevelPacking packing_of(const RoughnessFile& options, const KeptChannels* kept, Extent extent, int levels);

class LevelWriter {
public:
    LevelWriter() = default;
    LevelWriter(const LevelWriter&) = delete;
    LevelWriter& operator=(const LevelWriter&) = delete;
    virtual ~LevelWriter() = default;

    // Opens the output, which begins with level `first`, and writes what comes before the texels. Errors: io,
    // out_of_memory; unsupported (the container cannot hold the encoding, or this number of levels).
    static Result<std::unique_ptr<LevelWriter>> open(const std::string& path, Container container,
                                                     const LevelPacking& packing, int first,
                                                     const WriteOptions& options, Opened when);

    // See Targets::is_in_order(), rows_together() and write().
    [[nodiscard]] virtual bool is_in_order() const = 0;
    [[nodiscard]] virtual int rows_together() const { return kBlockEdge; }
    virtual Result<void> write(const LevelRows& rows) = 0;

    // To be called after the last rows: the file appears. Errors: io, out_of_memory.
    virtual Result<void> commit() = 0;

    // To be called after commit().
    [[nodiscard]] virtual std::size_t file_bytes() const = 0;
    [[nodiscard]] virtual std::optional<RdoReport> rdo() const { return std::nullopt; }
};

// Whether rows may be written in any order: DDS, KTX2.
[[nodiscard]] bool takes_any_order(Container container);

}  // namespace tex::inline v1
