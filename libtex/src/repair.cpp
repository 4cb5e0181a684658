// SPDX-License-Identifier: Apache-2.0

#include <tex/repair.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tex/format.h>
#include <tex/pack.h>

#include "fields/field_check.h"
#include "fields/repair_fields.h"
#include "repairs/green_parts.h"
#include "repairs/outcome.h"
#include "repairs/repair_plan.h"
#include "repairs/stored_levels.h"
#include "repairs/texel_steps.h"
#include "rows/usable.h"
#include "threads/no_throw.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

constexpr double kFirstCheck = 0.5;  // of the progress
constexpr double kFarLean = 20.0;    // degrees that a map leans after z was rebuilt, so that x and y were changed, too
constexpr int kMostStepsOfRow = 2;   // blue, green, red order takes one step, other orders two

bool names(const std::vector<std::string>& list, const Rule& rule) {
    return std::any_of(list.begin(), list.end(), [&](const std::string& name) { return find_rule(name) == &rule; });
}

bool takes_part(const RepairOptions& options, const Rule& rule) {
    return (options.only.empty() || names(options.only, rule)) && !names(options.skip, rule);
}

// The texture as it stands, and how it looks to the rules.
struct State {
    Texture texture;
    CheckReport report;
};

class Plan {
public:
    Plan(const std::string& file, const Texture& source, const RepairOptions& options, const Execution& execution)
        : file_(file), source_(source), options_(options), checks_(options.checks), whole_(execution),
          execution_(execution.quiet()) {
        // How many steps there will be, nobody knows, but each may be cancelled.
        if (whole_.progress) execution_.progress = [this](double) { return whole_.progress(kFirstCheck); };
    }

    Result<Repaired> run() {
        auto before = check(file_, source_, options_.checks, part_of(whole_, 0.0, kFirstCheck));
        if (!before) return before.error();
        Repaired done;
        report_ = *before;
        done.before = std::move(*before);
        if (auto stepped = take_steps(done); !stepped) return stepped.error();
        if (auto guessed = guess_first_step(done); !guessed) return guessed.error();
        if (checks_.disable.size() > options_.checks.disable.size()) {
            auto after = check(file_, current(), options_.checks, execution_);
            if (!after) return after.error();
            report_ = std::move(*after);
        }
        for (const Finding& finding : report_.findings) {
            if (!takes_part(options_, *finding.rule)) continue;
            const auto step = first_step(finding, report_, known());
            const bool was_tried = step && is_allowed(*step);
            done.left.push_back({finding, step && !was_tried ? step->certainty : RepairClass::never});
        }
        done.after = std::move(report_);
        if (!done.steps.empty()) done.texture = std::move(made_);
        return done;
    }

private:
    Result<void> take_steps(Repaired& done) {
        for (bool goes_on = true; goes_on;) {
            auto stepped = next_step(done);
            if (!stepped) return stepped.error();
            goes_on = *stepped;
        }
        return {};
    }

    // Two damages can hide each other, so that the picture seems to be no normal map at all. Undoes one that may have
    // happened, and then what the rules find. Stays with the first guess that leaves no error.
    Result<void> guess_first_step(Repaired& done) {
        const Finding* const colors = find_finding(report_, "N214");
        const Finding* const found = colors != nullptr ? colors : find_finding(report_, "N213");
        if (found == nullptr || !options_.likely || !takes_part(options_, *found->rule)) return {};
        if (!levels_) {
            auto decoded = decode_current();
            if (!decoded) return decoded.error();
            levels_ = std::move(*decoded);
        }
        const StoredLevels before = levels_->clone();
        const std::optional<Texture> texture = std::move(made_);
        const CheckReport report = std::move(report_);
        const std::vector<int> tries = tries_;
        const std::size_t steps = done.steps.size();
        const auto go_back = [&] {
            levels_ = before.clone();
            made_ = texture;
            report_ = report;
            tries_ = tries;
            done.steps.resize(steps);
        };
        go_back();
        for (RepairStep& step : guesses_for(*found->rule, report)) {
            auto state = try_step(step);
            if (!state) return state.error();
            if (!*state) continue;
            take(step, **state, done);
            if (auto taken = take_steps(done); !taken) return taken;
            const bool has_errors = std::any_of(report_.findings.begin(), report_.findings.end(),
                                                [](const Finding& f) { return f.severity == Severity::error; });
            // The rules must have found the other one.
            // A z that was rebuilt from x and y agrees with any curve.
            const bool is_curve = takes_curve_back(step.kind);
            const auto proofs = std::count_if(done.steps.begin(), done.steps.end(), [&](const RepairStep& s) {
                return s.rule->id != "N214" && s.rule->id != "N213" && proves(s.kind) &&
                       !(is_curve && s.kind == RepairKind::rebuild_z);
            });
            const bool is_right = !has_errors && proofs > 0;
            if (is_right) return {};
            go_back();
        }
        return {};
    }

