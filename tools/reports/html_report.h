// SPDX-License-Identifier: Apache-2.0
// html_report.h: the findings of a command as one HTML file that needs no other file: --report.
//
// The page has a table of its entries and, for each entry, its figures, still pictures and the levels of its maps. A
// reader with JavaScript and WebGL can move a light over these levels. The parts of the page are
// tools/reports/report_page.html, .css and .js. The build puts them into the program.
//
// The bytes depend on the entries alone, not on the time, the host, or the order in which files end.

#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <tex/check.h>

#include "reports/html_map.h"

namespace tex::cli {

// The most characters that pictures, levels and meshes may take in a page. If there are more, levels are left out, the
// largest first. Meshes that exceed kHtmlMeshBudget together are left out, the last first.
inline constexpr std::size_t kHtmlBudget = 18'000'000;

// One row of the table and one section.
struct HtmlEntry {
    std::string title;
    std::string row;                  // the cells after the title, as HTML
    std::string words;                // words for the page's filter: "error", "warning", "note", "clean"
    std::string body;                 // facts and figures, as HTML
    std::vector<HtmlMap> maps;        // one; two if they are compared; none if the file could not be read
    std::vector<HtmlPicture> extras;  // pictures that show both maps
    bool in_a_row = false;            // all maps are on meshes, which stand side by side; the last one leads the others
};

class HtmlReport {
public:
    // `command` is the command's name. `columns` are the headings after the file's heading.
    HtmlReport(std::string command, std::vector<std::string> columns);

    // Adds an entry. Entries are sorted by their keys. Any thread may call this. A second entry with the same key
    // replaces the first.
    void add(const std::string& key, HtmlEntry entry);

    // Adds a rule that an entry names. Each such rule is explained once, at the end of the page.
    void explain(const Rule& rule);

    // The numbers of the meshes in the page.
    using MeshNumbers = std::map<const HtmlMesh*, std::size_t>;

    // The page. `summary` is its first sentence.
    [[nodiscard]] std::string page(const std::string& summary) const;

private:
    void share_mesh(std::shared_ptr<const HtmlMesh>& mesh);
    [[nodiscard]] bool fits() const;
    void keep_to_budget();
    [[nodiscard]] MeshNumbers mesh_numbers() const;
    [[nodiscard]] std::string table() const;
    [[nodiscard]] std::string sections() const;
    [[nodiscard]] std::string rules_text() const;
    [[nodiscard]] std::string data() const;
    [[nodiscard]] std::string mesh_data() const;

    std::string command_;
    std::vector<std::string> columns_;
    mutable std::mutex mutex_;
    std::map<std::string, HtmlEntry> entries_;
    std::map<std::string, const Rule*> rules_;
    int side_ = kLargestHtmlLevel;                         // the longest side of a level that still fits
    std::size_t size_ = 0;                                 // of all pictures and levels, in characters
    std::vector<std::shared_ptr<const HtmlMesh>> meshes_;  // each once
    std::size_t mesh_size_ = 0;                            // of all of them, in characters
};

// The entry of a file that failed, in a page with so many columns.
[[nodiscard]] HtmlEntry failed_entry(const std::string& name, const Error& error, std::size_t columns);

// The columns and an entry of check-normals. `map` is null for a file that could not be decoded.
// `waived` are findings that a baseline accepts.
[[nodiscard]] std::vector<std::string> check_columns();
// With `has_marks`, findings have pictures of the texels that spoke for them. Errors: out_of_memory.
[[nodiscard]] Result<HtmlEntry> check_entry(const CheckReport& report, const Requirements& require,
                                            const std::vector<Finding>& waived, HtmlMap* map, bool has_marks);

// One level that compare-normals compared.
struct ComparedLevel {
    int number = 0;
    Extent extent;
    AngularError error;
    bool within = true;  // the angles are within the limits
};

// The columns and the entry of compare-normals. `degrees` are the angles of the first level compared. `scale` is the
// angle at the end of their legend (none: the largest angle).
[[nodiscard]] std::vector<std::string> compare_columns();
[[nodiscard]] Result<HtmlEntry> compare_entry(const std::vector<ComparedLevel>& levels, HtmlMap a, HtmlMap b,
                                              const Plane<float>& degrees, std::optional<double> scale);

}  // namespace tex::cli
