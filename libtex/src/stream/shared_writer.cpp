// SPDX-License-Identifier: Apache-2.0

#include "stream/shared_writer.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

namespace tex {
namespace {

class SharedWriter final : public StripWriter {
public:
    struct Member {
        std::unique_ptr<StripWriter> writer;
        int levels;
    };
    explicit SharedWriter(std::vector<Member> members) : members_(std::move(members)) {}

    // If one file needs strips in order, all get them in order.
    [[nodiscard]] bool is_in_order(const Strip& strip) const override {
        return std::any_of(members_.begin(), members_.end(), [&](const Member& member) {
            return strip.level < member.levels && member.writer->is_in_order(strip);
        });
    }
    [[nodiscard]] int block_rows() const override {
        int rows = 1;
        for (const Member& member : members_) rows = std::lcm(rows, member.writer->block_rows());
        return rows;
    }
    Result<void> write(Strip& strip) override {
        for (Member& member : members_) {
            if (strip.level >= member.levels) continue;
            if (Result<void> done = member.writer->write(strip); !done) return done;
        }
        return {};
    }
    Result<void> commit() override {
        for (Member& member : members_) {
            if (Result<void> done = member.writer->commit(); !done) return done;
            bytes_ += member.writer->file_bytes();
            if (!rdo_) rdo_ = member.writer->rdo();
            member.writer.reset();
        }
        return {};
    }
    [[nodiscard]] std::size_t file_bytes() const override { return bytes_; }
    [[nodiscard]] std::optional<RdoReport> rdo() const override { return rdo_; }

private:
    std::vector<Member> members_;
    std::size_t bytes_ = 0;
    std::optional<RdoReport> rdo_;
};

// Gives vectors unit length before they are packed: in a copy, because the strip goes to other files, too.
void pack_units(StripPacking& packing, const UnitRule& unit) {
    packing.pack = [unit, pack = std::move(packing.pack)](const Strip& strip, std::byte* out) {
        const NormalMap& from = strip.map;
        Strip units{strip.content, strip.level, strip.first, strip.height, strip.filled, NormalMap(from.extent()), {}};
        NormalMap& to = units.map;
        for (int j = 0; j < strip.height; ++j) {
            unpack_row(from.x.row(j), from.y.row(j), unit.has_z ? from.z.row(j) : nullptr, unit.rule,
                       from.extent().width, to.x.row(j), to.y.row(j), to.z.row(j));
        }
        pack(units, out);
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
        targets.push_back({{file.output, file.level_names},
                           file.container,
                           packing_for(file.pack, file.container, source),
                           file.write,
                           file.levels});
    }
}

bool any_holds_levels(Container container, const LevelNames& names, const std::vector<MoreFile>& more) {
    return holds_levels(container, names) || std::any_of(more.begin(), more.end(), [](const MoreFile& file) {
               return holds_levels(file.container, file.level_names);
           });
}

bool all_take_any_order(Container container, const std::vector<MoreFile>& more) {
    return takes_any_order(container) &&
           std::all_of(more.begin(), more.end(), [](const MoreFile& file) { return takes_any_order(file.container); });
}

Result<std::unique_ptr<StripWriter>> open_targets(const std::vector<FileTarget>& targets, Extent extent, int levels) {
    std::vector<SharedWriter::Member> members;
    for (const FileTarget& target : targets) {
        int held = holds_levels(target.container, target.names.of_level) ? levels : 1;
        if (target.levels > 0) held = std::min(held, target.levels);
        StripPacking packing = packing_of(target.pack, extent, held);
        if (target.unit) pack_units(packing, *target.unit);
        Result<std::unique_ptr<StripWriter>> writer =
            StripWriter::open(target.names, target.container, std::move(packing), target.write);
        if (!writer || targets.size() == 1) return writer;
        members.push_back({std::move(*writer), held});
    }
    return std::unique_ptr<StripWriter>(std::make_unique<SharedWriter>(std::move(members)));
}

}  // namespace tex