    void take(const RepairStep& step, State& state, Repaired& done) {
        made_ = std::move(state.texture);
        report_ = std::move(state.report);
        done.steps.push_back(step);
    }

    // Finds and takes the first step that removes its finding. Returns whether there was one.
    Result<bool> next_step(Repaired& done) {
        const std::span<const RuleRepair> rows = rule_repairs();
        tries_.resize(rows.size());
        const bool has_curve = std::any_of(done.steps.begin(), done.steps.end(),
                                           [](const RepairStep& step) { return takes_curve_back(step.kind); });
        for (std::size_t k = 0; k < rows.size(); ++k) {
            const Finding* const finding = find_finding(report_, rows[k].rule);
            if (finding == nullptr || !takes_part(options_, *finding->rule) || tries_[k] == kMostStepsOfRow) continue;
            const Finding found = *finding;
            auto steps = steps_of(rows[k], found);
            if (!steps) return steps.error();
            for (RepairStep& step : *steps) {
                if (!is_allowed(step) || (has_curve && takes_curve_back(step.kind))) continue;
                auto state = try_step(step);
                if (!state) {
                    if (state.error().code != ErrorCode::unsupported) return state.error();
                    continue;
                }
                if (!*state) continue;
                ++tries_[k];
                take(step, **state, done);
                return true;
            }
            const bool is_last = k + 1 == rows.size() || rows[k + 1].rule != rows[k].rule;
            if (is_last && !steps->empty() && is_allowed(steps->front())) return set_aside(*found.rule);
        }
        return false;
    }

    [[nodiscard]] bool is_allowed(const RepairStep& step) const {
        return step.certainty == RepairClass::safe || (options_.likely && step.certainty == RepairClass::likely);
    }

    // No step removes the finding of this rule, so it may be a false one, and what it explains may be true.
    Result<bool> set_aside(const Rule& rule) {
        checks_.disable.emplace_back(rule.id);
        auto report = check(file_, current(), checks_, execution_);
        if (!report) return report.error();
        report_ = std::move(*report);
        return true;
    }

    [[nodiscard]] KnownOfMap known() const {
        return {options_.checks.require.y.has_value() || current().y_known, options_.mirrored,
                options_.bumpiness.has_value(), options_.turned, options_.checks.height != nullptr};
    }

    Result<std::vector<RepairStep>> steps_of(const RuleRepair& row, const Finding& finding) {
        std::vector<RepairStep> steps = steps_for(row, finding, report_, known());
        const bool is_taken = row.certainty == RepairClass::safe || options_.likely;
        if (row.kind != RepairKind::invert_part || steps.empty() || !is_taken) return steps;
        if (!levels_) {
            auto decoded = decode_current();
            if (!decoded) return decoded.error();
            levels_ = std::move(*decoded);
        }
        const RepairStep step = steps.front();
        steps.clear();
        for (const Region& part : green_parts(levels_->stored(0), finding.regions)) {
            steps.push_back(step);
            steps.back().part = part;
            // Without a direction that is required, that of more regions stays.
            if (!options_.checks.require.y) continue;
            steps.push_back(step);
            steps.back().part = rest_of(part, levels_->stored(0).extent());
        }
        return steps;
    }

    [[nodiscard]] const Texture& current() const { return made_ ? *made_ : source_; }

    // The state after a step; nothing if the finding stays. Fills in the step's angle.
    Result<std::optional<State>> try_step(RepairStep& step) {
        StoredLevels levels;
        if (levels_) {
            levels = levels_->clone();
        } else {
            auto decoded = decode_current();
            if (!decoded) return decoded.error();
            levels = std::move(*decoded);
        }
        State state;
        const Finding* const before = find_finding(report_, step.rule->id);
        const double figure = before ? before->figure : 0.0;
        if (changes_texels(step.kind)) {
            if (auto applied = apply_step(step, figure, options_, current(), levels, execution_); !applied)
                return applied.error();
            if (step.kind == RepairKind::invert && (step.rule->id == "N401" || step.rule->id == "N112")) {
                levels.head.y_axis = *options_.checks.require.y;
                levels.head.y_known = true;
            }
            auto encoded = encode_levels(levels, options_.effort, execution_);
            if (!encoded) return encoded.error();
            state.texture = std::move(*encoded);
        } else {
            state.texture = restated(step);
            levels.head.srgb = state.texture.srgb;
            levels.head.y_axis = state.texture.y_axis;
            levels.head.y_known = state.texture.y_known;
        }
        auto report = check(file_, state.texture, checks_, execution_);
        if (!report) return report.error();
        if (!is_gone(*report, step, figure) || contradicts(step, *report)) return std::optional<State>();
        const auto degrees = mean_change(current(), state.texture, execution_);
        if (!degrees) return degrees.error();
        step.degrees = *degrees;
        state.report = std::move(*report);
        if (step.kind == RepairKind::change_sign) {
            levels_.reset();  // decoded from other bytes
        } else {
            levels_ = std::move(levels);
        }
        return std::optional<State>(std::move(state));
    }

