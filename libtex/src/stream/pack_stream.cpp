// SPDX-License-Identifier: Apache-2.0

#include "stream/pack_stream.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include <tex/mip_chain.h>

#include "formats/texture_rows.h"
#include "rows/mip_rows.h"
#include "stream/filled_map.h"
#include "stream/layout_finder.h"
#include "stream/level_stage.h"
#include "stream/map_inspector.h"
#include "stream/measured_y.h"
#include "stream/own_roughness.h"
#include "stream/shared_writer.h"
#include "stream/source_layout.h"
#include "stream/unpack_stage.h"
#include "threads/parallel.h"

namespace tex {
namespace {

// What one attempt leaves for the next.
struct Kept {
    std::unique_ptr<StripWriter> writer;  // until the next attempt has opened its own
    std::optional<Plane<float>> own;      // RoughnessFile::map, which is read only once
};

// One reading of the file, with an assumption about its layout.
class Attempt {
public:
    Attempt(TextureRows& texture, const std::string& input, const std::string& output, Container container,
            const PackFileOptions& options, const Execution& execution, const StreamSizes& sizes,
            const KnownLayout& known, Kept& kept)
        : texture_(texture), input_(input), output_(output), container_(container), options_(options),
          execution_(execution), sizes_(sizes), kept_(kept), finder_(texture, options.source, known),
          mip_(options.mip) {}

    // Returns an empty optional, and sets correction(), if the texels show that the assumption was wrong.
    Result<std::optional<PackFileReport>> run();
    [[nodiscard]] const KnownLayout& correction() const { return *correction_; }

private:
    Result<void> prepare();
    void choose_level();
    void settle_lengths(SampleKind sample, int bits);
    Result<void> look_at_base_level();
    [[nodiscard]] Result<std::optional<OwnRoughness>> own_roughness() const;
    Result<std::unique_ptr<StripWriter>> open_writer() const;
    Result<void> stream_level(std::size_t k, StripWriter& writer, const Execution& execution);
    [[nodiscard]] int roughness_levels() const {
        return holds_levels(options_.roughness->container, options_.roughness->level_names) ? report_.levels : 1;
    }
    [[nodiscard]] RowSource& rows(std::size_t k) const { return *texture_.levels[k]; }

