// SPDX-License-Identifier: Apache-2.0

#include "mesh/gltf_views.h"

#include <algorithm>
#include <utility>

namespace tex::inline v1 {
namespace {

// What follows in a buffer moves by a multiple of this: glTF wants 4, and some extensions 8 (EXT_structural_metadata).
constexpr std::size_t kAlignment = 8;

std::size_t aligned(std::size_t bytes) { return (bytes + kAlignment - 1) / kAlignment * kAlignment; }

std::size_t number_or_zero(JsonValue value) { return static_cast<std::size_t>(value.count().value_or(0)); }

// Calls `found` with each value of a key "bufferView".
template <class Found>
void find_uses(JsonValue value, const Found& found) {
    for (std::size_t k = 0; k < value.size(); ++k) find_uses(value[k], found);
    for (const std::string& key : value.keys()) {
        const JsonValue part = value[key];
        if (const auto view = part.count(); view && key == "bufferView") found(*view);
        find_uses(part, found);
    }
}

}  // namespace

std::string encode_data_uri(std::string_view media_type, std::span<const std::byte> bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string uri = "data:" + std::string(media_type) + ";base64,";
    uri.reserve(uri.size() + (bytes.size() + 2) / 3 * 4);
    for (std::size_t k = 0; k < bytes.size(); k += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - k);
        std::uint32_t word = 0;
        for (std::size_t i = 0; i < 3; ++i)
            word = word << 8 | (i < count ? std::to_integer<std::uint32_t>(bytes[k + i]) : 0);
        for (std::size_t i = 0; i < 4; ++i) uri += i <= count ? kDigits[word >> (18 - 6 * i) & 63] : '=';
    }
    return uri;
}

GltfViews::GltfViews(JsonValue root) : root_(root) {
    const JsonValue views = root["bufferViews"];
    for (std::size_t k = 0; k < views.size(); ++k) {
        const auto add_range = [&](JsonValue place, const std::string& extension) {
            const auto buffer = place["buffer"].count();
            if (!buffer) return;
            const std::size_t begin = number_or_zero(place["byteOffset"]);
            ranges_[static_cast<std::size_t>(*buffer)].push_back(
                {begin, begin + number_or_zero(place["byteLength"]), k, extension});
        };
        add_range(views[k], {});
        for (const std::string& name : views[k]["extensions"].keys()) add_range(views[k]["extensions"][name], name);
    }
    find_uses(root, [&](std::int64_t view) { ++uses_[view]; });
}

std::size_t GltfViews::buffer_of(std::int64_t view) const {
    return number_or_zero(root_["bufferViews"][static_cast<std::size_t>(view)]["buffer"]);
}

bool GltfViews::is_own(std::int64_t view, std::size_t uses) const {
    const JsonValue place = root_["bufferViews"][static_cast<std::size_t>(view)];
    if (uses == 0 || this->uses(view) != uses || !place["extensions"].is_null()) return false;
    const std::size_t begin = number_or_zero(place["byteOffset"]), end = begin + number_or_zero(place["byteLength"]);
    const auto found = ranges_.find(buffer_of(view));
    return found != ranges_.end() && begin < end &&
           std::none_of(found->second.begin(), found->second.end(), [&](const Range& range) {
               return range.view != static_cast<std::size_t>(view) && range.begin < end && begin < range.end;
           });
}

void GltfViews::replace(std::int64_t view, std::span<const std::byte> bytes) {
    changes_[buffer_of(view)].replaced.push_back({static_cast<std::size_t>(view), bytes});
}

std::size_t GltfViews::uses(std::int64_t view) const {
    const auto found = uses_.find(view);
    return found == uses_.end() ? 0 : found->second;
}

std::int64_t GltfViews::add(std::size_t buffer, std::span<const std::byte> bytes, std::string more) {
    Changes& changes = changes_[buffer];
    changes.added.push_back(bytes);
    changes.more.push_back(std::move(more));
    changes.numbers.push_back(added_.size());
    added_.emplace_back();
    return static_cast<std::int64_t>(root_["bufferViews"].size() + added_.size() - 1);
}

