// SPDX-License-Identifier: Apache-2.0

#include "tasks/outcome.h"

#include <fmt/format.h>

namespace tex::cli {

void Reporter::finish(std::size_t place, Outcome outcome) {
    const std::lock_guard lock(mutex_);
    if (when_ == Printed::at_once) return report(outcome);
    waiting_[place] = std::move(outcome);
    for (; reported_ < waiting_.size() && waiting_[reported_]; ++reported_) {
        report(*waiting_[reported_]);
        waiting_[reported_].reset();
    }
}

void Reporter::report_waiting() {
    const std::lock_guard lock(mutex_);
    for (; reported_ < waiting_.size(); ++reported_) {
        if (waiting_[reported_]) report(*waiting_[reported_]);
    }
}

void Reporter::report(const Outcome& outcome) {
    for (const FileWarning& warning : outcome.warnings) {
        const bool has_input = outcome.is_joint || warning.file == outcome.name ||
                               warning.file.starts_with(outcome.name + ": ");  // a map of the model
        const std::string prefix = has_input ? "" : outcome.name + ": ";
        console_.warning(fmt::format("{}{}: {}", prefix, warning.file, warning.message));
    }
    if (outcome.error) {
        if (outcome.error->code == ErrorCode::cancelled) return;
        const Error error = outcome.error->of(outcome.name);
        if (!outcome.is_silent) console_.error(error.message());
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
        print_result(json_line(outcome));
    } else if (!outcome.text.empty()) {
        print_result(outcome.text);
    }
}

std::string Reporter::json_line(const Outcome& outcome) {
    Json line;
    line["input"] = outcome.input;
    if (outcome.error) {
        line["error"] = error_json(*outcome.error, outcome.name);
    } else {
        if (outcome.has_levels) {
            line["output"] = outcome.outputs;
        } else if (!outcome.outputs.empty()) {
            line["output"] = outcome.outputs.front();
        }
        line.update(outcome.report);
    }
    std::vector<FileWarning> warnings = outcome.warnings;
    warnings.insert(warnings.end(), outcome.remarks.begin(), outcome.remarks.end());
    line["warnings"] = warnings_json(warnings);
    line["seconds"] = outcome.seconds;
    return to_report_line(line);
}

void Reporter::print_result(const std::string& text) {
    if (console_.print(text) == ExitCode::done) return;
    raise(ExitCode::io);
    is_abandoned_ = true;
}

}  // namespace tex::cli
