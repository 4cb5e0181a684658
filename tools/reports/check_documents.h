// SPDX-License-Identifier: Apache-2.0
// check_documents.h: the option group of the files that check-normals writes, and their content.

#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <tex/check.h>

#include "cli/command.h"
#include "options/rules.h"
#include "reports/baseline.h"
#include "reports/html_report.h"
#include "reports/junit.h"
#include "tasks/collisions.h"
#include "tasks/job.h"

namespace tex::cli {

// --report, --sarif, --junit, --github, --baseline, --baseline-write, --depfile.
class CheckDocuments {
public:
    void add(Command& command);

    [[nodiscard]] bool are_written() const { return !written().empty(); }
    [[nodiscard]] bool has_page() const { return !page_path_.empty(); }
    // CheckOptions::marks that the page needs.
    [[nodiscard]] int marks() const { return marks_side_; }
    // Findings are printed for GitHub instead of for people.
    [[nodiscard]] bool is_for_github() const { return is_for_github_; }
    [[nodiscard]] bool writes_baseline() const { return !baseline_written_.empty(); }

    // Throws UsageError if a document is an input, one of `others`, from which documents are made, too, or one of
    // `beside`, which they need not be made from.
    void check(const std::vector<std::string>& inputs, std::vector<NamedFile> others,
               const std::vector<NamedFile>& beside);

    // Reads the baseline. Errors: io, bad_data.
    [[nodiscard]] Result<void> read();

    // Removes the findings that the baseline knows from the report, and returns them. Any thread may call this.
    [[nodiscard]] std::vector<Finding> accept(CheckReport& report);

    // Adds a map to the documents, with the mesh that it is on or null. `read` reads its texture again, for pictures.
    // Any thread may call this. Errors: those of `read`.
    using ReadTexture = std::function<Result<Texture>()>;
    [[nodiscard]] Result<void> add(Job& job, const JudgedReport& judged, const MapOnMesh* mesh,
                                   const ReadTexture& read);

    // A file that a map was made from, besides the inputs. Any thread may call this.
    void depends_on(const std::string& file);

    // Writes all of them. `summary` is the first sentence of the page.
    [[nodiscard]] ExitCode write(Console& console, const std::string& summary) const;

private:
    // Warns of findings of the baseline that nothing matches any more.
    void note_gone(Console& console) const;
    [[nodiscard]] std::vector<std::string> written() const;
    [[nodiscard]] Result<void> add_to_page(Job& job, const JudgedReport& judged, const MapOnMesh* mesh,
                                           const ReadTexture& read);

    std::string page_path_, sarif_, junit_, baseline_path_, baseline_written_, depfile_;  // or empty
    std::vector<std::string> sources_;  // what the documents are made from
    std::set<std::string> more_sources_;
    bool is_for_github_ = false;
    std::mutex mutex_;
    std::optional<Baseline> baseline_;
    Baseline new_baseline_;
    HtmlReport page_{"check-normals", check_columns()};
    HtmlSizes sizes_;  // of the page's pictures
    int marks_side_ = 0;
    // By file, so that the documents do not depend on the order in which files end.
    std::map<std::string, JudgedReport> reports_;
};

}  // namespace tex::cli
