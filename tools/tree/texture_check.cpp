// SPDX-License-Identifier: Apache-2.0

#include "tree/texture_check.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <tex/tex.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "reports/fixes.h"

namespace tex::cli {
namespace {

// Options that select rules or set a limit. The others of the two groups read files or print texts.
bool is_key(const Option& row) {
    if (row.group == "Limits") return true;
    return row.group == "Rules" && (row.repeatable || row.completes == Completes::words) && !row.value.empty();
}

}  // namespace

TextureCheck::TextureCheck(const Manifest& manifest, const Settings& settings, Console& console)
    : command_("check", "") {
    rules_.add(command_);
    limits_.add(command_);
    std::vector<std::string> known, arguments;
    for (const Option& row : command_.options()) {
        if (is_key(row)) known.push_back(row.name().substr(2));
    }
    known.emplace_back("inputs");
    for (const OptionSetting& setting : settings) {
        const auto fail = [&](const std::string& reason) {
            fail_at(manifest.path, setting.place, fmt::format("check: {}{}", printable(setting.key), reason));
        };
        if (setting.key == "inputs") {
            if (!setting.is_flag) fail(" must be true or false");
            inputs_ = setting.is_on;
            if (setting.is_on) text_ += "check inputs\n";
            continue;
        }
        is_given_ = true;
        if (std::find(known.begin(), known.end(), setting.key) == known.end())
            fail(" is no key of a check" + did_you_mean(setting.key, known));
        if (setting.is_flag) fail(" needs a value");
        for (const std::string& value : setting.values) arguments.push_back(fmt::format("--{}={}", setting.key, value));
        text_ += fmt::format("check {} {}\n", setting.key, join(setting.values, "\n"));
    }
    std::vector<const char*> pointers;
    pointers.reserve(arguments.size());
    for (const std::string& argument : arguments) pointers.push_back(argument.c_str());
    try {
        std::ignore = command_.parse(pointers, console);
        std::ignore = rules_.read(command_, {}, {});
    } catch (const UsageError& error) {
        const auto at = std::find_if(settings.begin(), settings.end(), [&](const OptionSetting& setting) {
            return error.subject() == "--" + setting.key;
        });
        fail_at(manifest.path, at == settings.end() ? settings.front().place : at->place,
                fmt::format("check: {}", error.what()));
    }
    for (const Option& row : command_.options()) compares_ = compares_ || (row.group == "Limits" && !row.given.empty());
}

Result<void> TextureCheck::compare_with_source(const MadeTexture& made, const ReadOptions& read,
                                               const Execution& execution, std::vector<std::string>& sentences) const {
    SourceOptions as_packed;
    as_packed.read = read;
    const auto source = read_normals(made.source, as_packed, true, execution);
    if (!source) return source.error();
    as_packed.unpack.swizzle = encoding_info(made.pack.encoding).swizzle;
    as_packed.unpack.y_axis = made.pack.y_axis;
    const auto packed = read_normals(made.file, as_packed, true, execution);
    if (!packed) return packed.error();
    const auto compared = compare(source->chain.levels.front(), packed->chain.levels.front(), execution);
    if (!compared) return compared.error();
    for (std::string& sentence : limits_.violations(0, compared->error)) sentences.push_back(std::move(sentence));
    return {};
}

// "... of the texels are background, first at column 3, row 9 (background, N215); ..."
std::string TextureCheck::sentence_of(const Finding& finding, const CheckReport& report,
                                      const std::string& input) const {
    std::string sentence = finding.message;
    const bool has_place = sentence.find("column") != std::string::npos;
    if (finding.has_texel && !has_place)
        sentence += fmt::format(", first at column {}, row {}", finding.column, finding.row);
    sentence += fmt::format(" ({}, {})", finding.rule->name, finding.rule->id);
    CheckReport of_input = report;
    of_input.file = input;
    Fix fix = fix_of(finding, of_input, rules_.demands().checks.require);
    if (fix.text.empty()) return sentence;
    if (input == report.file) return sentence + "; " + fix.text;
    // What the file is like, and its levels, the rule of the manifest decides.
    if (finding.rule->family == RuleFamily::file || finding.rule->family == RuleFamily::mips)
        return sentence + "; the rule decides that" +
               (fix.is_command ? ", as the options of this do: " + fix.text : "");
    return sentence + (fix.is_command ? "; if the input has that fault, too, this mends it: " : "; ") + fix.text;
}

Result<std::vector<std::string>> TextureCheck::findings_of_input(const std::string& path, const ReadOptions& read,
                                                                 const Execution& execution) const {
    CheckOptions checks = rules_.demands().checks;
    checks.require = {};
    const auto report = check_file(path, checks, read, execution);
    if (!report) return report.error();
    if (report->error) return *report->error;
    std::vector<std::string> sentences;
    for (const Finding& finding : report->findings) {
        if (rules_.demands().fails(finding)) sentences.push_back(sentence_of(finding, *report, path));
    }
    return sentences;
}

Result<std::vector<std::string>> TextureCheck::findings(const MadeTexture& made, const ReadOptions& read,
                                                        const Execution& execution) const {
    std::vector<std::string> sentences;
    const auto report = check_file(made.file, rules_.demands().checks, read, execution);
    if (!report) return report.error();
    if (report->error) return *report->error;
    for (const Finding& finding : report->findings) {
        if (rules_.demands().fails(finding)) sentences.push_back(sentence_of(finding, *report, made.input));
    }
    if (compares_) {
        if (const auto done = compare_with_source(made, read, execution, sentences); !done) return done.error();
    }
    return sentences;
}

}  // namespace tex::cli
