// SPDX-License-Identifier: Apache-2.0

#include "stream/pack_stream.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <tex/file.h>
#include <tex/format.h>
#include <tex/types.h>

#include "rows/mip_rows.h"
#include "rows/usable.h"
#include "stream/given_extras.h"
#include "stream/level_stage.h"
#include "stream/map_inspector.h"
#include "stream/material_roughness.h"
#include "stream/settled_map.h"
#include "stream/targets.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

// The order in which they are written apart.
constexpr Extra kApartOrder[] = {Extra::blue, Extra::alpha, Extra::length};

// The format, or the same with alpha, whichever the container can hold.
Format format_with_room(Format format, Container container) {
    if (can_hold(container, format)) return format;
    const FormatInfo info = format_info(format);
    return format_of(info.sample, info.bits, 4).value_or(format);
}

class PackRun {
public:
    PackRun(MapSource& map, const std::string& output, Container container, const PackFileOptions& options,
            const Execution& execution, const StreamSizes& sizes)
        : map_(map, options.source), output_(output), container_(container), options_(options), execution_(execution),
          sizes_(sizes), mip_(options.mip) {}

    Result<PackFileReport> run();

private:
    Result<void> prepare();
    void choose_level();
    void settle_lengths();
    Result<void> settle_extras();
    [[nodiscard]] ExtraSet apart() const {
        return extras_with([this](Extra extra) { return options_.apart[extra].has_value(); });
    }
    [[nodiscard]] ExtraSet accounted_for() const;
    Result<void> find_own_roughness();
    Result<void> find_kept_channels();
    Result<void> open_targets();
    Result<void> pack_level(int level, const Execution& execution);
    [[nodiscard]] int roughness_levels() const {
        const RoughnessFile& file = *options_.roughness;
        return holds_levels(file.container, file.level_names) ? levels_to_build(*mip_, extent(first_)) : 1;
    }
    [[nodiscard]] Extent extent(int level) const { return map_.map().extent(level); }
    [[nodiscard]] MadeLevels made_levels(int level, int count) const {
        return {level - first_ - left_out_, count, counted_from_base(mip_.value_or(MipOptions()), left_out_),
                kept_ | written_};
    }

    SettledMap map_;
    const std::string& output_;
    const Container container_;
    const PackFileOptions& options_;
    const Execution& execution_;
    const StreamSizes& sizes_;
    std::optional<MipOptions> mip_;
    Plane<float> roughness_map_;  // RoughnessFile::map
    std::optional<MaterialRoughness> own_;
    std::optional<KeptChannels> beside_roughness_;
    GivenExtras given_;
    ExtraSet written_;       // what files of normals get beside them
    ExtraSet kept_;          // what of the source goes along: into these files, or into its own
    bool in_codes_ = false;  // lengths stay as they are, with what they hold
    int first_ = 0;          // the level that becomes the base level
    int end_ = 1;            // the end of the levels that are read
    int left_out_ = 0;       // levels that are built and not written
    std::vector<FileTarget> files_;
    Targets targets_;
    PackFileReport report_;
};

// Whether a file of this encoding can have the codes of a file of `format`, whose z is stored or not.
bool can_keep_codes(Format format, bool has_z, Encoding encoding) {
    const auto [to, swizzle] = encoding_info(encoding);
    const bool keeps_z = !has_z || std::find(swizzle.begin(), swizzle.end(), Component::z) != swizzle.end();
    const FormatInfo a = format_info(format), b = format_info(to);
    if (a.has_blocks() || b.has_blocks()) return format == to && keeps_z;
    return a.sample == b.sample && a.bits == b.bits && keeps_z;
}

// Finds out what to read and what to write. Errors: those of options that do not fit the file.
Result<void> PackRun::prepare() {
    report_.source = map_.info();
    const int held = map_.map().levels();
    first_ = options_.level.value_or(0);
    if (first_ >= held) {
        return Error{ErrorCode::bad_option, map_.map().path(),
                     "has no level " + std::to_string(first_) + ", only " + std::to_string(held)};
    }
    if (!mip_) choose_level();
    const bool holds = any_holds_levels(container_, options_.level_names, options_.more);
    end_ = options_.level || mip_ || !holds ? first_ + 1 : held;
    const Extent base = extent(first_);
    if (mip_) left_out_ = first_level(*mip_, base);
    report_.extent = level_extent(base, left_out_);
    report_.left_out = first_ - options_.level.value_or(0) + left_out_;
    report_.pack = packing_for(options_.pack, container_, report_.source);
    files_.push_back({output_, options_.level_names, container_, report_.pack, options_.write});
    add_targets(options_.more, report_.source, files_);
    settle_lengths();
    report_.levels = end_ - first_;
    if (mip_ && holds) report_.levels = levels_to_build(*mip_, base);
    return settle_extras();
}

