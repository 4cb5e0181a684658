// SPDX-License-Identifier: Apache-2.0
// repeated_warnings.h: warnings that many files of a run may call for in the same words. Each is printed once, at the
// end of the run, with the number of its files.

#pragma once

#include <map>
#include <mutex>
#include <string>

#include "cli/console.h"
#include "tasks/job.h"

namespace tex::cli {

class RepeatedWarnings {
public:
    // Adds a warning about `path`, which stands in the JSON of its job. Any thread may call this.
    void add(Job& job, const std::string& path, const std::string& sentence) {
        job.remark(sentence, path, true);
        add(path, sentence);
    }
    void add(const std::string& path, const std::string& sentence) {
        const std::lock_guard lock(mutex_);
        Files& files = files_[sentence];
        // Files that are read in parallel arrive in any order. The alphabetically first one is named.
        if (files.count++ == 0 || path < files.first) files.first = path;
    }

    // Prints each sentence with the first of its files.
    void print(Console& console) const;

private:
    struct Files {
        std::string first;
        int count = 0;
    };
    std::mutex mutex_;
    std::map<std::string, Files> files_;  // by sentence
};

}  // namespace tex::cli
