// SPDX-License-Identifier: Apache-2.0

#include "stream/targets.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include <tex/types.h>

#include "rows/extra_rows.h"
#include "rows/pack_rows.h"

namespace tex::inline v1 {
namespace {

// A view of the plane, which keeps no memory. It is only read.
Plane<float> view_of(const Plane<float>& plane) {
    if (plane.empty()) return {};
    return {plane.extent(), plane.stride(),
            std::shared_ptr<float>(std::shared_ptr<void>(), const_cast<float*>(plane.row(0)))};
}

// Gives vectors unit length before they are packed: in a copy, because the rows go to other files, too.
void pack_units(LevelPacking& packing, const UnitRule& unit) {
    packing.pack = [unit, pack = std::move(packing.pack)](const LevelRows& rows, std::byte* out, std::byte* plain) {
        const NormalMap& from = rows.map;
        NormalMap to(from.extent());
        for (const Extra extra : kExtras) to[extra] = view_of(from[extra]);
        for (int j = 0; j < rows.height; ++j) {
            unpack_row(from.x.row(j), from.y.row(j), unit.has_z ? from.z.row(j) : nullptr, unit.rule,
                       from.extent().width, to.x.row(j), to.y.row(j), to.z.row(j));
        }
        pack({rows.content, rows.level, rows.first, rows.height, to, rows.scratch}, out, plain);
    };
}

}  // namespace

PackOptions packing_for(const std::function<PackOptions(const SourceInfo&)>& pack, Container container,
                        const SourceInfo& source) {
    if (pack) return pack(source);
    PackOptions options;
    options.encoding = default_encoding(container);
    options.y_axis = source.y_axis;
    options.y_known = source.y_known;
    return options;
}

void add_targets(const std::vector<MoreFile>& more, const SourceInfo& source, std::vector<FileTarget>& targets) {
    for (const MoreFile& file : more) {
        targets.push_back({file.output, file.level_names, file.container,
                           packing_for(file.pack, file.container, source), file.write, file.levels});
    }
}

ExtraSet held_by_any(const std::vector<FileTarget>& targets) {
    ExtraSet held;
    for (const FileTarget& target : targets) held = held | can_hold(target.pack.encoding);
    return held;
}

ExtraSet held_by_all(const std::vector<FileTarget>& targets) {
    ExtraSet held{true, true, true};
    for (const FileTarget& target : targets) held = held & can_hold(target.pack.encoding);
    return held;
}

bool holds_levels(Container container, const LevelNames& names) { return names || can_hold_levels(container); }

bool any_holds_levels(Container container, const LevelNames& names, const std::vector<MoreFile>& more) {
    return holds_levels(container, names) || std::any_of(more.begin(), more.end(), [](const MoreFile& file) {
               return holds_levels(file.container, file.level_names);
           });
}

bool all_take_any_order(Container container, const std::vector<MoreFile>& more) {
    return takes_any_order(container) &&
           std::all_of(more.begin(), more.end(), [](const MoreFile& file) { return takes_any_order(file.container); });
}

Result<void> Targets::add(Content content, const std::string& output, const LevelNames& names, Container container,
                          LevelPacking packing, const WriteOptions& options, Opened when) {
    const int levels = packing.head.levels;
    if (!names) {
        Result<std::unique_ptr<LevelWriter>> writer =
            LevelWriter::open(output, container, std::move(packing), 0, options, when);
        if (!writer) return writer.error();
        members_.push_back({std::move(*writer), content, 0, levels});
        return {};
    }
    const Extent extent = packing.head.extent;
    packing.head.levels = 1;
    for (int k = 0; k < levels; ++k) {
        packing.head.extent = level_extent(extent, k);
        Result<std::unique_ptr<LevelWriter>> writer =
            LevelWriter::open(names(k), container, packing, k, options, k == 0 ? when : Opened::late);
        if (!writer) return writer.error();
        members_.push_back({std::move(*writer), content, k, k + 1});
    }
    return {};
}

Result<void> Targets::open(const std::vector<FileTarget>& targets, ExtraSet extras, Extent extent, int levels) {
    for (const FileTarget& target : targets) {
        int held = holds_levels(target.container, target.level_names) ? levels : 1;
        if (target.levels > 0) held = std::min(held, target.levels);
        LevelPacking packing = packing_of(target.pack, extras, extent, held);
        if (target.unit) pack_units(packing, *target.unit);
        Result<void> added = add(Content::normals, target.output, target.level_names, target.container,
                                 std::move(packing), target.write, Opened::at_once);
        if (!added) return added;
    }
    return {};
}

Result<void> Targets::open(const RoughnessFile& file, const KeptChannels* kept, const WriteOptions& write,
                           Extent extent, int levels) {
    WriteOptions options = write;
    options.zstd = can_compress(file.container) ? file.zstd.value_or(write.zstd) : 0;
    return add(Content::roughness, file.output, file.level_names, file.container,
               packing_of(file, kept, extent, levels), options, Opened::late);
}

Result<void> Targets::open(const ExtraFile& file, Extra extra, const WriteOptions& write, Extent extent, int levels) {
    WriteOptions options = write;
    if (!can_compress(file.container)) options.zstd = 0;
    const int held = can_hold_levels(file.container) ? levels : 1;
    return add(Content::normals, file.output, {}, file.container, packing_of(file, extra, extent, held), options,
               Opened::late);
}

bool Targets::is_in_order(Content content, int level) const {
    return std::any_of(members_.begin(), members_.end(), [&](const Member& member) {
        return member.takes(content, level) && member.writer->is_in_order();
    });
}

int Targets::rows_together() const {
    int rows = 1;
    for (const Member& member : members_) rows = std::lcm(rows, member.writer->rows_together());
    return rows;
}

Result<void> Targets::write(const LevelRows& rows) {
    for (Member& member : members_) {
        if (!member.takes(rows.content, rows.level)) continue;
        if (Result<void> done = member.writer->write(rows); !done) return done;
    }
    return {};
}

// Each file is closed before the next one appears.
Result<void> Targets::commit() {
    for (Member& member : members_) {
        if (Result<void> done = member.writer->commit(); !done) return done;
        member.bytes = member.writer->file_bytes();
        if (!rdo_) rdo_ = member.writer->rdo();
        member.writer.reset();
    }
    return {};
}

std::size_t Targets::bytes(Content content) const {
    std::size_t bytes = 0;
    for (const Member& member : members_) bytes += member.content == content ? member.bytes : 0;
    return bytes;
}

}  // namespace tex::inline v1