// Decides what goes along beside the normals, and reads what is given.
Result<void> PackRun::settle_extras() {
    for (const Extra extra : kApartOrder) {
        if (!options_.apart[extra] || map_.extras()[extra]) continue;
        const bool is_z = extra == Extra::blue && map_.info().swizzle[2] == Component::z;
        return Error{ErrorCode::bad_option, map_.map().path(),
                     "has no " + std::string(name_of(kExtraNames, extra)) +
                         " beside the normals, which could be written apart" +
                         (is_z ? ": blue is read as z; --swizzle rg or labpbr reads it as data" : "")};
    }
    if (planes_given(options_.others) != ExtraSet() && end_ - first_ > 1) {
        return Error{ErrorCode::bad_option, map_.map().path(),
                     "has smaller levels, and what is given beside the normals has none: build the levels again, or "
                     "write only the base level"};
    }
    Result<GivenExtras> read = GivenExtras::read(options_.others, extent(first_), files_);
    if (!read) return read.error();
    given_ = std::move(*read);
    const ExtraSet own = given_.planes();
    if ((apart() & own) != ExtraSet()) return bad_option("others: replace what is to be written apart");
    kept_ = map_.extras_taken() & held_by_any(files_) & !own;
    kept_.length = kept_.length && !options_.apart.length;
    if (kept_.alpha && mip_ && may_change_ones(*mip_, files_)) {
        const Result<bool> is_one = map_.alpha_is_one();
        if (!is_one) return is_one.error();
        kept_.alpha = !*is_one;
    }
    in_codes_ = kept_.length && map_.rule().keep_length && !mip_ && !options_.scale;
    written_ = kept_ | own;
    written_.length = written_.length && !in_codes_;
    if (written_.length && map_.rule().keep_length)
        return bad_option("keep_length: vectors have unit length if their lengths get other data");
    kept_ = kept_ | apart();
    return check_together(written_);
}

// Decides which outputs get vectors of unit length. If some do not, rows are read as they are.
void PackRun::settle_lengths() {
    if (!options_.keep_codes || map_.rule().keep_length || mip_ || options_.scale) return;
    const FormatInfo info = format_info(report_.source.format);
    const bool has_z = map_.sources().z >= 0;
    UnpackOptions unit = options_.source.unpack;
    unit.snap_flat = false;
    UnpackRule again = rule_of(unit, info.sample, info.bits, YAxis::up);
    again.is_unsigned = false;
    bool any_keeps = false, all_keep = true;
    for (FileTarget& file : files_) {
        const bool keeps = can_keep_codes(report_.source.format, has_z, file.pack.encoding);
        if (!keeps) file.unit = UnitRule{again, has_z};
        any_keeps = any_keeps || keeps;
        all_keep = all_keep && keeps;
    }
    // Data in the lengths stay in the codes, or are read, and stored in all files again.
    const bool moves_lengths =
        options_.others.length || options_.apart.length || (map_.extras_taken().length && !all_keep);
    if (any_keeps && !moves_lengths) return map_.keep_length();
    for (FileTarget& file : files_) file.unit.reset();
}

// Finds the first level that is small enough. If the source has none, one is built.
void PackRun::choose_level() {
    const auto fits = [this](int level) {
        const Extent its = extent(level);
        return options_.max_side == 0 || std::max(its.width, its.height) <= options_.max_side;
    };
    int level = first_;
    while (!options_.level && !fits(level) && level + 1 < map_.map().levels()) ++level;
    if (fits(level)) {
        first_ = level;
    } else {
        mip_ = MipOptions();
        mip_->levels = 1;
        mip_->max_side = options_.max_side;
    }
}

// The roughness at the base level, if a roughness map is written.
Result<void> PackRun::find_own_roughness() {
    if (!options_.roughness) return {};
    const RoughnessFile& file = *options_.roughness;
    if (!file.map) {
        own_.emplace(file.own, extent(first_).width);
        return {};
    }
    Result<Plane<float>> map = file.map();
    if (!map) return map.error();
    roughness_map_ = std::move(*map);
    Result<MaterialRoughness> own = MaterialRoughness::of(roughness_map_, extent(first_), *mip_, execution_.quiet());
    if (!own) return own.error();
    own_ = std::move(*own);
    return {};
}

