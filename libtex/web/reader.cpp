// SPDX-License-Identifier: Apache-2.0

#include "reader.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tex::web {

void fail(const std::string& reason, ErrorCode code) { throw Failure{{code, {}, reason}}; }

const std::string& text_from(const Json& given, const std::string& name) {
    if (!given.is_string()) fail(name + ": expected a string");
    return given.text();
}

const std::vector<Json>& list_from(const Json& given, const std::string& name) {
    if (!given.is_list()) fail(name + ": expected a list");
    return given.elements();
}

Swizzle swizzle_from(const Json& given, const std::string& name) {
    const std::string& text = given.text();
    if (const auto layout = find_by_name(kSwizzleNames, text)) return *layout;
    Swizzle swizzle{};
    bool sound = text.size() == swizzle.size();
    for (std::size_t c = 0; sound && c < swizzle.size(); ++c) {
        const auto component = find_by_name(kComponentNames, std::string_view(text).substr(c, 1));
        sound = component.has_value();
        if (sound) swizzle[c] = *component;
    }
    if (!sound) fail(name + ": must be the name of a layout, or four characters of 01xyz_, for R, G, B and A");
    return swizzle;
}

void Reader::finish() const {
    for (const std::string& key : options_.keys()) {
        if (std::find(names_.begin(), names_.end(), key) == names_.end()) fail("unknown option '" + key + "'");
    }
}

double Reader::number(const char* name, const Json& given) {
    if (!given.is_number()) fail(std::string(name) + ": expected a number");
    return given.number();
}

int Reader::integer(const char* name, const Json& given) {
    const double value = number(name, given);
    if (value != std::floor(value) || std::abs(value) > std::numeric_limits<int>::max())
        fail(std::string(name) + ": expected an integer");
    return static_cast<int>(value);
}

void Lister::add(const char* name, const std::string& type, const std::string& preset, const std::string& must) {
    std::string note;
    if (!preset.empty()) note = "default: " + preset;
    if (!must.empty()) note += (note.empty() ? "" : "; ") + must;
    if (!note.empty()) members += "    /** " + note + " */\n";
    members += std::string("    ") + name + "?: " + type + ";\n";
}

}  // namespace tex::web