Result<std::vector<std::byte>> GltfViews::remake(std::size_t buffer, const Changes& changes,
                                                 std::vector<std::byte> bytes, JsonNode& text) {
    const std::string name = "buffer " + std::to_string(buffer);
    const auto length = root_["buffers"][buffer]["byteLength"].count();
    if (!length || static_cast<std::size_t>(*length) > bytes.size()) return bad_gltf(name + " is truncated");
    bytes.resize(static_cast<std::size_t>(*length));
    const JsonValue views = root_["bufferViews"];
    struct Step {
        std::size_t begin, end, view;
        std::span<const std::byte> bytes;
        std::size_t filled;  // with zeros behind them
    };
    std::vector<Step> steps;
    for (const Replaced& replaced : changes.replaced) {
        const std::size_t begin = number_or_zero(views[replaced.view]["byteOffset"]);
        const std::size_t size = number_or_zero(views[replaced.view]["byteLength"]);
        if (begin > bytes.size() || size > bytes.size() - begin)
            return bad_gltf("view " + std::to_string(replaced.view) + " leaves its buffer");
        const std::size_t gap = (kAlignment + size % kAlignment - replaced.bytes.size() % kAlignment) % kAlignment;
        steps.push_back({begin, begin + size, replaced.view, replaced.bytes, gap});
    }
    std::sort(steps.begin(), steps.end(), [](const Step& a, const Step& b) { return a.begin < b.begin; });
    std::vector<std::byte> made;
    std::size_t from = 0;
    // For each step, how many bytes there are now before its end in the old buffer.
    std::vector<std::size_t> ends;
    for (const Step& step : steps) {
        made.insert(made.end(), bytes.begin() + static_cast<std::ptrdiff_t>(from),
                    bytes.begin() + static_cast<std::ptrdiff_t>(step.begin));
        made.insert(made.end(), step.bytes.begin(), step.bytes.end());
        made.resize(made.size() + step.filled);
        from = step.end;
        ends.push_back(made.size());
    }
    made.insert(made.end(), bytes.begin() + static_cast<std::ptrdiff_t>(from), bytes.end());
    const auto moved = [&](std::size_t offset) {
        const auto after =
            std::partition_point(steps.begin(), steps.end(), [&](const Step& step) { return step.end <= offset; });
        if (after == steps.begin()) return offset;
        const auto last = static_cast<std::size_t>(after - steps.begin() - 1);
        return offset - steps[last].end + ends[last];
    };
    JsonNode* const list = text.member("bufferViews");
    const auto found = ranges_.find(buffer);
    for (const Range& range : found == ranges_.end() ? std::vector<Range>() : found->second) {
        if (moved(range.begin) == range.begin) continue;
        JsonNode* place = list->element(range.view);
        if (!range.extension.empty()) place = place->member("extensions")->member(range.extension);
        place->set("byteOffset", std::to_string(moved(range.begin)));
    }
    for (const Step& step : steps) list->element(step.view)->set("byteLength", std::to_string(step.bytes.size()));
    for (std::size_t k = 0; k < changes.added.size(); ++k) {
        made.resize(aligned(made.size()));
        added_[changes.numbers[k]] =
            "{\"buffer\":" + std::to_string(buffer) + ",\"byteOffset\":" + std::to_string(made.size()) +
            ",\"byteLength\":" + std::to_string(changes.added[k].size()) + changes.more[k] + "}";
        made.insert(made.end(), changes.added[k].begin(), changes.added[k].end());
    }
    text.member("buffers")->element(buffer)->set("byteLength", std::to_string(made.size()));
    return made;
}

namespace {

// The media type of a data URI, with its parameters.
std::string media_type_of_uri(std::string_view uri) {
    std::string_view type = uri.substr(5, uri.find(',') == std::string_view::npos ? 0 : uri.find(',') - 5);
    if (type.ends_with(";base64")) type.remove_suffix(7);
    return std::string(type);
}

Result<std::vector<std::byte>> bytes_of_buffer(JsonValue root, std::size_t buffer, std::span<const std::byte> binary,
                                               const LoadBeside& load) {
    const auto uri = root["buffers"][buffer]["uri"].text();
    if (!uri && buffer != 0) return bad_gltf("buffer " + std::to_string(buffer) + " has no bytes");
    if (!uri) return std::vector<std::byte>(binary.begin(), binary.end());
    if (is_data_uri(*uri)) return decode_data_uri(*uri);
    auto path = path_of_uri(*uri);
    if (!path) return path.error();
    return load(*path);
}

}  // namespace

Result<FinishedBuffers> finish_buffers(JsonValue root, JsonNode& text, GltfViews& views,
                                       std::span<const std::byte> binary, const LoadBeside& load) {
    auto changed = views.finish(text, [&](std::size_t buffer) { return bytes_of_buffer(root, buffer, binary, load); });
    if (!changed) return changed.error();
    FinishedBuffers finished;
    for (ChangedBuffer& buffer : *changed) {
        const auto uri = root["buffers"][buffer.index]["uri"].text();
        if (!uri) {
            finished.binary = std::move(buffer.bytes);
        } else if (is_data_uri(*uri)) {
            text.member("buffers")
                ->element(buffer.index)
                ->set("uri", '"' + encode_data_uri(media_type_of_uri(*uri), buffer.bytes) + '"');
        } else {
            finished.files.push_back(std::move(buffer));
        }
    }
    return finished;
}

}  // namespace tex::inline v1