// What stays in the roughness file beside roughness, and the format of the file.
Result<void> PackRun::find_kept_channels() {
    if (!options_.roughness) return {};
    const RoughnessFile& file = *options_.roughness;
    report_.roughness_format = file.format.value_or(report_.roughness_format);
    if (!file.kept) return {};
    const Result<Texture> texture = file.kept();
    if (!texture) return texture.error();
    if (!file.format) report_.roughness_format = format_with_room(texture->format, file.container);
    if (!holds_roughness(report_.roughness_format) || (!file.format && format_info(texture->format).has_blocks())) {
        return Error{ErrorCode::unsupported,
                     {},
                     "the texture for roughness holds " + std::string(name_of(kFormatNames, texture->format)) +
                         ", which cannot take roughness without changing the rest; write another file, or name a "
                         "format"};
    }
    Result<KeptChannels> kept = kept_channels(*texture, extent(first_), left_out_, roughness_levels(),
                                              mip_.value_or(MipOptions()), execution_.quiet());
    if (!kept) return kept.error();
    beside_roughness_ = std::move(*kept);
    return {};
}

Result<void> PackRun::open_targets() {
    Result<void> opened = targets_.open(files_, written_, report_.extent, report_.levels);
    for (const Extra extra : kApartOrder) {
        if (opened && options_.apart[extra])
            opened = targets_.open(*options_.apart[extra], extra, options_.write, report_.extent, report_.levels);
    }
    if (!opened || !options_.roughness) return opened;
    RoughnessFile file = *options_.roughness;
    file.format = report_.roughness_format;
    return targets_.open(file, beside_roughness_ ? &*beside_roughness_ : nullptr, options_.write, report_.extent,
                         roughness_levels());
}

// Where data are not lost, or were told to go.
ExtraSet PackRun::accounted_for() const {
    const ExtraSet not_wanted{false, !options_.source.unpack.others.alpha, false};
    return given_.planes() | apart() | (kept_ & held_by_all(files_)) | not_wanted;
}

// Packs a level and the levels that are built from it.
Result<void> PackRun::pack_level(int level, const Execution& execution) {
    auto inspector = level == first_ ? inspector_for(options_.source, report_.source, extent(level)) : std::nullopt;
    Flow flow;
    flow.set_rows_together(targets_.rows_together());
    std::optional<ExtraInspector> extras;
    if (level == first_ && options_.source.inspect)
        extras.emplace(map_.map().head(), extent(level), map_.sources(), options_.source);
    const Stage& unpacked = map_.add_to(
        flow, level, {options_.scale, inspector ? &*inspector : nullptr, extras ? &*extras : nullptr, kept_});
    const Stage& normals = given_.add_to(flow, unpacked);
    add_levels(flow, normals, made_levels(level, mip_ ? left_out_ + report_.levels : 1), targets_);
    if (options_.roughness) {
        const MadeLevels levels = made_levels(level, left_out_ + roughness_levels());
        add_roughness(flow, normals, levels, options_.roughness->model, *own_, targets_);
    }
    if (Result<void> done = flow.run(execution, sizes_); !done) return done;
    if (inspector) inspector->report(report_.source);
    if (extras) report_.source.others = left_out(extras->report(report_.source), accounted_for());
    return {};
}

Result<PackFileReport> PackRun::run() {
    if (const Result<void> opened = map_.open(execution_); !opened) return opened.error();
    if (const Result<void> ready = prepare(); !ready) return map_.map().after_all_rows(ready.error());
    if (const Result<void> found = find_own_roughness(); !found) return found.error();
    if (const Result<void> found = find_kept_channels(); !found) return found.error();
    if (const Result<void> opened = open_targets(); !opened) return opened.error();
    double texels = 0.0;
    for (int level = first_; level < end_; ++level) texels += static_cast<double>(extent(level).texels());
    double done = 0.0;
    for (int level = first_; level < end_; ++level) {
        const double next = std::min(1.0, done + static_cast<double>(extent(level).texels()) / texels);
        const Result<void> packed = pack_level(level, part_of(execution_, done, next));
        if (!packed) return packed.error();
        done = next;
    }
    if (options_.accept) {
        if (const Result<void> accepted = options_.accept(report_.source); !accepted) return accepted.error();
    }
    if (const Result<void> committed = targets_.commit(); !committed) return committed.error();
    report_.bytes = targets_.bytes(Content::normals);
    if (options_.roughness) report_.roughness_levels = roughness_levels();
    report_.roughness_bytes = targets_.bytes(Content::roughness);
    report_.rdo = targets_.rdo();
    return report_;
}

}  // namespace

Result<PackFileReport> pack_stream(MapSource& map, const std::string& output, Container container,
                                   const PackFileOptions& options, const Execution& execution,
                                   const StreamSizes& sizes) {
    return PackRun(map, output, container, options, execution, sizes).run();
}

Result<PackFileReport> pack_stream(InputFile& file, const std::string& output, Container container,
                                   const PackFileOptions& options, const Execution& execution,
                                   const StreamSizes& sizes) {
    FileMap map(file, options.source.read);
    return pack_stream(map, output, container, options, execution, sizes);
}

}  // namespace tex::inline v1
