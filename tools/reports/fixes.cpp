// SPDX-License-Identifier: Apache-2.0

#include "reports/fixes.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tex/file.h>

#include "cli/text.h"
#include "options/output.h"
#include "reports/repair_fixes.h"
#include "tasks/model_output.h"
#include "tasks/name_pattern.h"

namespace tex::cli {
namespace {

// Whether a texel of `made` holds all that is stored: x and y where they were (ATI2 is BC5 with y first), z if it was
// stored. ASTC's layout is always the same, and floats may hold z too.
bool holds(const EncodingInfo& made, const FormatInfo& format, const Swizzle& stored) {
    if (made.swizzle == kSwizzleXxxy) return true;
    const bool is_float = format.sample == SampleKind::floating;
    if (made.format == Format::bc5_unorm && stored == kSwizzleYx) return true;
    for (std::size_t channel = 0; channel < 4; ++channel) {
        const auto is = [&](const Swizzle& layout, Component component) { return layout[channel] == component; };
        for (const Component component : {Component::x, Component::y}) {
            if (is(made.swizzle, component) != is(stored, component)) return false;
        }
        if (is(made.swizzle, Component::z) != is(stored, Component::z) && !(is_float && channel == 2)) return false;
    }
    return true;
}

// The encoding that holds every stored component of this layout with as many bits: in the same format, or else without
// what the other channels hold. None if there is no such encoding.
std::optional<Encoding> same_encoding(Format format, const Swizzle& swizzle) {
    const FormatInfo info = format_info(format);
    std::optional<Encoding> found;
    for (const Named<Encoding>& encoding : kEncodingNames) {
        const EncodingInfo made = encoding_info(encoding.value);
        const FormatInfo its = format_info(made.format);
        const bool is_alike = !info.has_blocks() && !its.has_blocks() && its.sample == info.sample &&
                              its.bits == info.bits && info.bits > 8;
        if ((made.format != format && !is_alike) || !holds(made, info, swizzle)) continue;
        if (made.format == format) return encoding.value;
        if (!found) found = encoding.value;
    }
    return found;
}

// The encoding of heights with as many bits.
Encoding encoding_of_heights(Format format) {
    const FormatInfo info = format_info(format);
    if (info.sample == SampleKind::floating) return info.bits == 16 ? Encoding::half : Encoding::float_;
    return info.bits > 8 ? Encoding::rgb16 : Encoding::rgb8;
}

// A container and an encoding that it can hold.
struct Target {
    Container container = Container::png;
    Encoding encoding = Encoding::rgb8;
};

// The file's own container if possible: JPEG would lose more, and some containers cannot be written or hold one level.
std::optional<Target> target_for(const std::string& file, Encoding encoding, bool with_levels) {
    const std::optional<Container> own = container_of(file);
    for (const std::optional<Container> container : {own, std::optional(Container::png), std::optional(Container::exr),
                                                     std::optional(Container::dds), std::optional(Container::ktx2)}) {
        if (!container || *container == Container::jpeg || (with_levels && !can_hold_levels(*container))) continue;
        if (can_hold(*container, encoding)) return Target{*container, encoding};
        // An alpha of 1 is no data; a container that always has alpha takes it.
        for (const auto& [with, without] :
             {std::pair(Encoding::rgba8, Encoding::rgb8), std::pair(Encoding::rgb8, Encoding::rgba8)}) {
            if (encoding == with && can_hold(*container, without)) return Target{*container, without};
        }
    }
    return std::nullopt;
}

// The rules about a direction of green that the texels contradict.
bool is_about_mirrors(std::string_view id) { return is_any_of(id, {"N401", "N404"}); }

// Whether the heights show that red is mirrored, and not green.
bool is_red_mirrored(std::string_view id, const CheckReport& report) {
    return is_about_mirrors(id) && report.pair && report.pair->decides() && report.pair->strength < 0.0;
}

// Turns red over, and nothing else: all slopes, and then green back.
constexpr std::string_view kRedFix = "scale-normals FILE --scale -1 --y-in MEASURED --y OTHER --format SAME -o FIXED";

// The command of a rule, in the form of Rule::fix.
std::string_view words_of(const Rule& rule, const CheckReport& report) {
    return is_red_mirrored(rule.id, report) ? kRedFix : rule.fix;
}

// True if the texels measure in the direction that the command would state.
bool is_clear(std::string_view id, const CheckReport& report, const Requirements& require) {
    if (id == "N112") return report.y.y && report.y.y == require.y;
    return !is_about_mirrors(id) || report.y.y.has_value();
}

// An encoding with its alpha.
std::optional<Encoding> with_alpha(Encoding encoding) {
    const auto [format, swizzle] = encoding_info(encoding);
    const FormatInfo info = format_info(format);
    for (const Named<Encoding>& row : kEncodingNames) {
        const EncodingInfo its = encoding_info(row.value);
        if (can_hold(row.value).alpha && its.swizzle == swizzle && its.format == format_of(info.sample, info.bits, 4))
            return row.value;
    }
    return std::nullopt;
}

// Whether the command can carry along what the other channels hold: alpha, beside x, y and z.
bool carries_extras(const Rule& rule, const CheckReport& report) {
    const bool is_alpha =
        report.swizzle[0] == Component::x && report.swizzle[1] == Component::y && report.swizzle[2] == Component::z;
    const bool drops = rule.fix.find("--drop") != std::string_view::npos;
    return is_alpha && !drops && !is_any_of(rule.id, {"N108", "N208", "N210"});
}

// What the file becomes; none if no command writes that.
std::optional<Target> target_of(std::string_view id, const CheckReport& report, const Requirements& require) {
    const bool grey = id == "N210";
    Swizzle swizzle = report.swizzle;
    if (id == "N209" && swizzle[0] == Component::x && swizzle[1] == Component::y) swizzle[2] = Component::z;
    std::optional<Encoding> encoding =
        grey ? encoding_of_heights(report.format) : same_encoding(report.format, swizzle);
    if (id == "N108" || (encoding && require.encoding)) encoding = require.encoding;
    if (id == "N208" && encoding) encoding = Encoding::half;
    // Blocks of colours and alpha are not written; 8 bits hold all that they do.
    const FormatInfo format = format_info(report.format);
    if (!encoding && report.more_data && format.has_blocks() && format.sample == SampleKind::unorm)
        encoding = Encoding::rgba8;
    if (!encoding) return std::nullopt;
    if (report.more_data) {
        encoding = with_alpha(*encoding);
        const std::optional<Container> own = container_of(report.file);
        if (!encoding || !own || !can_hold(*own, *encoding)) return std::nullopt;
    }
    const bool builds = is_any_of(id, {"N103", "N109", "N501", "N502", "N503", "N504"}) && require.levels != 1;
    return target_for(report.file, *encoding, builds || report.levels > 1);
}

std::string levels_text(const Requirements& require) {
    const int levels = require.levels.value_or(0);
    return levels == 0 ? "all" : levels == 1 ? "none" : std::to_string(levels);
}

// Whether the command of a rule writes FIXED from FILE.
bool is_command(const Rule& rule) { return rule.fix.find("-normals FILE") != std::string_view::npos; }

// The command of a rule in parts. Where the background is filled, the smaller levels are built again.
struct FixCommand {
    std::string program;
    std::vector<std::string> options;  // with their values, without --format and -o
};

FixCommand command_of(const Rule& rule, const CheckReport& report) {
    FixCommand command;
    for (const std::string& word : split(std::string(words_of(rule, report)), ' ')) {
        if (command.program.empty())
            command.program = word;
        else if (word.starts_with("-"))
            command.options.push_back(word);
        else if (!command.options.empty())
            command.options.back() += " " + word;
    }
    std::erase_if(command.options, [](const std::string& o) { return o.starts_with("--format ") || o == "-o FIXED"; });
    if (rule.id == "N215" && report.levels > 1) command.program = "mip-normals";
    return command;
}

constexpr std::string_view kKeepLength = "--keep-length";

// Adds the options of `other`, which fixes another finding. Vectors keep their length only if both commands keep it;
// without that word, mip-normals makes them unit vectors, and pack-normals does so if it is told.
void join_commands(FixCommand& command, const FixCommand& other) {
    if (other.program == "mip-normals") command.program = other.program;
    const auto has = [&](std::string_view name) {
        return std::any_of(command.options.begin(), command.options.end(), [&](const std::string& own) {
            return std::string_view(own).substr(0, own.find(' ')) == name;
        });
    };
    const bool keeps = std::find(other.options.begin(), other.options.end(), kKeepLength) != other.options.end();
    if (!keeps) std::erase(command.options, kKeepLength);
    for (const std::string& option : other.options) {
        const std::string_view name = std::string_view(option).substr(0, option.find(' '));
        if (name != kKeepLength && !has(name)) command.options.push_back(option);
    }
    if (command.program == "mip-normals") std::erase(command.options, "--normalize");
}

// Whether one command can do this and other things: mip-normals does all that pack-normals does.
bool can_be_joined(const Finding& finding, const CheckReport& report) {
    if (!is_command(*finding.rule) || is_red_mirrored(finding.rule->id, report)) return false;
    if (report.more_data && !carries_extras(*finding.rule, report)) return false;
    const std::string program = command_of(*finding.rule, report).program;
    return (program == "pack-normals" || program == "mip-normals") && finding.rule->id != "N108";
}

// The findings that one command fixes, among them `finding`.
std::vector<const Finding*> fixed_together(const Finding& finding, const CheckReport& report,
                                           const Requirements& require) {
    std::vector<const Finding*> together;
    const auto target = target_of(finding.rule->id, report, require);
    for (const Finding& other : report.findings) {
        const bool is_same = &other == &finding;
        if (!is_same && (!can_be_joined(finding, report) || !can_be_joined(other, report))) continue;
        if (!is_same && (!is_clear(other.rule->id, report, require) || !other.fix_harms.empty())) continue;
        const auto others = target_of(other.rule->id, report, require);
        if (is_same || (target && others && target->encoding == others->encoding)) together.push_back(&other);
    }
    return together;
}

}  // namespace

namespace {

std::string filled_in(std::string fix, const Target& target, const CheckReport& report, const Requirements& require) {
    std::string same(name_of(kEncodingNames, target.encoding));
    if (format_info(encoding_info(target.encoding).format).has_blocks()) same += " --effort best";
    const YAxis measured = report.y.y.value_or(YAxis::up);
    replace_word(fix, "SAME", same);
    replace_word(fix, "WANTED", name_of(kYAxisNames, require.y.value_or(YAxis::up)));
    replace_word(fix, "MEASURED", name_of(kYAxisNames, measured));
    replace_word(fix, "OTHER", name_of(kYAxisNames, measured == YAxis::up ? YAxis::down : YAxis::up));
    replace_word(fix, "LEVELS", levels_text(require));
    replace_word(fix, "FIXED", "FIXED" + extension_of(target.container));
    replace_word(fix, "FILE", shell_file(report.file));  // last, because a name may contain the words above
    return fix;
}

// What to do if green is right and red is mirrored, as long as no heights have shown which.
std::string mirror_advice(std::string_view id, const Target& target, const CheckReport& report,
                          const Requirements& require) {
    if (!is_about_mirrors(id) || (report.pair && report.pair->decides())) return {};
    return "If bumps look like dents after that, red was mirrored instead, as in a picture that was flipped: " +
           filled_in(std::string(kRedFix), target, report, require) +
           "; check-normals --height FILE decides between the two, and so does a look at the occlusion map or the mesh";
}

// What to do if all channels are inverted: blue is no longer, after the fix.
std::string inverted_advice(const CheckReport& report, const Requirements& require) {
    const std::string text =
        "That inverts blue alone. If bumps look like dents after that, the whole picture was inverted";
    const auto target = report.map.empty() ? target_of("N220", report, require) : std::nullopt;
    if (!target) return text + ": invert all of it in an image editor instead";
    std::string command = filled_in("scale-normals FIXED --scale -1 --format SAME -o TURNED", *target, report, require);
    replace_word(command, "TURNED", "TURNED" + extension_of(target->container));
    return text + ": then also " + command;
}

// The command that writes the model again, with this map corrected.
Fix model_fix(const Finding& finding, const CheckReport& report, const Requirements& require) {
    const std::string_view id = finding.rule->id;
    const std::string type = type_of_model(report);
    const auto target = target_of(id, report, require);
    const bool is_written = !type.empty() && target && command_of(*finding.rule, report).program == "pack-normals" &&
                            !is_red_mirrored(id, report) && id != "N108";
    if (id == "N210" && !type.empty()) {
        return {
            fmt::format("If these are heights, repair-normals {} --bumpiness B -o FIXED{} bakes normals of them, which "
                        "are B texels high where white is. Else put the normal map into its place.",
                        shell_file(report.file), type)};
    }
    if (!is_written) return {"Correct the image in the program that made it, and put it into the model again."};
    FixCommand command;
    for (const Finding* each : fixed_together(finding, report, require)) {
        const FixCommand step = command_of(*each->rule, report);
        if (step.program != "pack-normals") continue;
        command.program.empty() ? void(command = step) : join_commands(command, step);
    }
    std::string options;
    for (const std::string& option : command.options) options += " " + option;
    if (is_for_models(target->encoding) && target->encoding != Encoding::rgb8) options += " --format SAME";
    Fix fix{fmt::format("{} {} --material {}{} -o FIXED{}", command.program, shell_file(report.file),
                        shell_word(report.material), filled_in(options, *target, report, require), type),
            true};
    if (is_about_mirrors(id) && !(report.pair && report.pair->decides())) {
        fix.advice =
            "If bumps look like dents after that, red was mirrored instead, as in a picture that was flipped: "
            "repair-normals --mirrored red writes the model with red inverted";
    }
    return fix;
}

}  // namespace

Fix fix_of(const Finding& finding, const CheckReport& report, const Requirements& require) {
    const std::string_view id = finding.rule->id;
    if (!finding.fix_harms.empty()) return {"No command is printed, because " + finding.fix_harms + "."};
    if (auto fix = tangent_fix(finding, report)) return *fix;
    if (id == "N214" && report.height_bytes && report.map.empty()) {
        return {fmt::format("bake-normals {} --channel {} --bumpiness auto --format rgb8 -o FIXED.png",
                            shell_file(report.file), name_of(kHeightChannelNames, *report.height_bytes)),
                true, "For the slopes of the ground, bake-normals(1) takes the size of the land: --world-size."};
    }
    if (auto fix = repair_fix(finding, report, require)) {
        if (id == "N220") fix->advice = inverted_advice(report, require);
        return *fix;
    }
    if (!is_command(*finding.rule)) return {std::string(finding.rule->fix)};
    if (id == "N108" && !require.encoding) return {"Store the file in the format that is required."};
    if (report.more_data && !(carries_extras(*finding.rule, report) && target_of(id, report, require))) {
        if (id == "N212" && report.map.empty()) {
            return {
                "If that data belongs there, --swizzle rgb says so, or labpbr where blue holds occlusion. No command: "
                "it would lose the data, which unpack-normals --alpha-out saves."};
        }
        return {
            "No command is printed, because it would lose what the other channels hold. Save that first with "
            "unpack-normals --alpha-out or --blue-out; pack-normals --format rgba8 keeps alpha."};
    }
    if (!is_clear(id, report, require)) {
        return {
            "The texels do not show which way green points. Find that out first: if it is as required, only the "
            "statement is wrong."};
    }
    if (!report.map.empty()) return model_fix(finding, report, require);
    const std::vector<const Finding*> together = fixed_together(finding, report, require);
    FixCommand command;
    std::optional<Target> target;
    for (const Finding* each : together) {
        const auto own = target_of(each->rule->id, report, require);
        // A container that holds levels is the one for all.
        if (!target || (own && can_hold_levels(own->container))) target = own;
        const FixCommand step = command_of(*each->rule, report);
        command.program.empty() ? void(command = step) : join_commands(command, step);
    }
    if (!target) {
        return {fmt::format(
            "No command writes normals as {} in channels like these: correct the file in the program that made it.",
            name_of(kFormatNames, report.format))};
    }
    std::string fix = command.program + " FILE";
    for (const std::string& option : command.options) fix += " " + option;
    // 8 bits and PNG have neither NaN nor values that a file may state to be no data.
    if (id == "N210" && format_info(report.format).bits > 8 && container_of(report.file) != Container::png)
        fix += " --fill-invalid";
    fix += " --format SAME -o FIXED";
    std::string advice = mirror_advice(id, *target, report, require);
    // Occlusion that stays near 1 looks like the z of short vectors, and a command would wipe it out.
    if (id == "N201" && (target->encoding == Encoding::rgba8 || target->encoding == Encoding::rgba16)) {
        return {
            fmt::format("If blue holds z: {}. If it holds occlusion, as in LabPBR, --swizzle labpbr checks x and y "
                        "alone.",
                        filled_in(std::move(fix), *target, report, require))};
    }
    return {filled_in(std::move(fix), *target, report, require), true, std::move(advice)};
}

}  // namespace tex::cli
