// SPDX-License-Identifier: Apache-2.0

#include "attributes.h"

#include <OpenImageIO/strutil.h>

#include <tex/format.h>

namespace tex::oiio {
namespace {

using OIIO::ImageSpec;

// A setter takes the word of an attribute. It returns an empty text, or what the word must be.
using Setter = std::string (*)(const std::string& word, Wanted& wanted);

template <class E, std::size_t N>
std::string words_of(const Named<E> (&table)[N]) {
    std::string words;
    for (const Named<E>& row : table) words.append(words.empty() ? "one of " : ", ").append(row.name);
    return words;
}

template <class To, class E, std::size_t N>
std::string choose(const std::string& word, const Named<E> (&table)[N], To& to) {
    const std::optional<E> value = find_by_name(table, word);
    if (!value) return words_of(table);
    to = *value;
    return {};
}

std::string choose_number(const std::string& word, int least, int most, int& to) {
    if (OIIO::Strutil::string_is_int(word)) {
        const int value = OIIO::Strutil::stoi(word);
        if (value >= least && value <= most) {
            to = value;
            return {};
        }
    }
    return "a number from " + std::to_string(least) + " to " + std::to_string(most);
}

std::string choose_flag(const std::string& word, bool& to) {
    int number = 0;
    std::string wrong = choose_number(word, 0, 1, number);
    if (wrong.empty()) to = number != 0;
    return wrong.empty() ? wrong : "0 or 1";
}

std::string choose_levels(const std::string& word, Wanted& wanted) {
    wanted.keep_levels = word == "keep";
    wanted.levels = 0;
    if (word == "keep" || word == "all") return {};
    return choose_number(word, 1, 32, wanted.levels).empty() ? "" : "keep, all or a number from 1 to 32";
}

// A name of kSwizzleNames, or what R, G, B and A hold, as letters: "1y1x".
std::string choose_swizzle(const std::string& word, std::optional<Swizzle>& to) {
    if (choose(word, kSwizzleNames, to).empty()) return {};
    Swizzle swizzle{};
    bool right = word.size() == swizzle.size();
    for (std::size_t k = 0; right && k < swizzle.size(); ++k)
        right = choose(word.substr(k, 1), kComponentNames, swizzle[k]).empty();
    if (!right) return words_of(kSwizzleNames) + ", or four letters for R, G, B and A: 0, 1, x, y, z or _";
    to = swizzle;
    return {};
}

// KIND, or KIND,KIND of blue and alpha.
std::string choose_kinds(const std::string& word, Wanted& wanted) {
    const std::size_t comma = word.find(',');
    std::string wrong = choose(word.substr(0, comma), kExtraKindNames, wanted.blue);
    if (!wrong.empty()) return wrong;
    wanted.alpha = wanted.blue;
    return comma == std::string::npos ? "" : choose(word.substr(comma + 1), kExtraKindNames, wanted.alpha);
}

std::string ignore(const std::string&, Wanted&) { return {}; }

struct Attribute {
    const char* name;
    Setter set;
};

// The order is that of the manual.
constexpr Attribute kAttributes[] = {
    {"tex:format", [](const std::string& word, Wanted& w) { return choose(word, kEncodingNames, w.format); }},
    {"tex:y", [](const std::string& word, Wanted& w) { return choose(word, kYAxisNames, w.y); }},
    {"tex:effort", [](const std::string& word, Wanted& w) { return choose(word, kEffortNames, w.pack.effort); }},
    {"tex:metric", [](const std::string& word, Wanted& w) { return choose(word, kMetricNames, w.pack.metric); }},
    {"tex:mips", choose_levels},
    {"tex:kind", choose_kinds},
    {"tex:swizzle", [](const std::string& word, Wanted& w) { return choose_swizzle(word, w.pixels.swizzle); }},
    {"tex:dds-header",
     [](const std::string& word, Wanted& w) { return choose(word, kDdsHeaderNames, w.write.dds_header); }},
    {"tex:dds-mark", [](const std::string& word, Wanted& w) { return choose_flag(word, w.write.dds_mark); }},
    {"tex:zstd",
     [](const std::string& word, Wanted& w) { return choose_number(word, 0, kHighestZstdLevel, w.write.zstd); }},
    {"normalYAxis", [](const std::string& word, Wanted& w) { return choose(word, kYAxisNames, w.pixels.y_axis); }},
    // What the reader states about a file. Programs hand it on to the file that they write.
    {"tex:stored", ignore},
    {"tex:layout", ignore},
    {"tex:remarks", ignore},
    {"tex:trailing_bytes", ignore},
    {"tex:unpack", ignore},
    {"tex:length-in", ignore},
};

const Attribute* find_attribute(const OIIO::string_view& name) {
    for (const Attribute& row : kAttributes) {
        if (name == row.name) return &row;
    }
    return nullptr;
}

Error mistake(const std::string& reason) { return {ErrorCode::bad_option, {}, reason}; }

std::string wrong_word(const std::string& name, const std::string& word, const std::string& right) {
    return "the attribute " + name + " is \"" + word + "\"; it must be " + right;
}

// What libtex writes into pictures about their pixels (see encode_file()): PNG has it under this name, TIFF and others
// in a line of the description. A text that is no such mark says nothing.
constexpr const char* kMark = "libtex.normal";

void apply_mark(const ImageSpec& spec, Wanted& wanted) {
    std::string mark = spec.get_string_attribute(kMark);
    if (mark.empty()) {
        const std::string prefix = std::string(kMark) + " ";
        for (const OIIO::string_view& line :
             OIIO::Strutil::splitsv(spec.get_string_attribute("ImageDescription"), "\n")) {
            if (OIIO::Strutil::starts_with(line, prefix)) mark = std::string(line.substr(prefix.size()));
        }
    }
    const std::size_t blank = mark.find(' ');
    if (!choose_swizzle(mark.substr(0, blank), wanted.pixels.swizzle).empty() || blank == std::string::npos) return;
    const std::string y = mark.substr(blank + 1);
    if (y == "+y") wanted.pixels.y_axis = YAxis::up;
    if (y == "-y") wanted.pixels.y_axis = YAxis::down;
}

// The encoding of these texels; nullopt if pack() makes none such. Files without formats of three channels hold those
// with a fourth one, which matters only if there is data in it.
std::optional<Encoding> encoding_of(const Texture& texture, ExtraSet extras) {
    const auto holds = [&](Encoding encoding, Format format) {
        Swizzle swizzle = encoding_info(encoding).swizzle;
        if (extras.blue && can_hold(encoding).blue) swizzle[2] = texture.swizzle[2];
        return format == texture.format && layout_name(swizzle) == layout_name(texture.swizzle);
    };
    for (const Named<Encoding>& row : kEncodingNames) {
        const Format format = encoding_info(row.value).format;
        const FormatInfo info = format_info(format);
        if (extras.alpha || info.channels != 3 || info.has_blocks() || info.bits == 8) continue;
        const std::optional<Format> wider = format_of(info.sample, info.bits, 4);
        if (wider && holds(row.value, *wider)) return row.value;
    }
    for (const Named<Encoding>& row : kEncodingNames) {
        if (holds(row.value, encoding_info(row.value).format)) return row.value;
    }
    return std::nullopt;
}

// An attribute of any type as text.
std::string word_of(const ImageSpec& spec, const char* name) {
    const OIIO::ParamValue* value = spec.find_attribute(name);
    return value == nullptr ? "" : OIIO::Strutil::lower(value->get_string());
}

}  // namespace

Result<Wanted> wanted_of(const ImageSpec& spec) {
    Wanted wanted;
    apply_mark(spec, wanted);
    for (const OIIO::ParamValue& value : spec.extra_attribs) {
        const std::string name = value.name().string();
        const Attribute* attribute = find_attribute(name);
        if (attribute == nullptr) {
            if (OIIO::Strutil::starts_with(name, "tex:"))
                return mistake("there is no attribute " + name + "; tex-oiio(7) lists them");
            continue;
        }
        const std::string word = OIIO::Strutil::lower(value.get_string());
        const std::string right = attribute->set(word, wanted);
        if (!right.empty()) return mistake(wrong_word(name, value.get_string(), right));
    }
    return wanted;
}

Result<Reading> reading_of(const ImageSpec& config) {
    for (const OIIO::ParamValue& value : config.extra_attribs) {
        const std::string name = value.name().string();
        if (OIIO::Strutil::starts_with(name, "tex:") && name != "tex:unpack" && name != "tex:swizzle" &&
            name != "tex:length-in") {
            return mistake("there is no attribute " + name +
                           " for reading; there are tex:unpack, tex:swizzle and tex:length-in");
        }
    }
    Reading reading;
    std::string right;
    if (const std::string unpack = word_of(config, "tex:unpack"); !unpack.empty()) {
        right = choose_flag(unpack, reading.unpack);
        if (!right.empty()) return mistake(wrong_word("tex:unpack", unpack, right));
    }
    if (const std::string lengths = word_of(config, "tex:length-in"); !lengths.empty()) {
        if (lengths != "occlusion" && lengths != "ignore")
            return mistake(wrong_word("tex:length-in", lengths, "one of occlusion, ignore"));
        reading.has_lengths = lengths == "occlusion";
    }
    const std::string swizzle = word_of(config, "tex:swizzle");
    if (swizzle.empty()) return reading;
    right = choose_swizzle(swizzle, reading.swizzle);
    if (!right.empty()) return mistake(wrong_word("tex:swizzle", swizzle, right));
    return reading;
}

void describe(const Texture& texture, const std::optional<Swizzle>& pixels, ExtraSet extras, ImageSpec& spec) {
    const auto word = [&](const char* name, std::string_view value) { spec.attribute(name, std::string(value)); };
    word("tex:stored", name_of(kFormatNames, texture.format));
    word("tex:layout", layout_name(texture.swizzle));
    if (const std::optional<Encoding> encoding = encoding_of(texture, extras))
        word("tex:format", name_of(kEncodingNames, *encoding));
    std::string mark = pixels ? layout_name(*pixels) : "";
    if (texture.y_known && pixels) {
        word("tex:y", name_of(kYAxisNames, texture.y_axis));
        word("normalYAxis", name_of(kYAxisNames, texture.y_axis));
        mark += texture.y_axis == YAxis::up ? " +y" : " -y";
    }
    if (pixels) {
        word(kMark, mark);
        word("ImageDescription", std::string(kMark) + " " + mark);  // which TIFF and JPEG keep
    }
    std::string remarks;
    for (const std::string& remark : texture.remarks) remarks.append(remarks.empty() ? "" : "; ").append(remark);
    if (!remarks.empty()) word("tex:remarks", remarks);
    if (texture.trailing_bytes > 0) word("tex:trailing_bytes", std::to_string(texture.trailing_bytes));
}

}  // namespace tex::oiio
