// SPDX-License-Identifier: Apache-2.0
// junit.h: check reports as JUnit XML, which GitLab and Jenkins show as tests.

#pragma once

#include <string>
#include <vector>

#include <tex/check.h>

namespace tex::cli {

// What was found in a file, and what was demanded of it.
struct JudgedReport {
    CheckReport report;
    Requirements require;
    Severity fail_on = Severity::error;
    std::vector<Finding> waived = {};         // by the baseline
    double seconds = 0.0;                     // that the check took
    const Plane<float>* occlusion = nullptr;  // beside the map, for its pictures; must outlive the documents
    std::string occlusion_file = {};          // where it is from

    // The file could not be read, and the baseline does not know its damage.
    [[nodiscard]] bool is_unreadable() const { return report.error && waived.empty(); }
};

// One test case for each file: a failure with the findings at or above its `fail_on`; an error if the file could not be
// read. Lesser findings become its output.
[[nodiscard]] std::string junit_text(const std::vector<JudgedReport>& reports);

}  // namespace tex::cli
