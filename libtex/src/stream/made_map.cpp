// SPDX-License-Identifier: Apache-2.0

#include "stream/made_map.h"

#include <optional>

#include "stream/blending.h"
#include "stream/height_stage.h"
#include "stream/made_rows.h"
#include "stream/map_file.h"
#include "stream/open_heights.h"
#include "stream/shared_writer.h"
#include "stream/source_layout.h"
#include "stream/unpack_stage.h"
#include "stream/usual_slope.h"

namespace tex {
namespace {

// The file, for the first step that reads normals.
class FileMap final : public MapSource {
public:
    FileMap(const std::string& path, const ReadOptions& options) : path_(path), options_(options) {}

    [[nodiscard]] const std::string& path() const override { return path_; }
    Result<TextureRows> open() override {
        if (!map_) {
            Result<InputFile> file = InputFile::open(path_);
            if (!file) return file.error();
            file_.emplace(std::move(*file));
            // The map may have to be read twice.
            if (const Result<void> settled = file_->settle(largest_file(options_)); !settled) return settled.error();
            map_.emplace(*file_, options_);
        }
        return map_->open();
    }

private:
    const std::string& path_;
    const ReadOptions& options_;
    std::optional<InputFile> file_;
    std::optional<OpenFileMap> map_;
};

// How the command would pack the map into a file; only y counts.
PackOptions packing_of_step(const std::function<PackOptions(const SourceInfo&)>& pack, const SourceInfo& source) {
    return packing_for(pack, Container::exr, source);
}

class BakedMap final : public MapSource {
public:
    BakedMap(const std::string& input, const BakeFileOptions& options, const Execution& execution, StepsReport& report)
        : input_(input), options_(options), execution_(execution), report_(report) {}

    [[nodiscard]] const std::string& path() const override { return input_; }
    Result<TextureRows> open() override {
        if (options_.tile)
            return Error{ErrorCode::bad_option, input_, "a tile of a terrain is baked without other steps"};
        Result<InputFile> file = InputFile::open(input_);
        if (!file) return file.error();
        heights_.reset();
        file_.emplace(std::move(*file));
        if (options_.auto_strength) {
            Result<BakeFileOptions> measured = with_measured_strength(*file_, options_, execution_);
            if (!measured) return measured.error().of(input_);
            options_ = std::move(*measured);
        }
        const Gradient gradient = gradient_of(options_.bake);
        const Execution silent{execution_.threads, {}};
        Result<Heights> heights = open_heights(*file_, RowOrder::from_the_top, options_, gradient, silent);
        if (!heights) return heights.error().of(input_);
        heights_.emplace(std::move(*heights));
        const Extent extent = heights_->rows->extent();
        const HeightFieldHead head = head_of(extent, options_, heights_->stated);
        report_.strength = {head.bumpiness_x, head.bumpiness_y};
        HeightReport before = report_of(heights_->counts, heights_->deband, heights_->stored);
        before.remark = heights_->remark;
        const auto make = [&, before, head](NormalSink sink) {
            auto stage = std::make_unique<CountedStage>(
                report_.heights, before,
                std::make_unique<HeightStage>(extent, heights_->source, heights_->options, gradient, head,
                                              std::move(sink), std::move(heights_->last)));
            return stage;
        };
        MadeRows::Convert convert;
        if (heights_->linear)
            convert = [this](Image& rows, int count) { return heights_->linear->convert(rows, count); };
        TextureRows texture = made_texture(options_.pack.y_axis, options_.pack.y_known);
        texture.levels.push_back(std::make_unique<MadeRows>(*heights_->rows, input_, extent, options_.pack.y_axis, make,
                                                            std::move(convert)));
        return texture;
    }

private:
    // Reports what the stage has found.
    class CountedStage final : public NormalStage {
    public:
        CountedStage(HeightReport& report, const HeightReport& before, std::unique_ptr<HeightStage> stage)
            : report_(report), before_(before), stage_(std::move(stage)) {}
        void put(const Image& rows, int count) override { stage_->put(rows, count); }
        [[nodiscard]] Result<void> check() const override {
            HeightCounts counts = stage_->counts();
            counts += {before_.luma_texels, before_.invalid_texels, before_.implausible_texels};
            report_ = report_of(counts, before_.deband, before_.stored);
            report_.remark = before_.remark;
            return stage_->check();
        }

    private:
        HeightReport& report_;
        const HeightReport before_;
        const std::unique_ptr<HeightStage> stage_;
    };

