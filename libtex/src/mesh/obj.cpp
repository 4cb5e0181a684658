// SPDX-License-Identifier: Apache-2.0

#include "mesh/obj.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <system_error>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

namespace tex::inline v1 {
namespace {

constexpr std::string_view kBlank = " \t\r\f\v";
constexpr std::uint32_t kMissing = ~std::uint32_t{0};

// Some editors begin UTF-8 with a byte order mark.
std::string_view without_mark(std::string_view text) {
    constexpr std::string_view kMark = "\xEF\xBB\xBF";
    return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

// Takes the first word of a line off it.
std::string_view take_word(std::string_view& line) {
    const std::size_t from = std::min(line.find_first_not_of(kBlank), line.size());
    const std::size_t end = std::min(line.find_first_of(kBlank, from), line.size());
    const std::string_view word = line.substr(from, end - from);
    line.remove_prefix(end);
    return word;
}

std::optional<float> number_of(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    float value = 0.0f;
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (stop != end || word.empty()) return std::nullopt;
    if (error == std::errc::result_out_of_range) {  // too large, or so small that it is 0
        double exact = 0.0;
        if (std::from_chars(word.data(), end, exact).ec != std::errc()) return std::nullopt;
        value = static_cast<float>(exact);
    } else if (error != std::errc()) {
        return std::nullopt;
    }
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

// A corner as the file names it: numbers of a position, a UV and a normal, or kMissing.
struct ObjCorner {
    std::uint32_t position = kMissing, uv = kMissing, normal = kMissing;
    friend bool operator==(const ObjCorner&, const ObjCorner&) = default;
};

struct ObjCornerHash {
    std::size_t operator()(const ObjCorner& c) const {
        std::uint64_t h = c.position;
        h = h * 0x9e3779b97f4a7c15u + c.uv;
        h = (h ^ h >> 29) * 0x9e3779b97f4a7c15u + c.normal;
        return static_cast<std::size_t>((h ^ h >> 32) * 0x9e3779b97f4a7c15u >> 16);
    }
};

// A part while its faces are read.
struct ObjPart {
    std::string object;
    int mesh = 0;
    int material = -1;
    std::vector<ObjCorner> vertices;
    std::unordered_map<ObjCorner, std::uint32_t, ObjCornerHash> known;
    std::vector<std::uint32_t> indices, quads;
    bool has_uvs = true, has_normals = true;  // in all faces
};

class ObjReader {
public:
    explicit ObjReader(bool colors) : reads_colors_(colors) {}

    Result<Mesh> read(std::string_view text);

private:
    [[nodiscard]] Error at_line(const std::string& reason) const {
        return {ErrorCode::bad_data, {}, "line " + std::to_string(line_) + ": " + reason};
    }
    Result<void> read_line(std::string_view line);
    template <std::size_t N>
    Result<std::array<float, N>> numbers(std::string_view line, std::size_t required);
    Result<std::uint32_t> index_of(std::string_view word, std::size_t count, const char* what) const;
    Result<ObjCorner> corner_of(std::string_view word) const;
    Result<void> read_face(std::string_view line);
    void read_color(std::string_view line);
    ObjPart& part(bool has_uvs, bool has_normals);
    Mesh finish();
    [[nodiscard]] MeshPart finished(const ObjPart& part) const;

    const bool reads_colors_;
    std::size_t line_ = 0;
    std::vector<Float3> positions_, normals_;
    std::vector<std::optional<Float3>> colors_;  // of the positions
    std::vector<Float2> uvs_;
    std::string object_;
    int material_ = -1;
    std::map<std::string, int, std::less<>> materials_, objects_;
    std::vector<std::string> material_names_;
    // By object, material, whether there are UVs and normals.
    std::map<std::tuple<int, int, bool, bool>, std::size_t> part_of_;
    std::vector<ObjPart> parts_;
    ObjPart* current_ = nullptr;  // null after `o` and `usemtl`
    std::vector<ObjCorner> corners_;
    std::vector<std::uint32_t> polygon_;
};

// At least `required` numbers; the others are 0, and more are ignored (w).
template <std::size_t N>
Result<std::array<float, N>> ObjReader::numbers(std::string_view line, std::size_t required) {
    std::array<float, N> values{};
    for (std::size_t k = 0; k < N; ++k) {
        const std::string_view word = take_word(line);
        if (word.empty() && k >= required) break;
        const std::optional<float> value = number_of(word);
        if (!value) return at_line("\"" + std::string(word.substr(0, 40)) + "\" is not a finite number");
        values[k] = *value;
    }
    return values;
}

// Indices begin at 1; negative ones count from the last element so far.
Result<std::uint32_t> ObjReader::index_of(std::string_view word, std::size_t count, const char* what) const {
    std::int64_t value = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || stop != word.data() + word.size())
        return at_line("\"" + std::string(word.substr(0, 40)) + "\" is not a corner of a face");
    const auto most = static_cast<std::int64_t>(count);
    if (value == 0 || value > most || value < -most) {
        return at_line(std::string(what) + " " + std::to_string(value) + " is out of range: there are " +
                       std::to_string(count));
    }
    return static_cast<std::uint32_t>(value > 0 ? value - 1 : most + value);
}

// "7", "7/3", "7//2" or "7/3/2": position, UV, normal.
Result<ObjCorner> ObjReader::corner_of(std::string_view word) const {
    ObjCorner corner;
    const std::size_t first = std::min(word.find('/'), word.size());
    const auto position = index_of(word.substr(0, first), positions_.size(), "position");
    if (!position) return position.error();
    corner.position = *position;
    if (first == word.size()) return corner;
    const std::string_view rest = word.substr(first + 1);
    const std::size_t second = std::min(rest.find('/'), rest.size());
    if (second > 0) {
        const auto uv = index_of(rest.substr(0, second), uvs_.size(), "UV");
        if (!uv) return uv.error();
        corner.uv = *uv;
    }
    if (second + 1 < rest.size()) {
        const auto normal = index_of(rest.substr(second + 1), normals_.size(), "normal");
        if (!normal) return normal.error();
        corner.normal = *normal;
    }
    return corner;
}

ObjPart& ObjReader::part(bool has_uvs, bool has_normals) {
    const int mesh = objects_.try_emplace(object_, static_cast<int>(objects_.size())).first->second;
    const auto [place, is_new] = part_of_.try_emplace({mesh, material_, has_uvs, has_normals}, parts_.size());
    if (is_new) {
        parts_.emplace_back();
        parts_.back().object = object_;
        parts_.back().mesh = mesh;
        parts_.back().material = material_;
        parts_.back().has_uvs = has_uvs;
        parts_.back().has_normals = has_normals;
    }
    return parts_[place->second];
}

Result<void> ObjReader::read_face(std::string_view line) {
    corners_.clear();
    for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
        const auto corner = corner_of(word);
        if (!corner) return corner.error();
        corners_.push_back(*corner);
    }
    if (corners_.size() < 3) return at_line("a face needs at least 3 corners");
    const bool has_uvs =
        std::all_of(corners_.begin(), corners_.end(), [](const ObjCorner& corner) { return corner.uv != kMissing; });
    const bool has_normals = std::all_of(corners_.begin(), corners_.end(),
                                         [](const ObjCorner& corner) { return corner.normal != kMissing; });
    if (current_ == nullptr || current_->has_uvs != has_uvs || current_->has_normals != has_normals)
        current_ = &part(has_uvs, has_normals);
    ObjPart& to = *current_;
    polygon_.clear();
    for (ObjCorner& corner : corners_) {
        if (!has_uvs) corner.uv = kMissing;
        if (!has_normals) corner.normal = kMissing;
        const auto [place, is_new] = to.known.try_emplace(corner, static_cast<std::uint32_t>(to.vertices.size()));
        if (is_new) to.vertices.push_back(corner);
        polygon_.push_back(place->second);
    }
    if (polygon_.size() == 4) to.quads.push_back(static_cast<std::uint32_t>(to.indices.size() / 3));
    for (std::size_t k = 2; k < polygon_.size(); ++k)
        to.indices.insert(to.indices.end(), {polygon_[0], polygon_[k - 1], polygon_[k]});
    return {};
}

// The three numbers after a position. Fewer are none (w), and what is no number is ignored as without colours.
void ObjReader::read_color(std::string_view line) {
    std::array<float, 3> values{};
    for (int k = 0; k < 3; ++k) take_word(line);
    for (float& channel : values) {
        const std::optional<float> value = number_of(take_word(line));
        if (!value) {
            colors_.emplace_back();
            return;
        }
        channel = *value;
    }
    colors_.push_back(Float3{values[0], values[1], values[2]});
}

Result<void> ObjReader::read_line(std::string_view line) {
    line = line.substr(0, line.find('#'));
    const std::string_view keyword = take_word(line);
    if (keyword == "v" || keyword == "vn") {
        const auto v = numbers<3>(line, 3);
        if (!v) return v.error();
        (keyword == "v" ? positions_ : normals_).push_back({(*v)[0], (*v)[1], (*v)[2]});
        if (keyword == "v" && reads_colors_) read_color(line);
    } else if (keyword == "vt") {
        const auto v = numbers<2>(line, 1);
        if (!v) return v.error();
        uvs_.push_back({(*v)[0], (*v)[1]});
    } else if (keyword == "f") {
        return read_face(line);
    } else if (keyword == "o" || keyword == "usemtl") {
        const std::size_t from = std::min(line.find_first_not_of(kBlank), line.size());
        const std::string name(line.substr(from, line.find_last_not_of(kBlank) + 1 - from));
        current_ = nullptr;
        if (keyword == "o") {
            object_ = name;
        } else {
            const auto [place, is_new] = materials_.try_emplace(name, static_cast<int>(materials_.size()));
            if (is_new) material_names_.push_back(name);
            material_ = place->second;
        }
    }
    return {};
}

MeshPart ObjReader::finished(const ObjPart& from) const {
    MeshPart to;
    to.name = from.object;
    to.mesh = from.mesh;
    to.material = from.material;
    to.indices = from.indices;
    to.quads = from.quads;
    to.positions.reserve(from.vertices.size());
    if (from.has_uvs) to.uvs.resize(1);
    for (const ObjCorner& c : from.vertices) {
        to.positions.push_back(positions_[c.position]);
        if (from.has_normals) to.normals.push_back(normals_[c.normal]);
        if (from.has_uvs) to.uvs[0].push_back(uvs_[c.uv]);
    }
    const auto has_color = [&](const ObjCorner& c) { return colors_[c.position].has_value(); };
    if (!reads_colors_ || !std::all_of(from.vertices.begin(), from.vertices.end(), has_color)) return to;
    to.colors.reserve(from.vertices.size());
    for (const ObjCorner& c : from.vertices) to.colors.push_back(*colors_[c.position]);
    return to;
}

Mesh ObjReader::finish() {
    Mesh mesh;
    std::map<int, int> primitives;
    for (const ObjPart& part : parts_) {
        mesh.parts.push_back(finished(part));
        mesh.parts.back().primitive = primitives[part.mesh]++;
        if (mesh.parts.back().primitive > 0) continue;
        mesh.nodes.emplace_back();
        mesh.nodes.back().name = part.object;
        mesh.nodes.back().mesh = part.mesh;
    }
    for (const std::string& name : material_names_) {
        mesh.materials.emplace_back();
        mesh.materials.back().name = name;
    }
    return mesh;
}

Result<Mesh> ObjReader::read(std::string_view text) {
    std::string joined;  // lines that end with a backslash continue
    const char line_end = text.find('\n') == std::string_view::npos ? '\r' : '\n';  // old Macs end lines with CR
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(line_end), text.size());
        std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        ++line_;
        while (line.ends_with('\r')) line.remove_suffix(1);
        if (line.ends_with('\\')) {
            joined.append(line.substr(0, line.size() - 1)).append(" ");
            continue;
        }
        if (!joined.empty()) line = joined.append(line);
        if (const auto done = read_line(line); !done) return done.error();
        joined.clear();
    }
    if (!joined.empty()) return at_line("the file ends within a line");
    if (parts_.empty()) return Error{ErrorCode::bad_data, {}, "has no faces"};
    return finish();
}

}  // namespace

bool is_obj(std::string_view head) {
    head = without_mark(head);
    for (;;) {
        const std::size_t first = head.find_first_not_of(" \t\r\n\f\v");
        if (first == std::string_view::npos) return false;
        head.remove_prefix(first);
        if (!head.starts_with('#')) break;
        const std::size_t end = head.find_first_of("\r\n");
        if (end == std::string_view::npos) return true;
        head.remove_prefix(end);
    }
    const std::string_view word = head.substr(0, head.find_first_of(" \t\r\n"));
    for (const std::string_view known : {"v", "vt", "vn", "vp", "f", "o", "g", "s", "l", "p", "usemtl", "mtllib"}) {
        if (word == known) return true;
    }
    return false;
}

Result<Mesh> parse_obj(std::string_view text, bool colors) { return ObjReader(colors).read(without_mark(text)); }

}  // namespace tex::inline v1
