// SPDX-License-Identifier: Apache-2.0

#include "options/extras.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "cli/text.h"
#include "cli/usage_error.h"
#include "cli/value.h"
#include "tasks/name_pattern.h"

namespace tex::cli {
namespace {

constexpr const char* kOcclusion = "occlusion";  // of the heights that are baked

struct LayoutRow {
    Layout layout;
    YAxis y;
    std::optional<ExtraKind> blue;  // none: z
    ExtraKind alpha;
};

constexpr LayoutRow kLayouts[] = {
    {Layout::labpbr, YAxis::down, ExtraKind::occlusion, ExtraKind::height},
    {Layout::terrain3d, YAxis::up, std::nullopt, ExtraKind::roughness},
    {Layout::source, YAxis::down, std::nullopt, ExtraKind::mask},
    {Layout::skyrim, YAxis::down, std::nullopt, ExtraKind::mask},
};

// The pattern as the name of a file for this task.
std::string name_for(const std::string& pattern, const Task& task) {
    return NamePattern(pattern).expand(name_fields(task.named()));
}

}  // namespace

struct ExtraOptions::ExtraOption {
    Extra extra;
    const char* option;
    const char* help;
    const char* nothing;  // what it holds then
    const char* kept;     // the word for what it holds in the input
    const char* heights;  // the word for heights that are baked; null: they do not go there
    bool is_kept;         // without the option
};

// The order is that of the help.
const ExtraOptions::ExtraOption ExtraOptions::kExtraOptions[] = {
    {Extra::blue, "--blue", "what blue holds instead of z, as --alpha", "z", "keep", "height", false},
    {Extra::alpha, "--alpha", "what alpha holds: FILE[:CHANNEL], a number from 0 to 1, or a word", "nothing: it is 1",
     "keep", "height", true},
    {Extra::length, "--length", "the occlusion that the lengths of vectors hold, as --alpha",
     "nothing: vectors are unit", "occlusion", nullptr, true},
};

void ExtraOptions::take(const std::string& text, const ExtraOption& row) {
    Choice& choice = choices_[row.extra];
    choice = {};
    const bool is_number = !text.empty() && text.find_first_not_of("+-.0123456789eE") == std::string::npos;
    if (text == "none") return;
    if (reads_ != nullptr && text == row.kept) {
        choice.from = Choice::From::kept;
    } else if (reads_ == nullptr && row.heights != nullptr && text == row.heights) {
        choice.from = Choice::From::heights;
    } else if (reads_ == nullptr && text == kOcclusion) {
        choice.from = Choice::From::occlusion;
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

void ExtraOptions::add_option(Command& command, const ExtraOption& row) {
    Option& option =
        command.option(row.option, "WHAT", row.help, [this, &row](const std::string& text) { take(text, row); });
    option.preset = "none";
    if (reads_ != nullptr) {
        option.words = {{row.kept, "what it holds in the input"}};
        if (row.is_kept) option.preset = row.kept;
        if (row.is_kept) choices_[row.extra].from = Choice::From::kept;
    } else {
        if (row.heights != nullptr) option.words = {{row.heights, "the heights that are baked, 0 to 1"}};
        option.words.push_back({kOcclusion, "the occlusion of the heights that are baked: 1 is open"});
    }
    option.words.push_back({"none", row.nothing});
    option.completes = Completes::files;
}

void ExtraOptions::add(Command& command, OutputOptions& output, const NormalsReader* reads) {
    is_added_ = true;
    reads_ = reads;
    command.group("Data beside the normals");
    for (const ExtraOption& row : kExtraOptions) add_option(command, row);
    Option& kind =
        command.option("--kind", "KIND[,KIND]", "what blue and alpha hold, which decides about smaller levels",
                       [this](const std::string& text) {
                           const auto [first, second] = cut(text, ',');
                           blue_kind_ = parse_word(first, kExtraKindNames);
                           alpha_kind_ = second.empty() ? *blue_kind_ : parse_word(second, kExtraKindNames);
                       });
    kind.words = words_of(kExtraKindNames);
    kind.preset = "mask, or as the layout says";
    kind.completes = Completes::words;
    command.choice(layout_, "--layout", "NAME", kLayoutNames, "set --format rgba8, --y and --kind for a game");
    command.check([this, &command, &output] {
        set_layout(command, output);
        check_room(output);
        check_lengths(command);
    });
}

void ExtraOptions::set_layout(const Command& command, OutputOptions& output) {
    if (!layout_) return;
    for (const LayoutRow& row : kLayouts) {
        if (row.layout != *layout_) continue;
        if (row.blue == ExtraKind::occlusion && reads_ == nullptr && !command.given("--blue")) {
            choices_.blue.from = Choice::From::occlusion;
            if (row.alpha == ExtraKind::height && !command.given("--alpha"))
                choices_.alpha.from = Choice::From::heights;
        } else if (row.blue && !command.given("--blue")) {
            throw UsageError(fmt::format("--layout {} has {} in blue: give --blue FILE, or --blue 1 for none",
                                         name_of(kLayoutNames, row.layout), name_of(kExtraKindNames, *row.blue)));
        }
        if (!row.blue && choices_.blue.from != Choice::From::nothing)
            throw UsageError(fmt::format("--layout {} has z in blue", name_of(kLayoutNames, row.layout)));
        if (!output.format && !output.keeps_format) output.format = Encoding::rgba8;
        if (!output.y) output.y = row.y;
        if (!blue_kind_) blue_kind_ = row.blue.value_or(ExtraKind::mask);
        if (!alpha_kind_) alpha_kind_ = row.alpha;
    }
}

void ExtraOptions::check_room(const OutputOptions& output) const {
    if (!output.format) return;
    for (const ExtraOption& row : kExtraOptions) {
        if (!choices_[row.extra].is_given() || can_hold(*output.format)[row.extra]) continue;
        std::vector<std::string> able;
        for (const auto& encoding : kEncodingNames) {
            if (can_hold(encoding.value)[row.extra]) able.emplace_back(encoding.name);
        }
        throw UsageError(fmt::format("{} has no room for {}; these formats have: {}",
                                     name_of(kEncodingNames, *output.format), row.option, join(able, ", ")));
    }
}

void ExtraOptions::check_lengths(const Command& command) const {
    const Choice& length = choices_.length;
    if (length.is_given() && choices_.blue.from != Choice::From::nothing)
        throw UsageError("--blue and --length exclude each other: without z, a vector has no length");
    if (reads_ == nullptr) return;
    const bool keeps = length.from == Choice::From::kept;
    if (keeps && command.given("--length") && reads_->length_in != LengthIn::occlusion)
        throw UsageError("--length occlusion needs --length-in occlusion");
    if (length.is_given() && reads_->unpack.keep_length)
        throw UsageError("--length and --keep-length exclude each other");
}

void ExtraOptions::amend(Task& task) const {
    for (const ExtraOption& row : kExtraOptions) {
        const Choice& choice = choices_[row.extra];
        if (choice.from == Choice::From::file) task.own.push_back(file_for(choice, task).file);
    }
}

ChannelFile ExtraOptions::file_for(const Choice& choice, const Task& task) {
    return {name_for(choice.file.file, task), choice.file.channel};
}

std::optional<ExtraData> ExtraOptions::data(const Choice& choice, Job& job) const {
    ExtraData data;
    switch (choice.from) {
        case Choice::From::nothing:
        case Choice::From::kept: return std::nullopt;
        case Choice::From::heights: data.heights = true; break;
        case Choice::From::occlusion: data.occlusion = true; break;
        case Choice::From::number: data.value = choice.number; break;
        case Choice::From::file: {
            const ChannelFile file = file_for(choice, job.task);
            data.picture = ExtraPicture{file.file, job.read_options, file.channel};
        }
    }
    return data;
}

ExtraInputs ExtraOptions::inputs(Job& job) const {
    ExtraInputs inputs;
    for (const Extra extra : kExtras) inputs[extra] = data(choices_[extra], job);
    return inputs;
}

bool ExtraOptions::has_occlusion() const {
    return std::any_of(std::begin(kExtras), std::end(kExtras),
                       [this](Extra extra) { return choices_[extra].from == Choice::From::occlusion; });
}

void ExtraOptions::apply(UnpackOptions& unpack) const {
    ExtraSet kept;
    for (const Extra extra : kExtras) kept[extra] = choices_[extra].from == Choice::From::kept;
    kept.length = kept.length && unpack.others.length;  // if lengths are data
    unpack.others = kept;
}

ExtraSet ExtraOptions::accounted_for(ExtraSet held) const {
    ExtraSet planes;
    for (const ExtraOption& row : kExtraOptions) {
        const Choice& choice = choices_[row.extra];
        const bool is_told_to_go = choice.from == Choice::From::nothing && row.is_kept;
        planes[row.extra] = choice.is_given() || is_told_to_go || held[row.extra];
    }
    planes.blue = planes.blue && !stores_z();
    return planes;
}

void ExtraOptions::apply(MipOptions& mip) const {
    mip.blue = blue_kind_.value_or(mip.blue);
    mip.alpha = alpha_kind_.value_or(mip.alpha);
}

struct ExtraFiles::Out {
    Extra extra;
    const char* option;
    const char* what;  // in the help
};

const ExtraFiles::Out ExtraFiles::kOuts[] = {
    {Extra::blue, "--blue-out", "what blue holds beside the normals"},
    {Extra::alpha, "--alpha-out", "what alpha holds beside the normals"},
    {Extra::length, "--length-out", "the occlusion in the lengths of vectors"},
};

void ExtraFiles::add(Command& command, const FileOptions& files, const NormalsReader& reads) {
    files_ = &files;
    for (const Out& out : kOuts) {
        const std::string help = fmt::format("write {} to a file; of many inputs a pattern as --name", out.what);
        command.output_file(patterns_[out.extra], out.option, help);
    }
    command.check([this, &command, &reads] {
        for (const auto& [extra, option, what] : kOuts) {
            const std::string& pattern = patterns_[extra];
            if (command.given(option) && (pattern.empty() || pattern == "-"))
                throw UsageError(option, "needs the name of a file");
            if (NamePattern(pattern).uses("level") || NamePattern(pattern).uses("format"))
                throw UsageError(option, "{level} and {format} have no meaning here");
        }
        if (!patterns_.length.empty() && reads.length_in != LengthIn::occlusion)
            throw UsageError("--length-out needs --length-in occlusion");
    });
}

std::optional<ExtraFile> ExtraFiles::file(const Out& row, const Task& task) const {
    const std::string& pattern = patterns_[row.extra];
    if (pattern.empty()) return std::nullopt;
    ExtraFile file;
    file.output = files_->further(row.option, pattern, task);
    const auto container = container_of(file.output);
    if (!container) throw UsageError(printable(file.output), "unsupported output format");
    file.container = *container;
    const FormatInfo info = format_info(encoding_info(default_encoding(*container)).format);
    file.format = info.has_blocks() ? Format::r8_unorm : *format_of(info.sample, info.bits, 1);
    return file;
}

void ExtraFiles::amend(Task& task) const {
    for (const Out& row : kOuts) {
        if (const auto out = file(row, task)) task.more_outputs.push_back(out->output);
    }
}

void ExtraFiles::check(const std::vector<Task>& tasks) const {
    for (const Task& task : tasks) {
        for (const Out& row : kOuts) {
            const auto out = file(row, task);
            if (out && !can_hold(out->container, out->format)) {
                throw UsageError(printable(out->output), fmt::format("{} files cannot hold a single channel",
                                                                     name_of(kContainerNames, out->container)));
            }
        }
    }
}

void ExtraFiles::apply(const Task& task, PackFileOptions& options) const {
    for (const Out& row : kOuts) options.apart[row.extra] = file(row, task);
}

void ExtraFiles::report(Job& job) const {
    for (const Out& row : kOuts) {
        if (const auto out = file(row, job.task)) {
            job.wrote(out->output);
            job.report[std::string(name_of(kExtraNames, row.extra))] = out->output;
        }
    }
}

}  // namespace tex::cli
