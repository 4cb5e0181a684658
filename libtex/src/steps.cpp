// SPDX-License-Identifier: Apache-2.0
// Joins the steps; stream/made_map.cpp makes the rows of those before the last.

#include <tex/pipeline.h>

#include "rows/usable.h"
#include "stream/blend_stream.h"
#include "stream/made_map.h"
#include "stream/pack_stream.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

struct LastStep {
    MapSource* map;  // null if the last step is the only one, which reads the file itself
    const std::string& input;
    const std::string& output;
    const Container container;
    const Execution& execution;
    StepsReport& report;

    Result<void> operator()(const BakeFileOptions& options) const {
        const Result<BakeFileReport> done = bake_file(input, output, container, options, execution);
        if (!done) return done.error();
        report.pack = options.pack;
        report.heights = done->heights;
        report.strength = done->strength;
        report.on_ground = done->on_ground;
        report.usual_slope = done->usual_slope;
        report.border_ratio = done->border_ratio;
        report.auto_strength = done->auto_strength;
        report.steep_texels = done->steep_texels;
        return take(*done);
    }
    Result<void> operator()(const PackFileOptions& options) const {
        const Result<PackFileReport> done = map == nullptr ? pack_file(input, output, container, options, execution)
                                                           : pack_stream(*map, output, container, options, execution);
        if (!done) return done.error();
        report.pack = done->pack;
        if (map != nullptr) map->report(report);
        report.maps.push_back({input, done->source});
        return take(*done);
    }
    Result<void> operator()(const BlendFileOptions& options) const {
        const Result<BlendFileReport> done = map == nullptr ? blend_file(input, output, container, options, execution)
                                                            : blend_stream(*map, output, container, options, execution);
        if (!done) return done.error();
        report.pack = done->pack;
        if (map != nullptr) map->report(report);
        report.maps.push_back({input, done->source});
        for (std::size_t k = 0; k < done->details.size(); ++k)
            report.maps.push_back({options.layers[k].input, done->details[k]});
        return take(*done);
    }

private:
    template <class Report>
    Result<void> take(const Report& done) const {
        report.extent = done.extent;
        report.levels = done.levels;
        report.left_out = done.left_out;
        report.bytes = done.bytes;
        return {};
    }
};

}  // namespace

Result<void> validate(const std::vector<Step>& steps) {
    if (steps.empty()) return bad_option("steps: there must be at least one");
    for (std::size_t k = 0; k < steps.size(); ++k) {
        const auto of_step = [](const auto& options) { return validate(options); };
        if (auto valid = std::visit(of_step, steps[k]); !valid) return valid;
        if (k > 0 && std::holds_alternative<BakeFileOptions>(steps[k]))
            return bad_option("steps: only the first one can bake");
        const auto* pack = std::get_if<PackFileOptions>(&steps[k]);
        if (k + 1 < steps.size() && pack != nullptr && (pack->mip || pack->roughness))
            return bad_option("steps: only the last one can build levels or write roughness");
    }
    return {};
}

Result<StepsReport> apply_steps(const std::string& input, const std::vector<Step>& steps, const std::string& output,
                                Container container, const Execution& execution) {
    return no_throw([&]() -> Result<StepsReport> {
        if (auto valid = validate(steps); !valid) return valid.error();
        StepsReport report;
        const std::unique_ptr<MapSource> map = made_map(input, steps, steps.size() - 1, execution);
        const LastStep last{map.get(), input, output, container, execution, report};
        if (const Result<void> done = std::visit(last, steps.back()); !done) return done.error().of(input);
        return report;
    });
}

}  // namespace tex::inline v1