    Result<StoredLevels> decode_current() {
        return decode_levels(current(), report_.swizzle, report_.more_data, execution_);
    }

    [[nodiscard]] static bool changes_texels(RepairKind kind) {
        return kind != RepairKind::change_sign && kind != RepairKind::drop_srgb && kind != RepairKind::state_y;
    }

    // The texture with another statement about its bytes.
    [[nodiscard]] Texture restated(const RepairStep& step) const {
        Texture texture = current();
        texture.remarks.clear();
        texture.trailing_bytes = 0;
        if (step.kind == RepairKind::drop_srgb) texture.srgb = false;
        if (step.kind == RepairKind::state_y) {
            texture.y_axis = report_.y.y.value_or(texture.y_axis);
            texture.y_known = true;
        }
        if (step.kind == RepairKind::change_sign) {
            FormatInfo info = format_info(texture.format);
            info.sample = info.sample == SampleKind::unorm ? SampleKind::snorm : SampleKind::unorm;
            for (const auto& row : kFormatNames) {
                if (format_info(row.value) == info) texture.format = row.value;
            }
        }
        return texture;
    }

    // Whether the map shows that the step was not the right one. x and y that were exchanged show the direction of
    // green again that is required or stated; a picture that was turned by 90 degrees shows the other one. After the
    // right turn, slopes follow the heights. Numbers read with the right sign do not lean, nor does a z that was lost.
    [[nodiscard]] bool contradicts(const RepairStep& step, const CheckReport& report) const {
        if (step.kind == RepairKind::change_sign) return find_finding(report, "N207") != nullptr;
        if (step.kind == RepairKind::invert_part) return find_finding(report, "N401") != nullptr;
        // What moved x and y, as brightness does, cut z off: with z of x and y as they are, all would lean more.
        if (step.kind == RepairKind::rebuild_z && !options_.likely) {
            const Finding* const leaning = find_finding(report, "N207");
            return leaning != nullptr && leaning->figure > kFarLean;
        }
        const bool is_by_heights = step.rule->id == "N601";
        const bool turns = step.kind == RepairKind::turn_left || step.kind == RepairKind::turn_right;
        if (turns && options_.turned && !is_by_heights) return false;
        const bool exchanges_xy =
            step.kind == RepairKind::exchange && step.rule->id == "N308" && step.certainty == RepairClass::likely;
        if (!turns && !is_by_heights && !exchanges_xy) return false;
        const std::optional<YAxis> wanted =
            options_.checks.require.y ? options_.checks.require.y : std::optional(current().y_axis);
        if (turns || is_by_heights)
            return !report.pair || !report.pair->decides() || report.pair->strength < 0.0 || report.pair->y != wanted;
        return report.y.y != wanted;
    }

    const std::string& file_;
    const Texture& source_;
    const RepairOptions& options_;
    CheckOptions checks_;  // without the rules that were set aside
    const Execution& whole_;
    Execution execution_;  // of all that follows the first check
    std::optional<Texture> made_;
    std::optional<StoredLevels> levels_;  // of made_, before they were rounded
    CheckReport report_;
    std::vector<int> tries_;
};

}  // namespace

bool Repaired::has_errors() const {
    return std::any_of(left.begin(), left.end(),
                       [](const FaultLeft& fault) { return fault.finding.severity == Severity::error; });
}

Result<void> validate(const RepairOptions& options) {
    if (options.checks.mesh != nullptr || options.checks.model != nullptr)
        return bad_option("checks: a repair looks at a map alone, without mesh and model");
    for (const auto* list : {&options.only, &options.skip}) {
        for (const std::string& name : *list) {
            if (find_rule(name) == nullptr) return bad_option("there is no rule '" + name + "'");
        }
    }
    return first_error(check_fields(options), validate(options.checks));
}

Result<Repaired> repair(const std::string& file, const Texture& texture, const RepairOptions& options,
                        const Execution& execution) {
    return no_throw([&]() -> Result<Repaired> {
        if (auto usable = check_usable(texture); !usable) return usable.error();
        if (auto valid = validate(options); !valid) return valid.error();
        auto repaired = Plan(file, texture, options, execution).run();
        if (repaired && execution.progress && !execution.progress(1.0))
            return Error{ErrorCode::cancelled, {}, "cancelled"};
        return repaired;
    });
}

}  // namespace tex::inline v1