    TextureRows& texture_;
    const std::string& input_;
    const std::string& output_;
    const Container container_;
    const PackFileOptions& options_;
    const Execution& execution_;
    const StreamSizes& sizes_;
    Kept& kept_;
    LayoutFinder finder_;
    std::optional<MipOptions> mip_;
    std::optional<KnownLayout> correction_;
    Sources sources_;
    UnpackRule rule_;
    std::optional<OwnRoughness> own_;
    std::size_t first_ = 0;  // the level that becomes the base level
    std::size_t end_ = 1;    // the end of the levels that are read
    int left_out_ = 0;       // levels that are built and not written
    std::vector<FileTarget> targets_;
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
Result<void> Attempt::prepare() {
    const Texture& head = texture_.head;
    if (Result<void> fit = check_channels(head); !fit) return fit;
    const FormatInfo info = format_info(head.format);
    const Result<Sources> sources = sources_of(finder_.layout().swizzle, (1u << info.channels) - 1);
    if (!sources) return sources.error();
    sources_ = *sources;
    report_.source = source_info(head, finder_.layout().swizzle, options_.source);
    rule_ = rule_of(unpack_options(report_.source, options_.source), info.sample, info.bits, report_.source.y_axis);
    rule_.is_unsigned = finder_.layout().is_unsigned;

    const std::size_t held = texture_.levels.size();
    first_ = static_cast<std::size_t>(options_.level.value_or(0));
    if (first_ >= held) {
        const std::string asked = std::to_string(*options_.level);
        return Error{ErrorCode::bad_option, input_, "has no level " + asked + ", only " + std::to_string(held)};
    }
    if (!mip_) choose_level();
    const bool holds = any_holds_levels(container_, options_.level_names, options_.more);
    end_ = options_.level || mip_ || !holds ? first_ + 1 : held;
    const Extent base = rows(first_).extent();
    if (mip_) left_out_ = first_level(*mip_, base);
    report_.extent = level_extent(base, left_out_);
    report_.pack = packing_for(options_.pack, container_, report_.source);
    targets_.push_back({{output_, options_.level_names}, container_, report_.pack, options_.write});
    add_targets(options_.more, report_.source, targets_);
    settle_lengths(info.sample, info.bits);
    report_.levels = static_cast<int>(end_ - first_);
    if (mip_ && holds) report_.levels = levels_to_build(*mip_, base);
    return {};
}

// Decides which outputs get vectors of unit length. If some do not, rows are read as they are.
void Attempt::settle_lengths(SampleKind sample, int bits) {
    if (!options_.keep_codes || rule_.keep_length || mip_ || options_.scale) return;
    const bool has_z = sources_.z >= 0;
    UnpackOptions unit = options_.source.unpack;
    unit.snap_flat = false;
    UnpackRule again = rule_of(unit, sample, bits, YAxis::up);
    again.is_unsigned = false;
    for (FileTarget& target : targets_) {
        if (can_keep_codes(report_.source.format, has_z, target.pack.encoding)) {
            rule_.keep_length = true;
        } else {
            target.unit = UnitRule{again, has_z};
        }
    }
    if (rule_.keep_length) return;
    for (FileTarget& target : targets_) target.unit.reset();
}

// Finds the first level that is small enough. If the source has none, one is built.
void Attempt::choose_level() {
    const auto fits = [this](std::size_t k) {
        const Extent extent = rows(k).extent();
        return options_.max_side == 0 || std::max(extent.width, extent.height) <= options_.max_side;
    };
    std::size_t k = first_;
    while (!options_.level && !fits(k) && k + 1 < texture_.levels.size()) ++k;
    if (fits(k)) {
        first_ = k;
    } else {
        mip_ = MipOptions();
        mip_->levels = 1;
        mip_->max_side = options_.max_side;
    }
}

// To be called if the base level decides how another level is read.
Result<void> Attempt::look_at_base_level() {
    Result<void> seen = rows(0).visit(input_, [this](const Image& image, int, int count) {
        for (int k = 0; k < count; ++k) {
            const float* channels[4] = {};
            for (std::size_t c = 0; c < texture_.planes.size(); ++c)
                channels[c] = image.planes[texture_.planes[c]].row(k);
            finder_.add_row(channels);
        }
        return Result<void>();
    });
    if (!seen) return seen;
    correction_ = finder_.correction();
    return {};
}

// The roughness at the base level, if a roughness map is written.
Result<std::optional<OwnRoughness>> Attempt::own_roughness() const {
    if (!options_.roughness) return std::optional<OwnRoughness>();
    const RoughnessFile& file = *options_.roughness;
    if (!file.map) return std::optional(OwnRoughness(file.own, rows(first_).extent().width));
    if (!kept_.own) {
        Result<Plane<float>> map = file.map();
        if (!map) return map.error();
        kept_.own = std::move(*map);
    }
    const Execution silent{execution_.threads, {}};
    Result<OwnRoughness> own = OwnRoughness::of(*kept_.own, rows(first_).extent(), *mip_, silent);
    if (!own) return own.error();
    return std::optional(std::move(*own));
}

Result<std::unique_ptr<StripWriter>> Attempt::open_writer() const {
    Result<std::unique_ptr<StripWriter>> normals = open_targets(targets_, report_.extent, report_.levels);
    if (!normals || !options_.roughness) return normals;
    const RoughnessFile& file = *options_.roughness;
    const StripPacking rough = packing_of(file, report_.extent, roughness_levels());
    WriteOptions write = options_.write;
    if (!can_compress(file.container)) write.zstd = 0;
    Result<std::unique_ptr<StripWriter>> roughness =
        StripWriter::open({file.output, file.level_names}, file.container, rough, write, Opened::late);
    if (!roughness) return roughness;
    return StripWriter::pair(std::move(*normals), std::move(*roughness));
}

// Packs level k and the levels that are built from it.
Result<void> Attempt::stream_level(std::size_t k, StripWriter& writer, const Execution& execution) {
    const Extent extent = rows(k).extent();
    const int levels = mip_ ? left_out_ + report_.levels : 1;
    LayoutFinder* const finder = k == 0 && finder_.depends_on_texels() ? &finder_ : nullptr;
    if (finder == nullptr) {
        std::vector<bool> wanted(rows(k).names().size(), false);
        for (const int c : {sources_.x, sources_.y, sources_.z}) {
            if (c >= 0) wanted[texture_.planes[static_cast<std::size_t>(c)]] = true;
        }
        rows(k).choose_planes(wanted);
    }
    RowStream stream(rows(k), input_, static_cast<int>(k - first_) - left_out_, levels, writer, execution, sizes_);
    auto inspector = k == first_ ? inspector_for(options_.source, report_.source, extent) : std::nullopt;
    UnpackStage normals(texture_, extent, sources_, rule_, options_.scale, finder, inspector ? &*inspector : nullptr,
                        stream.sink());
    constexpr int kFromTheTop = 0;
    LevelStage mips(extent, levels, kFromTheTop, counted_from_base(mip_.value_or(MipOptions()), left_out_),
                    stream.strips());
    std::optional<RoughnessStage> roughness;
    if (options_.roughness) {
        const RoughnessFile& file = *options_.roughness;
        const int rough_levels = left_out_ + roughness_levels();
        roughness.emplace(extent, rough_levels, *mip_, file.model, *own_, stream.roughness_strips(rough_levels));
    }
    Result<void> done = stream.run(normals, mips, roughness ? &*roughness : nullptr);
    if (done && finder != nullptr) correction_ = finder->correction();
    if (done && inspector) inspector->report(report_.source);
    return done;
}

Result<std::optional<PackFileReport>> Attempt::run() {
    if (const Result<void> ready = prepare(); !ready) return after_all_rows(rows(0), input_, ready.error().of(input_));
    if (first_ > 0 && finder_.depends_on_texels()) {
        if (const Result<void> seen = look_at_base_level(); !seen) return seen.error();
        if (correction_) return std::optional<PackFileReport>();
    }
    Result<std::optional<OwnRoughness>> own = own_roughness();
    if (!own) return own.error();
    own_ = std::move(*own);
    Result<std::unique_ptr<StripWriter>> opened = open_writer();
    if (!opened) return opened.error();
    // The old writer is closed only now, after the new one is open: a reader of a FIFO takes the end of the last writer
    // for the end of the file.
    kept_.writer = std::move(*opened);
    StripWriter& writer = *kept_.writer;
    double texels = 0.0;
    for (std::size_t k = first_; k < end_; ++k) texels += static_cast<double>(rows(k).extent().texels());
    double done = 0.0;
    for (std::size_t k = first_; k < end_; ++k) {
        const double next = done + static_cast<double>(rows(k).extent().texels()) / texels;
        const Result<void> streamed = stream_level(k, writer, part_of(execution_, done, std::min(1.0, next)));
        if (!streamed) return streamed.error();
        if (correction_) return std::optional<PackFileReport>();
        done = next;
    }
    if (const Result<void> committed = writer.commit(); !committed) return committed.error();
    report_.bytes = writer.file_bytes();
    report_.roughness_bytes = writer.roughness_bytes();
    report_.rdo = writer.rdo();
    return std::optional(report_);
}

}  // namespace

Result<PackFileReport> pack_stream(MapSource& source, const std::string& output, Container container,
                                   const PackFileOptions& options, const Execution& execution,
                                   const StreamSizes& sizes) {
    if (options.source.measure_y) {
        Result<SourceOptions> measured = with_measured_y(source, options.source);
        if (!measured) return measured.error();
        PackFileOptions settled = options;
        settled.source = std::move(*measured);
        return pack_stream(source, output, container, settled, execution, sizes);
    }
    double told = 0.0;  // a new attempt does not move progress backwards
    Execution onward{execution.threads, {}};
    if (execution.progress) {
        onward.progress = [&](double fraction) { return execution.progress(told = std::max(told, fraction)); };
    }
    KnownLayout known;
    Kept kept;
    while (true) {
        Result<TextureRows> texture = source.open();
        if (options.source.fill_background) {
            texture = fill_background(std::move(texture), options.source, execution);
            if (!texture) return texture.error().of(source.path());
        }
        if (!texture) return texture.error();
        Attempt attempt(*texture, source.path(), output, container, options, onward, sizes, known, kept);
        Result<std::optional<PackFileReport>> done = attempt.run();
        if (!done) return done.error();
        if (*done) return **done;
        known = attempt.correction();
        *texture = {};
    }
}

Result<PackFileReport> pack_stream(InputFile& file, const std::string& output, Container container,
                                   const PackFileOptions& options, const Execution& execution,
                                   const StreamSizes& sizes) {
    OpenFileMap source(file, options.source.read);
    return pack_stream(source, output, container, options, execution, sizes);
}

}  // namespace tex
