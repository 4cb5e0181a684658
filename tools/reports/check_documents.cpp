// SPDX-License-Identifier: Apache-2.0

#include "reports/check_documents.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <tex/file.h>

#include "cli/text.h"
#include "cli/text_file.h"
#include "cli/usage_error.h"
#include "reports/findings.h"
#include "reports/html_map.h"
#include "reports/html_marks.h"
#include "reports/sarif.h"
#include "tasks/depfile.h"

namespace tex::cli {

void CheckDocuments::add(Command& command) {
    command.group("Documents");
    command
        .output_file(page_path_, "--report",
                     "write a page with the findings and pictures, on which the light can be moved")
        .often(3, "write a page with the findings and pictures");
    command.output_file(sarif_, "--sarif", "write the findings as SARIF 2.1.0");
    command.output_file(junit_, "--junit", "write the findings as JUnit XML");
    command.flag(is_for_github_, "--github", "print the findings as GitHub's workflow commands: annotations");
    command.text(baseline_path_, "--baseline", "FILE", "accept the findings that this file lists")
        .often(3, "accept the findings that this file lists")
        .completes = Completes::files;
    command.output_file(
        baseline_written_, "--baseline-write",
        "write such a file with all findings, and do not fail for them; files that cannot be read still fail");
    command.output_file(depfile_, "--depfile", "write what the documents were made from, for Make and Ninja");
}

std::vector<std::string> CheckDocuments::written() const {
    std::vector<std::string> files = {page_path_, sarif_, junit_, baseline_written_};
    std::erase(files, std::string());
    return files;
}

// No two documents may be the same file, except that the written baseline may be the one that is read.
void CheckDocuments::check(const std::vector<std::string>& inputs, std::vector<NamedFile> others,
                           const std::vector<NamedFile>& beside) {
    if (!depfile_.empty() && written().empty()) throw UsageError("--depfile needs a document, such as --report");
    sources_ = inputs;
    for (const NamedFile& other : others) sources_.push_back(other.path);
    if (baseline_path_ != baseline_written_) sources_.push_back(baseline_path_);
    std::erase(sources_, std::string());
    others.insert(others.end(), beside.begin(), beside.end());
    for (const NamedFile& document : std::initializer_list<NamedFile>{{"--baseline-write", baseline_written_},
                                                                      {"--baseline", baseline_path_},
                                                                      {"--report", page_path_},
                                                                      {"--sarif", sarif_},
                                                                      {"--junit", junit_},
                                                                      {"--depfile", depfile_}}) {
        if (!document.path.empty() && document.option != "--baseline") check_document(document, inputs, others);
        others.push_back(document);
    }
    if (has_page()) check_read_twice("--report", inputs);
    sizes_ = html_sizes(inputs.size());
    marks_side_ = has_page() ? marks_side(inputs.size()) : 0;
    new_baseline_ = Baseline(baseline_written_);
}

Result<void> CheckDocuments::read() {
    if (baseline_path_.empty()) return {};
    auto read = Baseline::read(baseline_path_);
    if (!read) return read.error();
    baseline_ = std::move(*read);
    return {};
}

std::vector<Finding> CheckDocuments::accept(CheckReport& report) {
    const std::string content =
        report.findings.empty() || (!baseline_ && !writes_baseline()) ? std::string() : content_of(report.file);
    if (writes_baseline()) {
        const std::lock_guard lock(mutex_);
        new_baseline_.add(report, content);  // includes findings that --baseline accepts
    }
    if (!baseline_) return {};
    const std::lock_guard lock(mutex_);
    return baseline_->accept(report, content);
}

Result<void> CheckDocuments::add(Job& job, const JudgedReport& judged, const MapOnMesh* mesh, const ReadTexture& read) {
    if (has_page()) {
        if (auto added = add_to_page(job, judged, mesh, read); !added) return added;
    }
    const std::lock_guard lock(mutex_);
    if (!sarif_.empty() || !junit_.empty()) reports_.insert_or_assign(title_of(judged.report), judged);
    return {};
}

void CheckDocuments::depends_on(const std::string& file) {
    const std::lock_guard lock(mutex_);
    more_sources_.insert(file);
}

Result<void> CheckDocuments::add_to_page(Job& job, const JudgedReport& judged, const MapOnMesh* mesh,
                                         const ReadTexture& read) {
    const CheckReport& report = judged.report;
    for (const std::vector<Finding>* findings : {&report.findings, &judged.waived}) {
        for (const Finding& finding : *findings) page_.explain(*finding.rule);
    }
    std::optional<HtmlMap> map;
    if (!report.error) {
        const auto texture = read();
        if (!texture) return texture.error();
        const MapOcclusion occlusion{judged.occlusion, judged.occlusion_file};
        auto drawn = draw_html_map(title_of(report), *texture, report.swizzle, report.y.y.value_or(texture->y_axis),
                                   mesh, sizes_, job.until(1.0), judged.occlusion != nullptr ? &occlusion : nullptr);
        // A file that holds no normals has findings, and no pictures.
        if (drawn)
            map = std::move(*drawn);
        else if (drawn.error().code != ErrorCode::bad_option)
            return drawn.error();
    }
    auto entry = check_entry(report, judged.require, judged.waived, map ? &*map : nullptr, marks_side_ > 0);
    if (!entry) return entry.error();
    page_.add(title_of(report), std::move(*entry));
    return {};
}

void CheckDocuments::note_gone(Console& console) const {
    const std::size_t gone = baseline_ ? baseline_->gone() : 0;
    if (gone == 0 || writes_baseline()) return;
    console.warning(
        fmt::format("{}: {} of {} findings are gone; --baseline-write {}, in a run over all files, drops them",
                    printable(baseline_path_), gone, baseline_->size(), shell_file(baseline_path_)));
}

ExitCode CheckDocuments::write(Console& console, const std::string& summary) const {
    note_gone(console);
    std::vector<JudgedReport> all;
    for (const auto& [file, report] : reports_) all.push_back(report);
    ExitCode code = ExitCode::done;
    const auto write = [&](const std::string& path, const std::string& text) {
        const auto written = write_document(path, text);
        if (written) return;
        console.error(written.error().message());
        code = std::max(code, exit_code(written.error().code));
    };
    if (!sarif_.empty()) write(sarif_, sarif_text(all));
    if (!junit_.empty()) write(junit_, junit_text(all));
    if (has_page()) write(page_path_, page_.page(summary));
    if (writes_baseline()) write(baseline_written_, new_baseline_.text());
    if (depfile_.empty() || code != ExitCode::done) return code;
    std::vector<std::string> sources = sources_;
    for (const std::string& file : more_sources_) {
        if (std::find(sources.begin(), sources.end(), file) == sources.end()) sources.push_back(file);
    }
    if (const auto text = depfile_text({{written(), sources}})) {
        write(depfile_, *text);
    } else {
        console.error(text.error().message());
        code = exit_code(text.error().code);
    }
    return code;
}

}  // namespace tex::cli
