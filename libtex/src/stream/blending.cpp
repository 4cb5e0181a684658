// SPDX-License-Identifier: Apache-2.0

#include "stream/blending.h"

#include <utility>

#include "stream/placed_map.h"

namespace tex {
namespace {

// Whether the rows of a detail can keep in step, as far as that can be decided without its extent.
bool lies_flat(const Layer& layer) {
    return layer.tiling_x == 1.0f && layer.tiling_y == 1.0f && layer.offset_y == 0.0f && layer.rotation == 0.0f;
}

}  // namespace

Blending::Blending(const std::string& input, const BlendFileOptions& options)
    : options_(options), base_(inputs_.emplace_back(input, options.source)) {}

Blending::Blending(MapSource& base, const BlendFileOptions& options)
    : options_(options), base_(inputs_.emplace_back(base, options.source)) {}

// Decides whether a map is read in step or held in memory.
Result<void> Blending::settle(Input& input, const Execution& execution) {
    if (const RowSource* rows = input.file.rows()) {
        input.step = rows_in_step(rows->extent(), extent_, input.map, input.wrap_x, input.wrap_y);
    }
    return input.step ? Result<void>() : input.file.hold(false, execution);
}

Result<void> Blending::open_detail(Input& input, const LayerFile& layer, const Layer& placed,
                                   const Execution& execution) {
    if (options_.shared) {
        auto held = options_.shared->get(layer.input, layer.source, {input.map, input.wrap_x, input.wrap_y}, execution);
        if (!held) return held.error();
        input.shared = std::move(*held);
        if (input.shared) return {};
    }
    if (lies_flat(placed)) {
        if (Result<void> opened = input.file.open(); !opened) return opened;
    }
    return settle(input, execution);
}

Result<void> Blending::open(const Execution& execution) {
    const Execution silent{execution.threads, {}};
    if (Result<void> opened = base_.file.open(); !opened) return opened;
    extent_ = options_.blend.extent;
    if (extent_ == Extent{} && base_.file.rows() != nullptr) extent_ = base_.file.rows()->extent();
    if (extent_ == Extent{}) {
        if (Result<void> held = base_.file.hold(false, silent); !held) return held;
        extent_ = base_.file.chain().levels.front().extent();
    }
    base_.map = stretch(extent_);
    base_.wrap_x = options_.blend.wrap_x;
    base_.wrap_y = options_.blend.wrap_y;
    if (base_.file.chain().levels.empty()) {
        if (Result<void> settled = settle(base_, silent); !settled) return settled;
    }
    for (const LayerFile& layer : options_.layers) {
        if (execution.progress && !execution.progress(0.0)) return Error{ErrorCode::cancelled, {}, "cancelled"};
        Layer& placed = layers_.emplace_back(layer.layer());
        Input& input = inputs_.emplace_back(layer.input, layer.source);
        input.map = uv_map_of(placed, extent_);
        input.wrap_x = placed.wrap_x;
        input.wrap_y = placed.wrap_y;
        if (Result<void> opened = open_detail(input, layer, placed, silent); !opened) return opened;
        if (!layer.mask) continue;
        Result<Plane<float>> mask = layer.mask();
        if (!mask) return mask.error();
        placed.mask = std::move(*mask);
    }
    return {};
}

Result<void> Blending::open_again() {
    for (Input& input : inputs_) {
        if (!input.step) continue;
        if (Result<void> again = input.file.open_again(); !again) return again;
    }
    return {};
}

Result<void> Blending::prepare() {
    for (Input& input : inputs_) {
        if (!input.step) continue;
        if (Result<void> ready = input.file.prepare(); !ready) return ready;
    }
    return {};
}

Result<void> Blending::settle_layouts() {
    for (Input& input : inputs_) {
        if (!input.step) continue;
        if (Result<void> known = input.file.settle_layout(); !known) return known;
    }
    return {};
}

bool Blending::was_right() {
    bool right = true;
    for (Input& input : inputs_) right = input.file.was_right() && right;
    return right;
}

std::vector<SourceInfo> Blending::details() const {
    std::vector<SourceInfo> details;
    for (std::size_t k = 1; k < inputs_.size(); ++k) {
        const Input& input = inputs_[k];
        details.push_back(input.shared ? input.shared->info : input.file.info());
    }
    return details;
}

Result<PlacedMap> Blending::place(Input& input, std::deque<ArrivingMap>& arriving, const Execution& execution) {
    if (input.shared) return placed_on(input.shared->chain, input.map, input.wrap_x, input.wrap_y);
    if (!input.step) return place_chain(input.file.chain(), input.map, input.wrap_x, input.wrap_y, execution);
    MapFile& file = input.file;
    input.inspector.reset();
    if (auto inspector = inspector_for(file.options(), file.info(), extent_))
        input.inspector.emplace(std::move(*inspector));
    ArrivingMap& map = arriving.emplace_back(file.texture(), extent_, file.sources(), file.rule(), file.finder(),
                                             input.inspector ? &*input.inspector : nullptr, *input.step);
    return PlacedMap{nullptr, [&map](int j) { return map.row(j); }, extent_, input.map, input.wrap_x, input.wrap_y};
}

void Blending::judge(SourceInfo& base, std::vector<SourceInfo>& details) {
    for (std::size_t k = 0; k < inputs_.size(); ++k) {
        SourceInfo& info = k == 0 ? base : details[k - 1];
        if (inputs_[k].inspector) inputs_[k].inspector->report(info);
    }
}

Result<std::unique_ptr<Blending::Reading>> Blending::read(const Execution& execution) {
    auto reading = std::make_unique<Reading>(options_.blend, extent_);
    std::vector<JoinedRows::Member> members;
    for (std::size_t k = 0; k < inputs_.size(); ++k) {
        Result<PlacedMap> placed = place(inputs_[k], reading->arriving, execution);
        if (!placed) return placed.error();
        if (k == 0) reading->maps.base = *placed;
        if (k > 0) reading->maps.layers.push_back({layers_[k - 1], *placed});
        if (!inputs_[k].step) continue;
        reading->in_step.push_back(&reading->arriving.back());
        members.push_back({inputs_[k].file.rows(), &inputs_[k].file.path()});
    }
    // The planes of each map follow those of the maps before it.
    std::size_t planes = 0;
    for (Input& input : inputs_) {
        if (!input.step) continue;
        for (std::size_t& plane : input.file.texture().planes) plane += planes;
        planes += input.file.rows()->names().size();
    }
    reading->rows.emplace(extent_, std::move(members));
    return reading;
}

}  // namespace tex
