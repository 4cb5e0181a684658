// SPDX-License-Identifier: Apache-2.0
// repair_report.h: the page of repair-normals: --report.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <tex/repair.h>

#include "cli/command.h"
#include "reports/html_report.h"
#include "tasks/collisions.h"
#include "tasks/job.h"

namespace tex::cli {

class RepairReport {
public:
    RepairReport();

    void add(Command& command);

    [[nodiscard]] bool is_given() const { return !path_.empty(); }

    // Throws UsageError if the page is a file that the tasks read or write, or one of `others`.
    void check(const std::vector<Task>& tasks, std::vector<NamedFile> others);

    // Adds a map, before and after. `y` is the direction in which green is read in both. Any thread may call these
    // functions. Errors: those of the verbs.
    [[nodiscard]] Result<void> add(Job& job, const std::string& name, const Texture& source, const Repaired& repaired,
                                   std::optional<YAxis> y);
    void add_failure(const Job& job, const Error& error);

    // Writes the page, if it is wanted. `summary` is its first sentence.
    [[nodiscard]] ExitCode write(Console& console, const std::string& summary) const;

private:
    std::string path_;
    HtmlSizes sizes_;
    HtmlReport page_;
};

}  // namespace tex::cli
