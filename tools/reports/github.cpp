// SPDX-License-Identifier: Apache-2.0

#include "reports/github.h"

#include <string_view>

#include <fmt/format.h>

#include "cli/text.h"
#include "reports/findings.h"
#include "reports/fixes.h"

namespace tex::cli {
namespace {

std::string_view command_of(Severity severity) {
    return severity == Severity::error ? "error" : severity == Severity::warning ? "warning" : "notice";
}

// Escapes messages (escapeData) and properties (escapeProperty) as GitHub's toolkit does.
std::string escaped(std::string_view text, std::string_view special) {
    std::string result;
    for (const char c : text) {
        if (special.find(c) == std::string_view::npos) {
            result += c;
        } else {
            result += fmt::format("%{:02X}", static_cast<unsigned char>(c));
        }
    }
    return result;
}

std::string line_of(std::string_view command, const std::string& file, const std::string& title,
                    const std::string& message) {
    constexpr std::string_view kInMessage = "%\r\n", kInProperty = "%\r\n:,";
    std::string path = printable(file);
    if (path.starts_with("./")) path.erase(0, 2);  // paths are relative to the repository
    return fmt::format("::{} file={},title={}::{}\n", command, escaped(path, kInProperty), escaped(title, kInProperty),
                       escaped(message, kInMessage));
}

}  // namespace

std::string github_text(const CheckReport& report, const Requirements& require) {
    std::string text;
    if (report.error && report.findings.empty())
        text += line_of("error", report.file, "check-normals", printable(report.error->reason));
    for (const Finding& finding : report.findings) {
        std::string message = fmt::format("{}{}{}", printable(report.map), report.map.empty() ? "" : ": ",
                                          printable(statement_of(finding)));
        const Fix fix = fix_of(finding, report, require);
        if (!fix.text.empty()) message += fmt::format("\n{}{}", fix.is_command ? "Fix: " : "", fix.text);
        if (!fix.advice.empty()) message += "\n" + fix.advice;
        text += line_of(command_of(finding.severity), report.file,
                        fmt::format("{} {}", finding.rule->id, finding.rule->name), message);
    }
    return text;
}

}  // namespace tex::cli
