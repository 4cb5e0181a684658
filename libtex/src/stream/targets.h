// SPDX-License-Identifier: Apache-2.0
// targets.h: the files that rows of levels go to, each packed in its own way.

#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <tex/pipeline.h>

#include "kernels/unpack.h"
#include "stream/level_writer.h"

namespace tex::inline v1 {

// How stored vectors get unit length.
struct UnitRule {
    UnpackRule rule;
    bool has_z = true;  // z was stored
};

// A file that normals go to. What it refers to must outlive it.
struct FileTarget {
    const std::string& output;
    const LevelNames& level_names;
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

// What any of the files, or all of them, can hold beside the normals.
[[nodiscard]] ExtraSet held_by_any(const std::vector<FileTarget>& targets);
[[nodiscard]] ExtraSet held_by_all(const std::vector<FileTarget>& targets);

// Whether all levels are written, rather than the base level alone.
[[nodiscard]] bool holds_levels(Container container, const LevelNames& names);
// Whether any of the files holds more than the base level.
[[nodiscard]] bool any_holds_levels(Container container, const LevelNames& names, const std::vector<MoreFile>& more);
// Whether all of the files take rows in any order: DDS, KTX2.
[[nodiscard]] bool all_take_any_order(Container container, const std::vector<MoreFile>& more);

// All files of a run.
class Targets {
public:
    // Opens files for normals, and for these data beside them where a file can hold them. Rows of levels that a file
    // does not hold are not written to it. Errors: those of LevelWriter::open().
    Result<void> open(const std::vector<FileTarget>& targets, ExtraSet extras, Extent extent, int levels);
    // Opens a file for an extra channel of the rows of normals.
    Result<void> open(const ExtraFile& file, Extra extra, const WriteOptions& write, Extent extent, int levels);
    // Opens a file, or files, for roughness. `kept` is as in packing_of().
    Result<void> open(const RoughnessFile& file, const KeptChannels* kept, const WriteOptions& write, Extent extent,
                      int levels);

    // If true, rows of this level must come one strip at a time, from the top. If false, they may come in any order,
    // from several threads at once.
    [[nodiscard]] bool is_in_order(Content content, int level) const;
    // Strips consist of this many rows, or a multiple; only the last one of a level may end within them.
    [[nodiscard]] int rows_together() const;
    // Packs rows and writes them to their places. Errors: io, out_of_memory.
    Result<void> write(const LevelRows& rows);
    // To be called after the last rows. The files appear one after the other, in the order in which they were opened;
    // if one fails, those after it do not appear. Errors: io, out_of_memory.
    Result<void> commit();

    // To be called after commit(): the sum over all files, and what optimisation has done to the first file whose
    // blocks are optimised.
    [[nodiscard]] std::size_t bytes(Content content) const;
    [[nodiscard]] std::optional<RdoReport> rdo() const { return rdo_; }

private:
    struct Member {
        std::unique_ptr<LevelWriter> writer;
        Content content;
        int first;  // levels [first, end)
        int end;
        std::size_t bytes = 0;

        [[nodiscard]] bool takes(Content its_content, int level) const {
            return content == its_content && first <= level && level < end;
        }
    };
    Result<void> add(Content content, const std::string& output, const LevelNames& names, Container container,
                     LevelPacking packing, const WriteOptions& options, Opened when);

    std::vector<Member> members_;
    std::optional<RdoReport> rdo_;
};

}  // namespace tex::inline v1
