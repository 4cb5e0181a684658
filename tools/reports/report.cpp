// SPDX-License-Identifier: Apache-2.0

#include "reports/report.h"

#include <fmt/format.h>

#include "cli/console.h"
#include "cli/stream.h"

namespace tex::cli {

void Reporter::finish(std::size_t place, Outcome outcome) {
    const std::lock_guard lock(mutex_);
    waiting_[place] = std::move(outcome);
    for (; told_ < waiting_.size() && waiting_[told_]; ++told_) {
        tell(*waiting_[told_]);
        waiting_[told_].reset();
    }
}

void Reporter::tell(const Outcome& outcome) {
    for (const std::string& warning : outcome.warnings) print_warning(fmt::format("{}: {}", outcome.input, warning));
    if (outcome.error) {
        if (outcome.error->code == ErrorCode::cancelled) return;
        const Error error = outcome.error->of(outcome.input);
        if (!outcome.is_silent) print_error(error.message());
        raise(outcome.is_bug ? ExitCode::bug : cli::exit_code(error.code));
    } else {
        ++done_;
    }
    if (!outcome.outputs.empty()) {
        Dependency& dependency = dependencies_.emplace_back(Dependency{outcome.outputs, {outcome.input}});
        dependency.inputs.insert(dependency.inputs.end(), outcome.prerequisites.begin(), outcome.prerequisites.end());
    }
    raise(outcome.code);
    if (is_abandoned_) return;
    if (json_) {
        tell_json(outcome);
    } else if (!outcome.text.empty()) {
        print_result(outcome.text);
    }
}

void Reporter::tell_json(const Outcome& outcome) {
    Json line;
    line["input"] = outcome.input;
    if (outcome.error) {
        line["error"] = error_json(*outcome.error, outcome.input);
    } else {
        if (outcome.has_levels) {
            line["output"] = outcome.outputs;
        } else if (!outcome.outputs.empty()) {
            line["output"] = outcome.outputs.front();
        }
        line.update(outcome.report);
    }
    print_result(to_line(line));
}

void Reporter::print_result(const std::string& text) {
    clear_progress();
    if (print(text) == ExitCode::done) return;
    raise(ExitCode::io);
    is_abandoned_ = true;
}

}  // namespace tex::cli
