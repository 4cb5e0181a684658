// SPDX-License-Identifier: Apache-2.0

#include "options/others.h"

#include <utility>

#include <fmt/format.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "cli/value.h"
#include "tasks/name_pattern.h"

namespace tex::cli {
namespace {

struct LayoutRow {
    Layout layout;
    YAxis y;
    std::optional<OtherKind> blue;  // none: z
    OtherKind alpha;
};

constexpr LayoutRow kLayouts[] = {
    {Layout::labpbr, YAxis::down, OtherKind::occlusion, OtherKind::height},
    {Layout::terrain3d, YAxis::up, std::nullopt, OtherKind::roughness},
    {Layout::source, YAxis::down, std::nullopt, OtherKind::mask},
    {Layout::skyrim, YAxis::down, std::nullopt, OtherKind::mask},
};

// The pattern as the name of a file for this task.
std::string name_for(const std::string& pattern, const Task& task) {
    return NamePattern(pattern).expand(name_fields(task.input));
}

}  // namespace

void OtherOptions::take(const std::string& text, bool bakes, Choice& choice) {
    choice = {};
    const bool is_number = !text.empty() && text.find_first_not_of("+-.0123456789eE") == std::string::npos;
    if (text == "none") return;
    if (text == (bakes ? "height" : "keep")) {
        choice.from = bakes ? Choice::From::heights : Choice::From::kept;
    } else if (is_number) {
        choice.from = Choice::From::number;
        choice.number = parse_float(text, {0.0, 1.0});
    } else {
        choice.from = Choice::From::file;
        choice.file = parse_channel_file(text);
        if (choice.file.file == "-") throw UsageError("needs a file, a number or a word, not standard input");
        if (NamePattern(choice.file.file).uses("level")) throw UsageError("{level} has no meaning for an input");
    }
}

void OtherOptions::add_channel(Command& command, const char* option, Choice& choice, bool bakes) {
    const bool is_alpha = &choice == &alpha_;
    Row& row = command.option(option, "WHAT",
                              is_alpha ? "what alpha holds: FILE[:CHANNEL], a number from 0 to 1, or a word"
                                       : "what blue holds instead of z, as --alpha",
                              [&choice, bakes](const std::string& text) { take(text, bakes, choice); });
    if (bakes) {
        row.words = {{"height", "the heights that are baked, 0 to 1"}};
    } else {
        row.words = {{"keep", "what it holds in the input"}};
    }
    row.words.push_back({"none", is_alpha ? "nothing: it is 1" : "z"});
    row.preset = is_alpha && !bakes ? "keep" : "none";
    row.completes = Completes::files;
}

void OtherOptions::add(Command& command, OutputOptions& output, bool bakes) {
    is_added_ = true;
    if (!bakes) alpha_.from = Choice::From::kept;
    command.group("Data beside the normals");
    add_channel(command, "--blue", blue_, bakes);
    add_channel(command, "--alpha", alpha_, bakes);
    Row& kind = command.option("--kind", "KIND[,KIND]", "what blue and alpha hold, which decides about smaller levels",
                               [this](const std::string& text) {
                                   const auto [first, second] = cut(text, ',');
                                   blue_kind_ = parse_word(first, kOtherKindNames);
                                   alpha_kind_ = second.empty() ? *blue_kind_ : parse_word(second, kOtherKindNames);
                               });
    kind.words = words_of(kOtherKindNames);
    kind.preset = "mask, or as the layout says";
    kind.completes = Completes::words;
    command.choice(layout_, "--layout", "NAME", kLayoutNames, "set --format rgba8, --y and --kind for a game");
    command.check([this, &command, &output] {
        set_layout(command, output);
        check_room(output);
    });
}

void OtherOptions::set_layout(const Command& command, OutputOptions& output) {
    if (!layout_) return;
    for (const LayoutRow& row : kLayouts) {
        if (row.layout != *layout_) continue;
        if (row.blue && !command.given("--blue")) {
            throw UsageError(fmt::format("--layout {} has {} in blue: give --blue FILE, or --blue 1 for none",
                                         name_of(kLayoutNames, row.layout), name_of(kOtherKindNames, *row.blue)));
        }
        if (!row.blue && blue_.from != Choice::From::nothing)
            throw UsageError(fmt::format("--layout {} has z in blue", name_of(kLayoutNames, row.layout)));
        if (!output.format) output.format = Encoding::rgba8;
        if (!output.y) output.y = row.y;
        if (!blue_kind_) blue_kind_ = row.blue.value_or(OtherKind::mask);
        if (!alpha_kind_) alpha_kind_ = row.alpha;
    }
}

void OtherOptions::check_room(const OutputOptions& output) const {
    if (!output.format) return;
    const auto has_room = [](Encoding encoding, bool is_alpha) {
        return is_alpha ? can_hold(encoding).alpha : can_hold(encoding).blue;
    };
    for (const auto& [choice, option] : {std::pair(&blue_, "--blue"), std::pair(&alpha_, "--alpha")}) {
        const bool is_alpha = choice == &alpha_;
        const bool is_given = choice->from != Choice::From::nothing && choice->from != Choice::From::kept;
        if (!is_given || has_room(*output.format, is_alpha)) continue;
        std::vector<std::string> able;
        for (const auto& row : kEncodingNames) {
            if (has_room(row.value, is_alpha)) able.emplace_back(row.name);
        }
        throw UsageError(fmt::format("{} has no room for {}; these formats have: {}",
                                     name_of(kEncodingNames, *output.format), option, join(able, ", ")));
    }
}

void OtherOptions::amend(Task& task) const {
    for (const Choice* choice : {&blue_, &alpha_}) {
        if (choice->from == Choice::From::file) task.own.push_back(file_for(*choice, task).file);
    }
}

ChannelFile OtherOptions::file_for(const Choice& choice, const Task& task) {
    return {name_for(choice.file.file, task), choice.file.channel};
}

std::optional<OtherData> OtherOptions::data(const Choice& choice, Job& job) const {
    OtherData data;
    switch (choice.from) {
        case Choice::From::nothing:
        case Choice::From::kept: return std::nullopt;
        case Choice::From::heights: data.heights = true; break;
        case Choice::From::number: data.value = choice.number; break;
        case Choice::From::file:
            data.map = [&choice, &job] { return read_channel(job, file_for(choice, job.task), {job.threads(), {}}); };
    }
    return data;
}

OtherInputs OtherOptions::inputs(Job& job) const { return {data(blue_, job), data(alpha_, job)}; }

void OtherOptions::apply(UnpackOptions& unpack) const {
    unpack.others = {blue_.from == Choice::From::kept, alpha_.from == Choice::From::kept};
}

void OtherOptions::apply(MipOptions& mip) const {
    mip.blue = blue_kind_.value_or(mip.blue);
    mip.alpha = alpha_kind_.value_or(mip.alpha);
}

void OtherFiles::add(Command& command, const FileOptions& files) {
    files_ = &files;
    const char* help = "write what {} holds beside the normals to a file; of many inputs a pattern as --name";
    for (const auto& [option, pattern, channel] :
         {std::tuple("--blue-out", &blue_, "blue"), std::tuple("--alpha-out", &alpha_, "alpha")})
        command.text(*pattern, option, "FILE", fmt::format(fmt::runtime(help), channel)).completes = Completes::files;
    command.check([this, &command] {
        for (const auto& [option, pattern] : {std::pair("--blue-out", &blue_), std::pair("--alpha-out", &alpha_)}) {
            if (command.given(option) && (pattern->empty() || *pattern == "-"))
                throw UsageError(option, "needs the name of a file");
        }
    });
}

std::optional<OtherFile> OtherFiles::file(const std::string& pattern, const Task& task) const {
    if (pattern.empty()) return std::nullopt;
    OtherFile file;
    file.output = files_->place(pattern, name_fields(task.input));
    const auto container = container_of(file.output);
    if (!container) throw UsageError(printable(file.output), "unsupported output format");
    file.container = *container;
    const FormatInfo info = format_info(encoding_info(default_encoding(*container)).format);
    file.format = info.has_blocks() ? Format::r8_unorm : *format_of(info.sample, info.bits, 1);
    return file;
}

void OtherFiles::amend(Task& task) const {
    for (const std::string* pattern : {&blue_, &alpha_}) {
        if (const auto out = file(*pattern, task)) task.more_outputs.push_back(out->output);
    }
}

void OtherFiles::check(const std::vector<Task>& tasks) const {
    for (const Task& task : tasks) {
        for (const std::string* pattern : {&blue_, &alpha_}) {
            const auto out = file(*pattern, task);
            if (out && !can_hold(out->container, out->format)) {
                throw UsageError(printable(out->output), fmt::format("{} files cannot hold a single channel",
                                                                     name_of(kContainerNames, out->container)));
            }
        }
    }
}

void OtherFiles::apply(const Task& task, PackFileOptions& options) const {
    options.blue_file = file(blue_, task);
    options.alpha_file = file(alpha_, task);
}

void OtherFiles::report(Job& job) const {
    for (const auto& [pattern, key] : {std::pair(&blue_, "blue"), std::pair(&alpha_, "alpha")}) {
        if (const auto out = file(*pattern, job.task)) {
            job.wrote(out->output);
            job.report[key] = out->output;
        }
    }
}

}  // namespace tex::cli