    const std::string& input_;
    BakeFileOptions options_;
    const Execution& execution_;
    StepsReport& report_;
    std::optional<InputFile> file_;
    std::optional<Heights> heights_;
};

// A map that is unpacked and scaled, each level by itself.
class ScaledMap final : public MapSource {
public:
    ScaledMap(std::unique_ptr<MapSource> before, const PackFileOptions& options, StepsReport& report)
        : before_(std::move(before)), options_(options), report_(report), map_(*before_, options.source) {}

    [[nodiscard]] const std::string& path() const override { return before_->path(); }
    Result<TextureRows> open() override {
        if (Result<void> opened = map_.open(); !opened) return opened.error().of(path());
        if (Result<void> known = map_.settle_layout(); !known) return known.error().of(path());
        report_.maps.push_back({path(), map_.info()});
        TextureRows& held = map_.texture();
        std::size_t first = 0, end = held.levels.size();
        if (options_.level) {
            first = static_cast<std::size_t>(*options_.level);
            end = first + 1;
            if (first >= held.levels.size()) {
                return Error{ErrorCode::bad_option, path(),
                             "has no level " + std::to_string(first) + ", only " + std::to_string(held.levels.size())};
            }
        }
        const PackOptions pack = packing_of_step(options_.pack, map_.info());
        TextureRows texture = made_texture(pack.y_axis, pack.y_known);
        for (std::size_t k = first; k < end; ++k) {
            RowSource& rows = *held.levels[k];
            const auto make = [&](NormalSink sink) {
                return std::make_unique<UnpackStage>(held, rows.extent(), map_.sources(), map_.rule(), options_.scale,
                                                     k == 0 ? map_.finder() : nullptr, nullptr, std::move(sink));
            };
            texture.levels.push_back(std::make_unique<MadeRows>(rows, path(), rows.extent(), pack.y_axis, make));
        }
        return texture;
    }

private:
    const std::unique_ptr<MapSource> before_;
    const PackFileOptions& options_;
    StepsReport& report_;
    MapFile map_;
};

class BlendedMap final : public MapSource {
public:
    BlendedMap(std::unique_ptr<MapSource> before, const BlendFileOptions& options, const Execution& execution,
               StepsReport& report)
        : before_(std::move(before)), options_(options), execution_(execution), report_(report) {}

    [[nodiscard]] const std::string& path() const override { return before_->path(); }
    Result<TextureRows> open() override {
        reading_.reset();
        blending_.emplace(*before_, options_);
        if (Result<void> opened = blending_->open(execution_); !opened) return opened.error().of(path());
        if (Result<void> known = blending_->settle_layouts(); !known) return known.error().of(path());
        Result<std::unique_ptr<Blending::Reading>> reading = blending_->read(execution_);
        if (!reading) return reading.error().of(path());
        reading_ = std::move(*reading);
        report_.maps.push_back({path(), blending_->source()});
        const std::vector<SourceInfo> details = blending_->details();
        for (std::size_t k = 0; k < details.size(); ++k) report_.maps.push_back({options_.layers[k].input, details[k]});
        const auto make = [this](NormalSink sink) {
            return std::make_unique<BlendStage>(reading_->maps, reading_->in_step, std::move(sink));
        };
        const PackOptions pack = packing_of_step(options_.pack, blending_->source());
        TextureRows texture = made_texture(pack.y_axis, pack.y_known);
        texture.levels.push_back(
            std::make_unique<MadeRows>(*reading_->rows, path(), blending_->extent(), pack.y_axis, make));
        return texture;
    }

private:
    const std::unique_ptr<MapSource> before_;
    const BlendFileOptions& options_;
    const Execution& execution_;
    StepsReport& report_;
    std::optional<Blending> blending_;
    std::unique_ptr<Blending::Reading> reading_;
};

}  // namespace

std::unique_ptr<MapSource> made_map(const std::string& input, const std::vector<Step>& steps, std::size_t count,
                                    const Execution& execution, StepsReport& report) {
    std::unique_ptr<MapSource> map;
    for (std::size_t k = 0; k < count; ++k) {
        if (const auto* bake = std::get_if<BakeFileOptions>(&steps[k])) {
            map = std::make_unique<BakedMap>(input, *bake, execution, report);
        } else if (const auto* pack = std::get_if<PackFileOptions>(&steps[k])) {
            if (!map) map = std::make_unique<FileMap>(input, pack->source.read);
            map = std::make_unique<ScaledMap>(std::move(map), *pack, report);
        } else if (const auto* blend = std::get_if<BlendFileOptions>(&steps[k])) {
            if (!map) map = std::make_unique<FileMap>(input, blend->source.read);
            map = std::make_unique<BlendedMap>(std::move(map), *blend, execution, report);
        }
    }
    return map;
}

}  // namespace tex
