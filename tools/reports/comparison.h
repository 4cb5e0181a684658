// SPDX-License-Identifier: Apache-2.0
// comparison.h: the figures of compare-normals as text and as JSON, and the option groups of the files that it writes.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tex/check.h>

#include "cli/command.h"
#include "cli/json.h"
#include "reports/html_report.h"

namespace tex::cli {

// What every line of JSON contains.
struct ComparisonRun {
    std::vector<std::string> inputs;  // the two files
    const std::vector<FileWarning>& warnings;
    Clock::time_point start = Clock::now();
    std::string material = {};  // of the maps in models that are compared
};

// Prints the figures of a level: as a line of a table (the first line has a heading above it) or as JSON.
[[nodiscard]] ExitCode print_level(Console& console, const ComparisonRun& run, const ComparedLevel& level, bool as_json,
                                   bool is_first);
// What the comparisons of two folders found, as their last line.
class FolderTally {
public:
    void add(const std::string& name, const AngularError& error) {
        ++maps_;
        if (error.max > 0.0) ++different_;
        if (error.mean <= most_) return;
        most_ = error.mean;
        most_of_ = name;
    }
    void add_failure() { ++failed_; }
    void add_alone(std::size_t files) { alone_ += files; }  // which have no partner
    [[nodiscard]] std::string text() const;

private:
    int maps_ = 0, different_ = 0, failed_ = 0;
    std::size_t alone_ = 0;
    double most_ = 0.0;  // the largest mean angle, in degrees
    std::string most_of_;
};

// Prints a failure as JSON.
[[nodiscard]] ExitCode print_failure(Console& console, const ComparisonRun& run, const Error& error);

// --heatmap, --heatmap-scale, --report, --depfile.
class CompareDocuments {
public:
    void add(Command& command);

    [[nodiscard]] bool has_heat_map() const { return !heat_map_path_.empty(); }
    [[nodiscard]] bool has_page() const { return !page_path_.empty(); }

    // Throws UsageError if a document cannot be written, is an input, or is another document.
    void check(const std::vector<std::string>& inputs) const;

    // Writes the picture of the angles, if the user requests it.
    [[nodiscard]] Result<void> write_heat_map(const Comparison& comparison) const;

    // Adds a pair of maps to the page. `degrees` are the angles of the first level in `levels`.
    [[nodiscard]] Result<void> add_pair(const std::vector<ComparedLevel>& levels, HtmlMap a, HtmlMap b,
                                        const Plane<float>& degrees);
    void add_failure(const std::string& name, const Error& error);

    // Writes the page, if the user requests it. `summary` is its first sentence; empty: the figures of its only pair.
    [[nodiscard]] Result<void> write_page(const std::string& summary) const;

    // Writes what the documents were made from, if the user requests it.
    [[nodiscard]] Result<void> write_depfile(const std::vector<std::string>& inputs) const;

private:
    std::string heat_map_path_, page_path_, depfile_;  // or empty
    std::optional<double> heat_map_scale_;             // degrees; none: the largest angle
    HtmlReport page_{"compare-normals", compare_columns()};
    std::string figures_;  // of the last pair
};

}  // namespace tex::cli
