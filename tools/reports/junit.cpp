// SPDX-License-Identifier: Apache-2.0

#include "reports/junit.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "cli/text.h"
#include "reports/findings.h"

namespace tex::cli {
namespace {

// Text for an attribute or an element, made from lines that may contain any bytes. XML 1.0 cannot represent most
// control characters.
std::string escaped(std::string_view text) {
    std::string xml;
    while (true) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        for (const char c : printable(text.substr(0, end))) {
            switch (c) {
                case '&': xml += "&amp;"; break;
                case '<': xml += "&lt;"; break;
                case '>': xml += "&gt;"; break;
                case '"': xml += "&quot;"; break;
                default: xml += c; break;
            }
        }
        if (end == text.size()) return xml;
        xml += "&#10;";
        text.remove_prefix(end + 1);
    }
}

std::string test_case(const JudgedReport& judged) {
    const CheckReport& report = judged.report;
    const Requirements& require = judged.require;
    CheckReport failing = report, other = report;
    const auto fails = [&](const Finding& finding) { return finding.severity >= judged.fail_on; };
    std::erase_if(failing.findings, [&](const Finding& finding) { return !fails(finding); });
    std::erase_if(other.findings, fails);
    std::string xml = fmt::format("    <testcase classname=\"check-normals\" name=\"{}\" time=\"{:.3f}\">\n",
                                  escaped(title_of(report)), judged.seconds);
    if (judged.is_unreadable()) {
        xml += fmt::format("      <error type=\"{}\" message=\"{}\"/>\n", name_of(kErrorCodeNames, report.error->code),
                           escaped(report.error->reason));
    } else if (!failing.findings.empty()) {
        const Finding& first = failing.findings.front();
        xml += fmt::format("      <failure type=\"{}\" message=\"{}\">{}</failure>\n", first.rule->id,
                           escaped(statement_of(first)), escaped(findings_text(failing, require)));
    }
    if (!other.findings.empty() && !judged.is_unreadable()) {
        xml += fmt::format("      <system-out>{}</system-out>\n", escaped(findings_text(other, require)));
    }
    return xml + "    </testcase>\n";
}

}  // namespace

std::string junit_text(const std::vector<JudgedReport>& reports) {
    const auto count = [&](auto holds) { return std::count_if(reports.begin(), reports.end(), holds); };
    const auto errors = count([](const JudgedReport& judged) { return judged.is_unreadable(); });
    const auto failures = count([](const JudgedReport& judged) {
        const std::vector<Finding>& findings = judged.report.findings;
        return !judged.is_unreadable() && std::any_of(findings.begin(), findings.end(), [&](const Finding& finding) {
            return finding.severity >= judged.fail_on;
        });
    });
    double seconds = 0.0;
    for (const JudgedReport& judged : reports) seconds += judged.seconds;
    std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
    xml += fmt::format(
        "  <testsuite name=\"check-normals\" tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"0\" "
        "time=\"{:.3f}\">\n",
        reports.size(), failures, errors, seconds);
    for (const JudgedReport& judged : reports) xml += test_case(judged);
    return xml + "  </testsuite>\n</testsuites>\n";
}

}  // namespace tex::cli
