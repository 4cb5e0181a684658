// SPDX-License-Identifier: Apache-2.0

#include "cli/source.h"

#include <algorithm>

#include <fmt/format.h>
#include <tex/swizzle.h>

#include "cli/console.h"
#include "cli/text.h"
#include "cli/usage_error.h"

namespace tex::cli {
namespace {

constexpr Swizzle kXY = {Component::x, Component::y, Component::zero, Component::one};
constexpr Swizzle kYX = {Component::y, Component::x, Component::zero, Component::one};

bool is_bc5(Format format) {
    return format == Format::bc5_unorm || format == Format::bc5_snorm;
}

// "rgb" for what is in the table, else the letters: "1y1x".
std::string swizzle_name(const Swizzle& swizzle) {
    const std::string_view name = name_of(kSwizzleNames, swizzle);
    return name.empty() ? to_string(swizzle) : std::string(name);
}

Encoding exact_encoding(const Source& source) {
    switch (source.format) {
        case Format::bc3_unorm:
            return Encoding::dxt5nm;
        case Format::bc5_unorm:
            return Encoding::bc5;
        case Format::bc5_snorm:
            return Encoding::bc5_snorm;
        case Format::rg8_unorm:
        case Format::rg8_snorm:
            return Encoding::rg8;
        case Format::rg16_unorm:
        case Format::rg16_snorm:
            return Encoding::rg16;
        default:
            break;
    }
    const FormatInfo info = format_info(source.format);
    if (info.sample == SampleKind::floating) return info.bits == 16 ? Encoding::half : Encoding::float_;
    if (info.bits == 16) return Encoding::rgb16;
    if (info.block == 1 && source.swizzle[3] == Component::x) return Encoding::ag8;
    return source.format == Format::rgba8_unorm ? Encoding::rgba8 : Encoding::rgb8;
}

}  // namespace

Encoding encoding_of(const Source& source, const Task& task) {
    const auto is_texture = [](Container container) {
        return container == Container::dds || container == Container::ktx2;
    };
    const std::optional<Container> before = container_of(task.input);
    const Encoding encoding = exact_encoding(source);
    if (before && is_texture(*before) == is_texture(task.container)) {
        if (can_hold(task.container, encoding)) return encoding;
        if (encoding == Encoding::rgba8 && can_hold(task.container, Encoding::rgb8)) return Encoding::rgb8;
    }
    return default_encoding(task.container);
}

void SourceOptions::add(Command& command, bool with_keep_length) {
    command.group("Input");
    command.choice(unpack.y_axis, "--y-in", "AXIS", kYAxisNames, "where green points in the input").preset =
        "as the file says, else up";
    Row& row = command.option("--swizzle", "S", "which channels hold what", [this](const std::string& text) {
        std::vector<std::string> names = names_of(words_of(kSwizzleNames));
        names.insert(names.end(), {"auto", "rgorag"});
        check_word(text, names);
        swizzle = find_by_name(kSwizzleNames, text);
        rg_or_ag = text == "rgorag";
    });
    row.words = words_of(kSwizzleNames);
    row.words.insert(row.words.begin(), {"auto", "as the file says, else as its texels look"});
    row.words.push_back({"rgorag", "x in R or A, whichever varies, y in G: R * A in a shader"});
    row.preset = "auto";
    row.completes = Completes::words;
    command
        .choice(bc5_order, "--bc5-order", "ORDER", kBc5OrderNames,
                "the channels of BC5 files that do not say")
        .preset = "yx in ATI2, else xy";
    command.choice(unpack.range, "--range", "R", kValueRangeNames, "how stored floats are to be read");
    command.flag(unpack.snap_flat, "--snap-flat", "read 127 and 128 of 8-bit files as 0");
    if (with_keep_length) command.flag(unpack.keep_length, "--keep-length", "do not normalise what is read");
}

Result<Swizzle> SourceOptions::swizzle_of(const std::string& path, const Texture& texture) {
    if (swizzle) return *swizzle;
    if (bc5_order && is_bc5(texture.format)) return *bc5_order == Bc5Order::xy ? kXY : kYX;
    if (texture.swizzle_known && !rg_or_ag) return texture.swizzle;
    auto guessed = guess_swizzle(texture);
    if (!guessed) return guessed.error();
    if (rg_or_ag) return (*guessed)[3] == Component::x ? *guessed : kXY;
    // Nothing is told where a file is what everybody takes it for: x, y and z in R, G and B.
    const std::string name = swizzle_name(*guessed);
    if (format_info(texture.format).channels == 4 && (name != "rgb" || texture.swizzle[3] == Component::x)) {
        const std::lock_guard lock(mutex_);
        Guesses& guesses = guesses_[name];
        // Of files that are read at once any may come first: the first in the alphabet is named.
        if (guesses.count++ == 0 || path < guesses.first) guesses.first = path;
    }
    return *guessed;
}

void SourceOptions::warn_of_guesses() const {
    for (const auto& [name, guesses] : guesses_) {
        const std::string more =
            guesses.count > 1 ? fmt::format(" and {} more", guesses.count - 1) : std::string();
        print_warning(fmt::format("{}{}: taken for {}, as the texels look; --swizzle says otherwise",
                                  guesses.first, more, name));
    }
}

YAxis SourceOptions::y_of(const Texture& texture, const Reading& reading) const {
    if (reading.y) return *reading.y;
    if (reading.is_detail && texture.y_known) return texture.y_axis;
    return unpack.y_axis.value_or(texture.y_axis);
}

Result<Source> SourceOptions::read(Job& job, const std::string& path, const Execution& execution,
                                   const Reading& reading) {
    const auto named = [&](Error error) {
        if (error.file.empty()) error.file = path;
        return error;
    };
    auto texture = read_texture(path, job.read_options);
    if (!texture) return texture.error();
    const std::string prefix = path == job.task.input ? std::string() : path + ": ";
    for (const std::string& remark : texture->remarks) job.warn(prefix + remark);
    if (texture->srgb)
        job.warn(prefix + "declares sRGB colours, which normals are not; its values are used as they are");
    if (reading.base_only) texture->levels.resize(1);

    if (format_info(texture->format).channels == 1) {
        return Error{ErrorCode::unsupported, path,
                     "has one channel, which holds no normals (bake-normals reads heights)"};
    }

    Source source;
    auto guessed = swizzle_of(path, *texture);
    if (!guessed) return named(guessed.error());
    source.swizzle = *guessed;
    source.format = texture->format;
    source.y = y_of(*texture, reading);

    UnpackOptions options = unpack;
    options.swizzle = source.swizzle;
    options.y_axis = source.y;
    options.keep_length = reading.keep_length.value_or(unpack.keep_length);
    // Floats that say that they are normals are taken at their word: a chain of commands then gives the bytes of one.
    const FormatInfo info = format_info(texture->format);
    if (info.sample == SampleKind::floating && info.bits == 32 && texture->normal_encoding == "signed") {
        options.keep_length = true;
    }
    auto chain = tex::unpack(*texture, options, execution);
    if (!chain) return named(chain.error());
    source.chain = std::move(*chain);
    return source;
}

Result<Source> SourceOptions::read(Job& job, double until, bool base_only) {
    auto source = read(job, job.task.input, job.until(until), {base_only});
    if (!source) return source.error();
    job.report["source"] = {{"format", name_of(kFormatNames, source->format)},
                            {"swizzle", swizzle_name(source->swizzle)}};
    return source;
}

}  // namespace tex::cli
