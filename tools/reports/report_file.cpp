// SPDX-License-Identifier: Apache-2.0

#include "reports/report_file.h"

#include <utility>

#include "cli/text_file.h"
#include "cli/usage_error.h"

namespace tex::cli {

void add_report_option(Command& command, std::string& path, const char* help, int rank, const char* often) {
    command.output_file(path, "--report", help).often(rank, often);
    command.check([&command] {
        if (command.given("--report") && command.given("--update"))
            throw UsageError("--report and --update contradict each other: what is skipped is not in the page");
    });
}

void check_report(const std::string& path, const std::vector<Task>& tasks, std::vector<NamedFile> others) {
    if (path.empty()) return;
    std::vector<std::string> inputs;
    for (const Task& task : tasks) {
        inputs.push_back(task.input);
        for (std::string& file : task.prerequisites()) inputs.push_back(std::move(file));
        for (const std::string& output : task.outputs()) {
            if (!output.empty() && output != "-") others.push_back({"the output", output});
        }
    }
    check_document({"--report", path}, inputs, others);
}

ExitCode write_report(const std::string& path, const HtmlReport& page, const std::string& summary, Console& console) {
    if (path.empty()) return ExitCode::done;
    const auto written = write_document(path, page.page(summary));
    if (written) return ExitCode::done;
    console.error(written.error().message());
    return exit_code(written.error().code);
}

}  // namespace tex::cli
