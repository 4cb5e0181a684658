// SPDX-License-Identifier: Apache-2.0
// report_file.h: the option --report of commands that make files, and its page.

#pragma once

#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/console.h"
#include "reports/html_report.h"
#include "tasks/collisions.h"
#include "tasks/task.h"

namespace tex::cli {

// Adds --report, which is `rank` among the options that are used often. `help` says what the page has, `often` in
// brief.
void add_report_option(Command& command, std::string& path, const char* help, int rank, const char* often);

// Throws UsageError if the page is a file that the tasks read or write, or one of `others`.
void check_report(const std::string& path, const std::vector<Task>& tasks, std::vector<NamedFile> others);

// Writes the page, if it is wanted.
[[nodiscard]] ExitCode write_report(const std::string& path, const HtmlReport& page, const std::string& summary,
                                    Console& console);

}  // namespace tex::cli
