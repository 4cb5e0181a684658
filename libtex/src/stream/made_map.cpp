// SPDX-License-Identifier: Apache-2.0

#include "stream/made_map.h"

#include <numeric>
#include <optional>

#include <tex/pack.h>

#include "formats/channels.h"
#include "rows/usable.h"
#include "stream/blending.h"
#include "stream/given_extras.h"
#include "stream/height_stage.h"
#include "stream/open_heights.h"
#include "stream/settled_map.h"
#include "stream/targets.h"
#include "stream/usual_slope.h"

namespace tex::inline v1 {
namespace {

// Keeps the rows of another stage.
class KeepStage final : public Stage {
public:
    KeepStage(const Stage& from, NormalMap& map) : Stage(from.extent(), 0), from_(from), map_(map) {}

    [[nodiscard]] std::vector<Need> needs(int first, int end) const override { return {{&from_, first, end}}; }
    Result<void> make(Strip& strip) override {
        const auto width = static_cast<std::size_t>(extent().width);
        for (int j = strip.first; j < strip.first + strip.height; ++j) {
            const VectorRow row = from_.normals(j);
            std::copy_n(row.x, width, map_.x.row(j));
            std::copy_n(row.y, width, map_.y.row(j));
            std::copy_n(row.z, width, map_.z.row(j));
            if (!map_.alpha.empty()) std::copy_n(from_.row(plane_of(Extra::alpha), j), width, map_.alpha.row(j));
        }
        return {};
    }

private:
    const Stage& from_;
    NormalMap& map_;
};

// A map that a step makes: what an EXR file of floats would be between this step and the next, but its rows are handed
// over as they are. Alpha goes along.
class MadeMap : public MapSource {
public:
    [[nodiscard]] const Texture& head() const final { return head_; }
    [[nodiscard]] bool has_y_up() const final { return true; }
    StoredChannels add_to(Flow& flow, int level, const std::vector<bool>&) final {
        std::vector<std::size_t> planes = {0, 1, 2};
        if (beside_.alpha) planes.push_back(plane_of(Extra::alpha));
        return {&add_normals(flow, level), std::move(planes)};
    }
    // The layout of floats is known.
    Result<void> look(const TakeChannels&) final { return {}; }
    Result<Texture> read(bool base_only, const Execution& execution) final {
        if (Result<void> opened = open(); !opened) return opened.error();
        MipChain chain;
        for (int k = 0; k < (base_only ? 1 : levels()); ++k) {
            Flow flow;
            NormalMap& map = chain.levels.emplace_back(extent(k));
            if (beside_.alpha) map.alpha = Plane<float>(extent(k));
            flow.add<KeepStage>(add_normals(flow, k), map);
            if (Result<void> made = flow.run(execution.quiet()); !made) return made.error();
        }
        const Encoding encoding = beside_.alpha ? Encoding::rgba32f : Encoding::float_;
        Result<PackedTexture> packed = pack(chain, {encoding, head_.y_axis}, execution.quiet());
        if (!packed) return packed.error();
        Texture texture = head_;
        texture.levels = std::move(packed->levels);
        return texture;
    }
    Error after_all_rows(const Error& error) final { return error; }

protected:
    virtual const Stage& add_normals(Flow& flow, int level) = 0;
    // Settles what is beside the normals: alpha, as the options give it, or else if `kept`. `levels`: those of the map.
    Result<void> settle_extras(const ExtraInputs& inputs, bool kept, int levels) {
        if (inputs.blue || inputs.length)
            return bad_option("steps: only the last one can put data into blue or the lengths of vectors");
        if (inputs.alpha && levels > 1)
            return Error{ErrorCode::bad_option, path(),
                         "has smaller levels, and what is given beside the normals none"};
        Result<GivenExtras> given = GivenExtras::read(inputs, extent(0), {});
        if (!given) return given.error().of(path());
        given_ = std::move(*given);
        beside_ = {false, kept || inputs.alpha, false};
        head_.format = beside_.alpha ? Format::rgba32_float : Format::rgb32_float;
        head_.swizzle = likely_swizzle(head_.format);
        return {};
    }
    // What goes along from the map before.
    [[nodiscard]] ExtraSet taken() const { return beside_ & !given_.planes(); }
    [[nodiscard]] const GivenExtras& given() const { return given_; }
    // How the command would pack the map into a file.
    void describe(const std::function<PackOptions(const SourceInfo&)>& pack, const SourceInfo& source) {
        describe(packing_for(pack, Container::exr, source));
    }
    void describe(const PackOptions& pack) {
        head_ = {};
        head_.format = Format::rgb32_float;
        head_.swizzle = likely_swizzle(Format::rgb32_float);
        head_.swizzle_known = true;
        head_.y_axis = pack.y_axis;
        head_.y_known = pack.y_known;
        head_.normal_encoding = "signed";
    }

private:
    Texture head_;
    ExtraSet beside_;
    GivenExtras given_;
};

class BakedMap final : public MadeMap {
public:
    BakedMap(const std::string& input, const BakeFileOptions& options, const Execution& execution)
        : input_(input), options_(options), execution_(execution), gradient_(gradient_of(options.bake)) {}

