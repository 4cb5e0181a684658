// SPDX-License-Identifier: Apache-2.0
// html_report.h: what a command found, as one HTML file that needs no other file: --report.
//
// The page holds a table of its entries, and for each entry its figures, still pictures and the levels of its maps, on
// which a reader with JavaScript and WebGL moves a light. Its parts are tools/reports/report_page.html, .css and .js,
// which the build puts into the program.
//
// The bytes depend on the entries alone: no time, no host, no order in which files ended.

#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <tex/check.h>
#include <tex/compare.h>

#include "reports/html_map.h"

namespace tex::cli {

// The most that pictures and levels take in a page, in characters. Where there are more, levels are left out, the
// largest first.
inline constexpr std::size_t kHtmlBudget = 18'000'000;

// One row of the table and one section.
struct HtmlEntry {
    std::string title;
    std::string row;                  // the cells after the title's, as HTML
    std::string words;                // what the page's filter looks at: "error", "warning", "note", "clean"
    std::string body;                 // facts and figures, as HTML
    std::vector<HtmlMap> maps;        // one, two that are compared, or none if the file could not be read
    std::vector<HtmlPicture> extras;  // pictures of both maps together
};

class HtmlReport {
public:
    // `command` is the command's name; `columns` are the headings after the file's.
    HtmlReport(std::string command, std::vector<std::string> columns);

    // Adds an entry; entries stand in the order of their keys. Any thread may call. A second entry of one key replaces
    // the first.
    void add(const std::string& key, HtmlEntry entry);

    // A rule that some entry names: it is explained once, at the end.
    void explain(const Rule& rule);

    // The page; `summary` is its first sentence.
    [[nodiscard]] std::string page(const std::string& summary) const;

private:
    void keep_to_budget();
    [[nodiscard]] std::string table() const;
    [[nodiscard]] std::string sections() const;
    [[nodiscard]] std::string rules_text() const;
    [[nodiscard]] std::string data() const;

    std::string command_;
    std::vector<std::string> columns_;
    mutable std::mutex mutex_;
    std::map<std::string, HtmlEntry> entries_;
    std::map<std::string, const Rule*> rules_;
    int side_ = kLargestHtmlLevel;  // the longest level that fits in
    std::size_t size_ = 0;          // of all pictures and levels, in characters
};

// The columns and an entry of check-normals. `map` is null for a file that could not be decoded.
[[nodiscard]] std::vector<std::string> check_columns();
[[nodiscard]] HtmlEntry check_entry(const CheckReport& report, const Requirements& require, HtmlMap* map);

// One level that compare-normals compared.
struct ComparedLevel {
    int number = 0;
    Extent extent;
    AngularError error;
    bool within = true;  // the limits
};

// The columns and the entry of compare-normals. `degrees` are the angles of the first level compared, `scale` is the
// angle at the end of their legend (none: the largest angle).
[[nodiscard]] std::vector<std::string> compare_columns();
[[nodiscard]] Result<HtmlEntry> compare_entry(const std::vector<ComparedLevel>& levels, HtmlMap a, HtmlMap b,
                                              const Plane<float>& degrees, std::optional<double> scale);

}  // namespace tex::cli
