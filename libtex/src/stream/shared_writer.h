// SPDX-License-Identifier: Apache-2.0
// shared_writer.h: writes the same strips to several files, each packed in its own way.

#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tex/pipeline.h>

#include "kernels/unpack.h"
#include "stream/strip_writer.h"

namespace tex {

// How stored vectors get unit length.
struct UnitRule {
    UnpackRule rule;
    bool has_z = true;  // z was stored
};

// A file that normals go to. What it refers to must outlive it.
struct FileTarget {
    OutputNames names;
    Container container;
    PackOptions pack;
    const WriteOptions& write;
    int levels = 0;                     // as in MoreFile
    std::optional<UnitRule> unit = {};  // set: the rows hold vectors as they are stored, and get unit length here
};

// Adds the files of `more`. `source` describes the normals.
void add_targets(const std::vector<MoreFile>& more, const SourceInfo& source, std::vector<FileTarget>& targets);

// How a file is packed if `pack` may be empty.
PackOptions packing_for(const std::function<PackOptions(const SourceInfo&)>& pack, Container container,
                        const SourceInfo& source);

// Whether any of the files holds more than the base level.
[[nodiscard]] bool any_holds_levels(Container container, const LevelNames& names, const std::vector<MoreFile>& more);
// Whether all of the files take strips in any order.
[[nodiscard]] bool all_take_any_order(Container container, const std::vector<MoreFile>& more);

// Opens all files. Strips of levels that a file does not hold are not written to it. The files appear in their order;
// if one fails, those after it do not appear. Errors: those of StripWriter::open().
Result<std::unique_ptr<StripWriter>> open_targets(const std::vector<FileTarget>& targets, Extent extent, int levels);

}  // namespace tex
