// SPDX-License-Identifier: Apache-2.0

#include "stream/blending.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "fields/range.h"
#include "rows/extra_rows.h"
#include "stream/normal_source.h"
#include "stream/placed_map.h"

namespace tex::inline v1 {
namespace {

// Whether the rows of a detail can keep in step, as far as that can be decided without its extent.
bool lies_flat(const Layer& layer) {
    return layer.tiling_x == 1.0f && layer.tiling_y == 1.0f && layer.offset_y == 0.0f && layer.rotation == 0.0f;
}

std::string sides_text(double width, double height) {
    const auto side = [](double texels) {
        return std::to_string(static_cast<int>(std::clamp(std::round(texels), 1.0, double{kMaxExtent})));
    };
    return side(width) + "x" + side(height);
}

// What to say of a detail whose shape the result does not have: one number of repeats for both axes stretches it. Two
// that differ are a choice. Empty if it is not visible.
std::string stretch_text(const Layer& layer, const Extent& detail, const Extent& base, const Extent& result) {
    const double tiling_y = static_cast<double>(layer.tiling_x) * result.height * detail.width /
                            (static_cast<double>(result.width) * detail.height);
    const double stretch = tiling_y / layer.tiling_x;
    constexpr double kVisible = 1.05;
    if (layer.tiling_x != layer.tiling_y || (stretch < kVisible && stretch > 1.0 / kVisible)) return {};
    return "is stretched " + rounded_text(std::max(stretch, 1.0 / stretch), 3) + " to 1 " +
           (result == base ? "on the base of " : "in the result of ") + sides_text(result.width, result.height) +
           "; a tiling of " + rounded_text(layer.tiling_x, 4) + "," + rounded_text(tiling_y, 4) + " keeps its shape";
}

// What to say of a detail whose repeats have less than half of its texels in the result. Empty if they have more.
std::string shrink_text(const Layer& layer, const Extent& detail, const Extent& result) {
    const double across = static_cast<double>(layer.tiling_x), along = static_cast<double>(layer.tiling_y);
    const double shrunk = std::max(detail.width * across / result.width, detail.height * along / result.height);
    constexpr double kMost = 2.0;
    if (shrunk <= kMost) return {};
    const std::string sides = sides_text(detail.width, detail.height) + " texels shrink to " +
                              sides_text(result.width / across, result.height / along);
    return (across > 1.0 || along > 1.0 ? "repeats so often that its " + sides
                                        : "is larger than the result: its " + sides) +
           "; an extent of " + sides_text(shrunk * result.width, shrunk * result.height) +
           " keeps its finest bumps, and one that is given, such as " + sides_text(result.width, result.height) +
           ", is taken without this warning";
}

// What to say of a detail that is cut where the result repeats. Empty if it is not.
std::string cut_text(const Layer& layer, const BlendOptions& blend) {
    const bool repeats_x = blend.wrap_x == Wrap::repeat, repeats_y = blend.wrap_y == Wrap::repeat;
    const std::string ending =
        ", so that the result has seams where it repeats; a wrap of clamp says that it does not repeat";
    if ((repeats_x || repeats_y) && std::remainder(layer.rotation, 90.0f) != 0.0f)
        return "is rotated by " + rounded_text(layer.rotation, 4) + " degrees" + ending;
    const auto is_cut = [](float tiling, Wrap wrap) { return wrap == Wrap::repeat && std::round(tiling) != tiling; };
    const bool cuts_x = repeats_x && is_cut(layer.tiling_x, layer.wrap_x);
    const bool cuts_y = repeats_y && is_cut(layer.tiling_y, layer.wrap_y);
    if (!cuts_x && !cuts_y) return {};
    return "repeats " + rounded_text(cuts_x ? layer.tiling_x : layer.tiling_y, 4) + " times" + ending;
}

}  // namespace

Blending::Blending(MapSource& base, const BlendFileOptions& options)
    : options_(options), base_(inputs_.emplace_back(base, options.source)) {}

// Decides whether an open map is read in step or held in memory.
Result<void> Blending::settle(Input& input, const Execution& execution) {
    input.step = rows_in_step(input.map().extent(0), extent_, input.place, input.wrap_x, input.wrap_y);
    return input.step ? Result<void>() : hold(input, execution);
}

Result<void> Blending::hold(Input& input, const Execution& execution) {
    Result<Source> source = read_normals(input.map(), input.settled.options(), false, execution);
    if (!source) return source.error();
    input.chain = std::move(source->chain);
    input.info = std::move(source->info);
    return {};
}

Result<void> Blending::open_base(const Execution& execution) {
    if (Result<void> opened = base_.settled.open(execution); !opened) return opened;
    base_.info = base_.settled.info();
    extent_ = options_.blend.extent == Extent{} ? base_.map().extent(0) : options_.blend.extent;
    base_.place = stretch(extent_);
    base_.wrap_x = options_.blend.wrap_x;
    base_.wrap_y = options_.blend.wrap_y;
    return settle(base_, execution);
}

Result<void> Blending::open_detail(Input& input, const LayerFile& layer, const Layer& placed,
                                   const Execution& execution) {
    input.place = uv_map_of(placed, extent_);
    input.wrap_x = placed.wrap_x;
    input.wrap_y = placed.wrap_y;
    if (options_.shared) {
        const MapTransform place{input.place, input.wrap_x, input.wrap_y};
        auto held = options_.shared->get(layer.input, layer.source, place, execution);
        if (!held) return held.error();
        input.shared = std::move(*held);
        if (input.shared) input.info = input.shared->info;
        if (input.shared) return {};
    }
    if (!lies_flat(placed)) return hold(input, execution);
    if (Result<void> opened = input.settled.open(execution); !opened) return opened;
    input.info = input.settled.info();
    // What a mask mixes beside the normals is sampled from a map that is held.
    const ExtraSet mixed = input.settled.extras_taken() & extras_taken();
    if (layer.mask && (mixed.blue || mixed.alpha || mixed.length)) return hold(input, execution);
    return settle(input, execution);
}

Result<void> Blending::open(const Execution& execution) {
    const Execution silent = execution.quiet();
    if (Result<void> opened = open_base(silent); !opened) return opened;
    const Extent base = base_.step ? base_.map().extent(0) : base_.chain.levels.front().extent();
    for (const LayerFile& layer : options_.layers) {
        if (execution.progress && !execution.progress(0.0)) return Error{ErrorCode::cancelled, {}, "cancelled"};
        Layer& placed = layers_.emplace_back(layer.layer());
        Input& input = inputs_.emplace_back(layer.input, layer.source);
        if (Result<void> opened = open_detail(input, layer, placed, silent); !opened) return opened;
        const Extent detail = input.shared ? input.shared->chain.levels.front().extent()
                              : input.step ? input.map().extent(0)
                                           : input.chain.levels.front().extent();
        std::vector<std::string> remarks = {stretch_text(placed, detail, base, extent_),
                                            cut_text(placed, options_.blend)};
        if (options_.blend.extent == Extent{}) remarks.push_back(shrink_text(placed, detail, extent_));
        for (std::string& remark : remarks)
            if (!remark.empty()) input.info.remarks.push_back(std::move(remark));
        if (!layer.mask) continue;
        Result<Plane<float>> mask = layer.mask();
        if (!mask) return mask.error();
        placed.mask = std::move(*mask);
    }
    maps_.emplace(PlacedMaps{{}, {}, options_.blend, extent_});
    for (std::size_t k = 0; k < inputs_.size(); ++k) {
        Result<PlacedMap> placed = place(inputs_[k], silent);
        if (!placed) return placed.error();
        if (k == 0) maps_->base = *placed;
        if (k > 0) maps_->layers.push_back({layers_[k - 1], *placed});
    }
    return {};
}

Result<PlacedMap> Blending::place(Input& input, const Execution& execution) {
    if (input.shared) return placed_on(input.shared->chain, input.place, input.wrap_x, input.wrap_y);
    if (!input.step) return place_chain(input.chain, input.place, input.wrap_x, input.wrap_y, execution);
    const auto row = [&input](int j) { return input.rows->normals(j); };
    return PlacedMap{nullptr, row, extent_, input.place, input.wrap_x, input.wrap_y};
}

ExtraSet Blending::extras_taken() const {
    return base_.step ? base_.settled.extras_taken() : extras_of(base_.chain.levels.front());
}

Stage& Blending::add_to(Flow& flow, ExtraSet kept) {
    std::vector<MapInStep> in_step;
    for (Input& input : inputs_) {
        if (!input.step) continue;
        if (auto inspector = inspector_for(input.settled.options(), input.info, extent_))
            input.inspector.emplace(std::move(*inspector));
        const SourceOptions& source = input.settled.options();
        if (source.inspect)
            input.extra_inspector.emplace(input.map().head(), input.map().extent(0), input.settled.sources(), source);
        input.rows = &input.settled.add_to(flow, 0,
                                           {{},
                                            input.inspector ? &*input.inspector : nullptr,
                                            input.extra_inspector ? &*input.extra_inspector : nullptr,
                                            &input == &base_ ? kept : ExtraSet()});
        in_step.push_back({input.rows, *input.step});
    }
    return flow.add<BlendStage>(*maps_, std::move(in_step), kept, base_.rows);
}

void Blending::judge(ExtraSet accounted_for, ExtraSet kept) {
    for (std::size_t k = 0; k < inputs_.size(); ++k) {
        Input& input = inputs_[k];
        if (input.inspector) input.inspector->report(input.info);
        if (input.extra_inspector) input.info.others = input.extra_inspector->report(input.info);
        if (k == 0) input.info.others = left_out(std::move(input.info.others), accounted_for);
        if (k > 0 && !layers_[k - 1].mask.empty()) input.info.others = left_out(std::move(input.info.others), kept);
    }
}

std::vector<SourceInfo> Blending::details() const {
    std::vector<SourceInfo> details;
    for (std::size_t k = 1; k < inputs_.size(); ++k) details.push_back(inputs_[k].info);
    return details;
}

}  // namespace tex::inline v1
