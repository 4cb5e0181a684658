// SPDX-License-Identifier: Apache-2.0

#include "formats/prj.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>

#include "formats/words.h"

namespace tex::inline v1 {
namespace {

struct Length {
    std::string_view name;
    double metres;
};

constexpr double kFoot = 0.3048, kSurveyFoot = 1200.0 / 3937.0;
constexpr Length kLengths[] = {
    {"m", 1.0},
    {"metre", 1.0},
    {"metres", 1.0},
    {"meter", 1.0},
    {"meters", 1.0},
    {"ft", kFoot},
    {"foot", kFoot},
    {"feet", kFoot},
    {"foot (international)", kFoot},
    {"international foot", kFoot},
    {"us survey foot", kSurveyFoot},
    {"us survey feet", kSurveyFoot},
    {"us-ft", kSurveyFoot},
    {"ftus", kSurveyFoot},
    {"foot_us", kSurveyFoot},
    {"sft", kSurveyFoot},
    {"km", 1000.0},
    {"kilometre", 1000.0},
    {"dm", 0.1},
    {"decimetre", 0.1},
    {"cm", 0.01},
    {"centimetre", 0.01},
    {"mm", 0.001},
    {"millimetre", 0.001},
};

// The well-known text NAME[...] that is found first in `text`, without its name and its brackets. Nothing if there is
// none; brackets inside quotes do not count.
std::optional<std::string_view> part_of(std::string_view text, std::string_view name) {
    bool is_quoted = false, is_inside = false;
    int depth = 0;
    std::size_t first = 0;
    for (std::size_t at = 0; at < text.size(); ++at) {
        const char c = text[at];
        if (c == '"') is_quoted = !is_quoted;
        if (is_quoted) continue;
        const bool opens = c == '[' || c == '(', closes = c == ']' || c == ')';
        if (is_inside) {
            depth += opens ? 1 : closes ? -1 : 0;
            if (depth < 0) return text.substr(first, at - first);
        } else if (opens && at >= name.size() && text.substr(at - name.size(), name.size()) == name &&
                   (at == name.size() || text[at - name.size() - 1] < 'A' || text[at - name.size() - 1] > 'Z')) {
            is_inside = true;
            first = at + 1;
        }
    }
    return std::nullopt;
}

// The number after the n-th comma of a part: ["Metre",1.0].
std::optional<double> number_after(std::string_view part, int commas) {
    bool is_quoted = false;
    for (std::size_t at = 0; at < part.size(); ++at) {
        if (part[at] == '"') is_quoted = !is_quoted;
        if (is_quoted || part[at] != ',' || --commas > 0) continue;
        std::string_view rest = part.substr(at + 1);
        rest = rest.substr(0, rest.find_first_of(",]"));
        while (!rest.empty() && is_blank(rest.front())) rest.remove_prefix(1);
        while (!rest.empty() && is_blank(rest.back())) rest.remove_suffix(1);
        return number_in(rest);
    }
    return std::nullopt;
}

// The unit of a coordinate system: the last one of it, because those of systems inside come before.
// `kind` is its name since the text of 2015: LENGTHUNIT.
std::optional<double> unit_of(std::string_view all, std::string_view kind) {
    std::optional<double> unit;
    for (const std::string_view name : {std::string_view("UNIT"), kind}) {
        std::string_view system = all;
        for (std::optional<std::string_view> part; (part = part_of(system, name));) {
            unit = number_after(*part, 1);
            system.remove_prefix(static_cast<std::size_t>(part->data() + part->size() - system.data()));
        }
        if (unit) return unit;
    }
    return unit;
}

void read_ellipsoid(std::string_view text, GridPlace& place) {
    std::optional<std::string_view> part = part_of(text, "SPHEROID");
    if (!part) part = part_of(text, "ELLIPSOID");
    if (!part) return;
    const std::optional<double> equator = number_after(*part, 1), inverse = number_after(*part, 2);
    if (!equator || !inverse) return;
    place.equator = *equator;
    place.pole = *inverse == 0.0 ? *equator : *equator * (1.0 - 1.0 / *inverse);
}

void read_well_known(std::string_view text, GridPlace& place) {
    constexpr double kDegree = 0.017453292519943295;
    for (const std::string_view name : {"VERTCS", "VERT_CS", "VERTCRS"}) {
        const std::optional<std::string_view> heights = part_of(text, name);
        if (const std::optional<double> unit = heights ? unit_of(*heights, "LENGTHUNIT") : std::nullopt)
            place.height_metres = *unit;
    }
    read_ellipsoid(text, place);
    for (const std::string_view name : {"PROJCS", "PROJCRS"}) {
        const std::optional<std::string_view> system = part_of(text, name);
        if (!system) continue;
        place.model = GridModel::projected;
        place.unit = unit_of(*system, "LENGTHUNIT").value_or(-1.0);
        const bool is_web = system->find("Mercator_Auxiliary_Sphere") != std::string_view::npos ||
                            system->find("Pseudo-Mercator") != std::string_view::npos;
        if (is_web) place.model = GridModel::mercator;
        return;
    }
    for (const std::string_view name : {"GEOGCS", "GEOGCRS", "GEODCRS"}) {
        const std::optional<std::string_view> system = part_of(text, name);
        if (!system) continue;
        place.model = GridModel::geographic;
        const std::optional<double> radians = unit_of(*system, "ANGLEUNIT");
        place.unit = radians ? *radians / kDegree : 1.0;
        return;
    }
}

// The word that follows this one in its line, in lower case; empty if there is none.
std::string word_after(std::string_view text, std::string_view key) {
    while (!text.empty()) {
        std::string_view line = text.substr(0, text.find_first_of("\r\n"));
        text.remove_prefix(std::min(line.size() + 1, text.size()));
        const auto* const end = std::find_if(line.begin(), line.end(), is_blank);
        if (in_lower_case(line.substr(0, static_cast<std::size_t>(end - line.begin()))) != key) continue;
        const auto* const first = std::find_if_not(end, line.end(), is_blank);
        const auto* const last = std::find_if(first, line.end(), is_blank);
        return in_lower_case(std::string_view(first, static_cast<std::size_t>(last - first)));
    }
    return {};
}

void read_words(std::string_view text, GridPlace& place) {
    const std::string projection = word_after(text, "projection");
    if (projection.empty()) return;
    const std::string unit = word_after(text, "units"), heights = word_after(text, "zunits");
    place.height_metres = metres_of(heights);
    if (projection == "geographic") {
        place.model = GridModel::geographic;
        place.unit = unit == "dd" || unit.empty() ? 1.0 : unit == "ds" ? 1.0 / 3600.0 : -1.0;
        return;
    }
    place.model = GridModel::projected;
    place.unit = metres_of(unit) > 0.0 ? metres_of(unit) : -1.0;
}

}  // namespace

double metres_of(std::string_view unit) {
    const std::string name = in_lower_case(unit);
    const auto* const found = std::find_if(std::begin(kLengths), std::end(kLengths),
                                           [&](const Length& length) { return length.name == name; });
    return found == std::end(kLengths) ? 0.0 : found->metres;
}

void read_prj(std::string_view text, GridPlace& place) {
    if (text.find('[') != std::string_view::npos) return read_well_known(text, place);
    read_words(text, place);
}

}  // namespace tex::inline v1
