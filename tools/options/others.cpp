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
    return NamePattern(pattern).expand(name_fields(task.named()));
}

}  // namespace

const std::array<OtherOptions::PlaceOption, 3> OtherOptions::kPlaceOptions = {{
    {"--blue", "what blue holds instead of z, as --alpha", "z", &OtherPlanes::blue, &OtherInputs::blue,
     &OtherOptions::blue_, "keep", "height", false},
    {"--alpha", "what alpha holds: FILE[:CHANNEL], a number from 0 to 1, or a word", "nothing: it is 1",
     &OtherPlanes::alpha, &OtherInputs::alpha, &OtherOptions::alpha_, "keep", "height", true},
    {"--length", "the occlusion that the lengths of vectors hold, as --alpha", "nothing: vectors are unit",
     &OtherPlanes::length, &OtherInputs::length, &OtherOptions::length_, "occlusion", nullptr, true},
}};

void OtherOptions::take(const std::string& text, const PlaceOption& place) {
    Choice& choice = this->*place.choice;
    choice = {};
    const bool is_number = !text.empty() && text.find_first_not_of("+-.0123456789eE") == std::string::npos;
    if (text == "none") return;
    if (reads_ != nullptr && text == place.kept) {
        choice.from = Choice::From::kept;
    } else if (reads_ == nullptr && place.heights != nullptr && text == place.heights) {
        choice.from = Choice::From::heights;
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

void OtherOptions::add_option(Command& command, const PlaceOption& place) {
    Row& row = command.option(place.option, "WHAT", place.help,
                              [this, &place](const std::string& text) { take(text, place); });
    row.preset = "none";
    if (reads_ != nullptr) {
        row.words = {{place.kept, "what it holds in the input"}};
        if (place.is_kept) row.preset = place.kept;
        if (place.is_kept) (this->*place.choice).from = Choice::From::kept;
    } else if (place.heights != nullptr) {
        row.words = {{place.heights, "the heights that are baked, 0 to 1"}};
    }
    row.words.push_back({"none", place.nothing});
    row.completes = Completes::files;
}

void OtherOptions::add(Command& command, OutputOptions& output, const NormalsReader* reads) {
    is_added_ = true;
    reads_ = reads;
    command.group("Data beside the normals");
    for (const PlaceOption& place : kPlaceOptions) add_option(command, place);
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
        check_lengths(command);
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
    for (const PlaceOption& place : kPlaceOptions) {
        if (!(this->*place.choice).is_given() || can_hold(*output.format).*place.has) continue;
        std::vector<std::string> able;
        for (const auto& row : kEncodingNames) {
            if (can_hold(row.value).*place.has) able.emplace_back(row.name);
        }
        throw UsageError(fmt::format("{} has no room for {}; these formats have: {}",
                                     name_of(kEncodingNames, *output.format), place.option, join(able, ", ")));
    }
}

void OtherOptions::check_lengths(const Command& command) const {
    if (length_.is_given() && blue_.from != Choice::From::nothing)
        throw UsageError("--blue and --length exclude each other: without z, a vector has no length");
    if (reads_ == nullptr) return;
    const bool keeps = length_.from == Choice::From::kept;
    if (keeps && command.given("--length") && reads_->length_in != LengthIn::occlusion)
        throw UsageError("--length occlusion needs --length-in occlusion");
    if (length_.is_given() && reads_->unpack.keep_length)
        throw UsageError("--length and --keep-length exclude each other");
}

void OtherOptions::amend(Task& task) const {
    for (const PlaceOption& place : kPlaceOptions) {
        const Choice& choice = this->*place.choice;
        if (choice.from == Choice::From::file) task.own.push_back(file_for(choice, task).file);
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
        case Choice::From::file: {
            const ChannelFile file = file_for(choice, job.task);
            data.picture = OtherPicture{file.file, job.read_options, file.channel};
        }
    }
    return data;
}

OtherInputs OtherOptions::inputs(Job& job) const {
    OtherInputs inputs;
    for (const PlaceOption& place : kPlaceOptions) inputs.*place.data = data(this->*place.choice, job);
    return inputs;
}

void OtherOptions::apply(UnpackOptions& unpack) const {
    OtherPlanes kept;
    for (const PlaceOption& place : kPlaceOptions) kept.*place.has = (this->*place.choice).from == Choice::From::kept;
    kept.length = kept.length && unpack.others.length;  // if lengths are data
    unpack.others = kept;
}

OtherPlanes OtherOptions::accounted_for(OtherPlanes held) const {
    OtherPlanes planes;
    for (const PlaceOption& place : kPlaceOptions) {
        const Choice& choice = this->*place.choice;
        const bool is_told_to_go = choice.from == Choice::From::nothing && place.is_kept;
        planes.*place.has = choice.is_given() || is_told_to_go || held.*place.has;
    }
    planes.blue = planes.blue && !stores_z();
    return planes;
}

void OtherOptions::apply(MipOptions& mip) const {
    mip.blue = blue_kind_.value_or(mip.blue);
    mip.alpha = alpha_kind_.value_or(mip.alpha);
}

const std::array<OtherFiles::Apart, 3> OtherFiles::kApart = {{
    {"--blue-out", "blue", "what blue holds beside the normals", &OtherFiles::blue_, &PackFileOptions::blue_file},
    {"--alpha-out", "alpha", "what alpha holds beside the normals", &OtherFiles::alpha_, &PackFileOptions::alpha_file},
    {"--length-out", "length", "the occlusion in the lengths of vectors", &OtherFiles::length_,
     &PackFileOptions::length_file},
}};

void OtherFiles::add(Command& command, const FileOptions& files, const NormalsReader& reads) {
    files_ = &files;
    for (const Apart& apart : kApart) {
        const std::string help = fmt::format("write {} to a file; of many inputs a pattern as --name", apart.what);
        command.output_file(this->*apart.pattern, apart.option, help);
    }
    command.check([this, &command, &reads] {
        for (const Apart& apart : kApart) {
            const std::string& pattern = this->*apart.pattern;
            if (command.given(apart.option) && (pattern.empty() || pattern == "-"))
                throw UsageError(apart.option, "needs the name of a file");
            if (NamePattern(pattern).uses("level") || NamePattern(pattern).uses("format"))
                throw UsageError(apart.option, "{level} and {format} have no meaning here");
        }
        if (!length_.empty() && reads.length_in != LengthIn::occlusion)
            throw UsageError("--length-out needs --length-in occlusion");
    });
}

std::optional<OtherFile> OtherFiles::file(const Apart& apart, const Task& task) const {
    const std::string& pattern = this->*apart.pattern;
    if (pattern.empty()) return std::nullopt;
    OtherFile file;
    file.output = files_->further(apart.option, pattern, task);
    const auto container = container_of(file.output);
    if (!container) throw UsageError(printable(file.output), "unsupported output format");
    file.container = *container;
    const FormatInfo info = format_info(encoding_info(default_encoding(*container)).format);
    file.format = info.has_blocks() ? Format::r8_unorm : *format_of(info.sample, info.bits, 1);
    return file;
}

void OtherFiles::amend(Task& task) const {
    for (const Apart& apart : kApart) {
        if (const auto out = file(apart, task)) task.more_outputs.push_back(out->output);
    }
}

void OtherFiles::check(const std::vector<Task>& tasks) const {
    for (const Task& task : tasks) {
        for (const Apart& apart : kApart) {
            const auto out = file(apart, task);
            if (out && !can_hold(out->container, out->format)) {
                throw UsageError(printable(out->output), fmt::format("{} files cannot hold a single channel",
                                                                     name_of(kContainerNames, out->container)));
            }
        }
    }
}

void OtherFiles::apply(const Task& task, PackFileOptions& options) const {
    for (const Apart& apart : kApart) options.*apart.file = file(apart, task);
}

void OtherFiles::report(Job& job) const {
    for (const Apart& apart : kApart) {
        if (const auto out = file(apart, job.task)) {
            job.wrote(out->output);
            job.report[apart.key] = out->output;
        }
    }
}

}  // namespace tex::cli
