// SPDX-License-Identifier: Apache-2.0
// job.h: the state of one file while a command processes it.

#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <tex/file.h>
#include <tex/pipeline.h>
#include <tex/types.h>

#include "cli/console.h"
#include "cli/exit_code.h"
#include "cli/json.h"
#include "tasks/task.h"

namespace tex::cli {

class Job {
public:
    // `advance` takes the fraction of the job that is done, and a few words about how it goes on, which may be empty.
    // It returns false if the job must stop.
    Job(const Task& its_task, Console& its_console, const ReadOptions& read, const WriteOptions& write, int threads,
        std::function<bool(double fraction, const std::string& words)> advance)
        : task(its_task), console(its_console), read_options(read), write_options(write), threads_(threads),
          advance_(std::move(advance)) {}

    const Task& task;
    Console& console;
    const ReadOptions& read_options;
    const WriteOptions& write_options;
    Json report;                              // what --json prints about this file, besides input and output
    std::shared_ptr<SharedMaps> shared_maps;  // detail maps that many jobs blend; null: each job reads its own

    // The Execution for the next verb. The verb's progress counts as the job's progress from the end of the previous
    // step to `fraction`.
    [[nodiscard]] Execution until(double fraction) {
        const double from = reached_;
        reached_ = fraction;
        return {threads_, [this, from, fraction](double done) { return advance(from + (fraction - from) * done); }};
    }
    // For steps that take no Execution. Returns false if the job must stop.
    [[nodiscard]] bool reached(double fraction) {
        reached_ = fraction;
        return advance(fraction);
    }
    // What is shown beside the progress from now on; empty: nothing.
    void show(std::function<std::string()> words) { words_ = std::move(words); }

    [[nodiscard]] int threads() const { return threads_; }

    // Printed after "FILE: ", the input. `file` is the file that the warning is about, if it is another one.
    void warn(std::string sentence, const std::string& file = {}) {
        warnings_.push_back({name_for(file), std::move(sentence)});
    }
    // A warning that the command prints once for many files: only --json prints it for each.
    void remark(std::string sentence, const std::string& file = {}, bool is_counted = false) {
        remarks_.push_back({name_for(file), std::move(sentence), is_counted});
    }
    void say(std::string_view text) { text_ += text; }  // on standard output, unless --json is given
    // The run exits with this code or a higher one. `why` is for build-normals: a clause without the name of the file.
    void raise(ExitCode code, std::string why = {}) {
        code_ = std::max(code_, code);
        if (!why.empty()) why_ = std::move(why);
    }
    void wrote(std::string path) { outputs_.push_back(std::move(path)); }

    // Takes over what a job for a part of this one has warned of and said.
    void take(const Job& part) {
        warnings_.insert(warnings_.end(), part.warnings_.begin(), part.warnings_.end());
        remarks_.insert(remarks_.end(), part.remarks_.begin(), part.remarks_.end());
        text_ += part.text_;
        raise(part.code_);
    }

    [[nodiscard]] const std::vector<FileWarning>& warnings() const { return warnings_; }
    [[nodiscard]] const std::vector<FileWarning>& remarks() const { return remarks_; }
    [[nodiscard]] const std::vector<std::string>& outputs() const { return outputs_; }
    [[nodiscard]] const std::string& text() const { return text_; }
    [[nodiscard]] ExitCode code() const { return code_; }
    [[nodiscard]] const std::string& why() const { return why_; }

private:
    // A warning about the whole mesh is not one about a tile of it.
    [[nodiscard]] std::string name_for(const std::string& file) const {
        const bool is_input = file.empty() || (file == task.input && !task.is_tile_of_mesh());
        return is_input ? task.name() : file;
    }
    [[nodiscard]] bool advance(double fraction) const { return advance_(fraction, words_ ? words_() : std::string()); }

    int threads_;
    std::function<bool(double, const std::string&)> advance_;
    std::function<std::string()> words_;
    double reached_ = 0.0;
    std::vector<FileWarning> warnings_, remarks_;
    std::vector<std::string> outputs_;
    std::string text_;
    ExitCode code_ = ExitCode::done;
    std::string why_;
};

}  // namespace tex::cli