    [[nodiscard]] const std::string& path() const override { return input_; }
    Result<void> open() override {
        if (options_.tile)
            return Error{ErrorCode::bad_option, input_, "a tile of a terrain is baked without other steps"};
        heights_.reset();
        Result<InputFile> file = InputFile::open(input_);
        if (!file) return file.error();
        file_.emplace(std::move(*file));
        if (options_.auto_strength) {
            Result<BakeFileOptions> measured = with_measured_strength(*file_, options_, execution_);
            if (!measured) return measured.error().of(input_);
            options_ = std::move(*measured);
        }
        const Execution silent = execution_.quiet();
        Result<Heights> heights = open_heights(*file_, RowOrder::from_the_top, options_, gradient_, silent);
        if (!heights) return heights.error().of(input_);
        heights_.emplace(std::move(*heights));
        describe(options_.pack);
        return settle_extras(options_.others, false, 1);
    }
    [[nodiscard]] int levels() const override { return 1; }
    [[nodiscard]] Extent extent(int) const override { return heights_->rows->extent(); }
    void report(StepsReport& report) const override {
        report.strength = strength_;
        report.on_ground = on_ground_;
        report.heights = report_of(*heights_, heights_->counts);
        report.heights.remark = remark_with_counts(*heights_, heights_->remark, heights_->counts);
    }

private:
    const Stage& add_normals(Flow& flow, int) override {
        const BakedRows baked = add_bake(flow, *heights_, input_, options_, gradient_);
        strength_ = middle_strength(baked.head, heights_->rows->extent());
        on_ground_ = baked.head.ground.has_value();
        return given().add_to(flow, *baked.normals);
    }

    const std::string& input_;
    BakeFileOptions options_;
    const Execution& execution_;
    const Gradient gradient_;
    std::optional<InputFile> file_;
    std::optional<Heights> heights_;
    Strength strength_;
    bool on_ground_ = false;
};

// A map that is unpacked and scaled, each level by itself.
class ScaledMap final : public MadeMap {
public:
    ScaledMap(std::unique_ptr<MapSource> before, const PackFileOptions& options, const Execution& execution)
        : before_(std::move(before)), options_(options), execution_(execution), map_(*before_, options.source) {}

    [[nodiscard]] const std::string& path() const override { return before_->path(); }
    Result<void> open() override {
        if (Result<void> opened = map_.open(execution_.quiet()); !opened) return opened;
        const int held = map_.map().levels();
        first_ = options_.level.value_or(0);
        levels_ = options_.level ? 1 : held;
        describe(options_.pack, map_.info());
        if (first_ < held) return settle_extras(options_.others, map_.extras_taken().alpha, levels_);
        return Error{ErrorCode::bad_option, path(),
                     "has no level " + std::to_string(first_) + ", only " + std::to_string(held)};
    }
    [[nodiscard]] int levels() const override { return levels_; }
    [[nodiscard]] Extent extent(int level) const override { return map_.map().extent(first_ + level); }
    void report(StepsReport& report) const override {
        before_->report(report);
        report.maps.push_back({path(), map_.info()});
    }

private:
    const Stage& add_normals(Flow& flow, int level) override {
        return given().add_to(flow, map_.add_to(flow, first_ + level, {options_.scale, nullptr, nullptr, taken()}));
    }

    const std::unique_ptr<MapSource> before_;
    const PackFileOptions& options_;
    const Execution& execution_;
    SettledMap map_;
    int first_ = 0, levels_ = 1;
};

class BlendedMap final : public MadeMap {
public:
    BlendedMap(std::unique_ptr<MapSource> before, const BlendFileOptions& options, const Execution& execution)
        : before_(std::move(before)), options_(options), execution_(execution) {}

    [[nodiscard]] const std::string& path() const override { return before_->path(); }
    Result<void> open() override {
        blending_.emplace(*before_, options_);
        if (Result<void> opened = blending_->open(execution_); !opened) return opened.error().of(path());
        describe(options_.pack, blending_->source());
        return settle_extras(options_.others, blending_->extras_taken().alpha, 1);
    }
    [[nodiscard]] int levels() const override { return 1; }
    [[nodiscard]] Extent extent(int) const override { return blending_->extent(); }
    void report(StepsReport& report) const override {
        before_->report(report);
        report.maps.push_back({path(), blending_->source()});
        const std::vector<SourceInfo> details = blending_->details();
        for (std::size_t k = 0; k < details.size(); ++k) report.maps.push_back({options_.layers[k].input, details[k]});
    }

private:
    const Stage& add_normals(Flow& flow, int) override {
        return given().add_to(flow, blending_->add_to(flow, taken()));
    }

    const std::unique_ptr<MapSource> before_;
    const BlendFileOptions& options_;
    const Execution& execution_;
    std::optional<Blending> blending_;
};

}  // namespace

std::unique_ptr<MapSource> made_map(const std::string& input, const std::vector<Step>& steps, std::size_t count,
                                    const Execution& execution) {
    std::unique_ptr<MapSource> map;
    for (std::size_t k = 0; k < count; ++k) {
        if (const auto* bake = std::get_if<BakeFileOptions>(&steps[k])) {
            map = std::make_unique<BakedMap>(input, *bake, execution);
        } else if (const auto* pack = std::get_if<PackFileOptions>(&steps[k])) {
            if (!map) map = std::make_unique<FileMap>(input, pack->source.read);
            map = std::make_unique<ScaledMap>(std::move(map), *pack, execution);
        } else if (const auto* blend = std::get_if<BlendFileOptions>(&steps[k])) {
            if (!map) map = std::make_unique<FileMap>(input, blend->source.read);
            map = std::make_unique<BlendedMap>(std::move(map), *blend, execution);
        }
    }
    return map;
}

}  // namespace tex::inline v1
