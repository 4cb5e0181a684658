// SPDX-License-Identifier: Apache-2.0

#include "mesh/gltf_form.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "mesh/glb.h"
#include "mesh/gltf.h"
#include "mesh/json.h"
#include "mesh/json_text.h"

namespace tex::inline v1 {
namespace {

constexpr std::size_t kPartAlignment = 8;
constexpr std::size_t kMostJoined = std::numeric_limits<std::uint32_t>::max();

std::string_view seen_type(std::span<const std::byte> bytes) {
    const std::string_view head(reinterpret_cast<const char*>(bytes.data()), std::min<std::size_t>(bytes.size(), 12));
    if (head.starts_with("\x89PNG")) return "image/png";
    if (head.starts_with("\xff\xd8\xff")) return "image/jpeg";
    if (head.starts_with("RIFF") && head.size() == 12 && head.substr(8) == "WEBP") return "image/webp";
    if (head.substr(0, 7) == "\xabKTX 20") return "image/ktx2";
    if (head.starts_with("DDS ")) return "image/vnd-ms.dds";
    return "";
}

// "image/png" of "data:image/png;base64,...".
std::string_view media_type_in(std::string_view data_uri) {
    const std::string_view head = data_uri.substr(5, data_uri.find(',') - 5);
    return head.substr(0, head.find(';'));
}

class GltfJoiner {
public:
    GltfJoiner(JsonValue root, JsonNode& text, const LoadBeside& load, const ModelPlace& place)
        : root_(root), text_(text), load_(load), place_(place) {}

    Result<void> join();
    [[nodiscard]] const std::vector<std::byte>& binary() const { return binary_; }
    std::vector<std::string> take_files() { return std::move(files_); }

private:
    // Where a buffer is from now on.
    struct Place {
        std::size_t buffer = 0, offset = 0;
    };

    Result<std::size_t> add(std::span<const std::byte> bytes);
    Result<std::size_t> add_buffer(std::size_t index, std::size_t length, const std::string& uri);
    Result<void> join_buffers();
    void move_range(JsonNode& node, JsonValue range) const;
    void move_views();
    Result<void> join_image(std::size_t index);
    void list_buffers();

    JsonValue root_;
    JsonNode& text_;
    const LoadBeside& load_;
    const ModelPlace& place_;
    std::vector<std::byte> binary_;
    std::vector<Place> places_;
    std::vector<std::string> others_;             // buffers without bytes, which meshoptimizer fills
    std::map<std::string, std::size_t> buffers_;  // of files: where they begin
    std::map<std::string, std::string> images_;   // of files: their members from now on
    std::size_t views_ = 0;
    std::vector<std::string> files_;
};

Result<std::size_t> GltfJoiner::add(std::span<const std::byte> bytes) {
    binary_.resize((binary_.size() + kPartAlignment - 1) / kPartAlignment * kPartAlignment);
    const std::size_t begin = binary_.size();
    if (bytes.size() > kMostJoined - begin)
        return Error{ErrorCode::unsupported, {}, "would have 4 GiB or more, which GLB files cannot have"};
    binary_.insert(binary_.end(), bytes.begin(), bytes.end());
    return begin;
}

// A file that several buffers name is there once.
Result<std::size_t> GltfJoiner::add_buffer(std::size_t index, std::size_t length, const std::string& uri) {
    const bool is_data = is_data_uri(uri);
    const auto path = is_data ? Result<std::string>(std::string()) : path_of_uri(uri);
    if (!path) return path.error();
    if (const auto known = buffers_.find(*path); !is_data && known != buffers_.end()) return known->second;
    auto bytes = is_data ? decode_data_uri(uri) : load_(*path);
    if (!bytes) return bytes.error();
    if (length > bytes->size()) {
        return bad_gltf("buffer " + std::to_string(index) + " is truncated: it claims " + std::to_string(length) +
                        " bytes, there are " + std::to_string(bytes->size()));
    }
    // Another buffer may have more of the same file.
    for (std::size_t b = index + 1; b < root_["buffers"].size() && !is_data; ++b) {
        const auto other = path_of_uri(root_["buffers"][b]["uri"].text().value_or("data:"));
        const auto more = root_["buffers"][b]["byteLength"].count();
        if (other && *other == *path && more) length = std::max(length, static_cast<std::size_t>(*more));
    }
    auto begin = add(std::span(*bytes).first(std::min(length, bytes->size())));
    if (!begin || is_data) return begin;
    buffers_.emplace(*path, *begin);
    files_.push_back(*path);
    return begin;
}

Result<void> GltfJoiner::join_buffers() {
    const JsonValue buffers = root_["buffers"];
    bool has_bytes = root_["images"].size() > 0;
    for (std::size_t b = 0; b < buffers.size(); ++b) has_bytes = has_bytes || !buffers[b]["uri"].is_null();
    for (std::size_t b = 0; b < buffers.size(); ++b) {
        const auto length = buffers[b]["byteLength"].count();
        const auto uri = buffers[b]["uri"].text();
        if (!length) return bad_gltf("buffer " + std::to_string(b) + " has no length");
        if (!uri) {
            places_.push_back({others_.size() + (has_bytes ? 1 : 0), 0});
            text_.member("buffers")->element(b)->write(others_.emplace_back());
            continue;
        }
        const auto begin = add_buffer(b, static_cast<std::size_t>(*length), *uri);
        if (!begin) return begin.error();
        places_.push_back({0, *begin});
    }
    return {};
}

// `buffer` and `byteOffset` of a view, or of an extension of it.
void GltfJoiner::move_range(JsonNode& node, JsonValue range) const {
    const auto buffer = range["buffer"].count();
    if (!buffer || static_cast<std::size_t>(*buffer) >= places_.size()) return;
    const Place& place = places_[static_cast<std::size_t>(*buffer)];
    if (place.buffer != static_cast<std::size_t>(*buffer)) node.set("buffer", std::to_string(place.buffer));
    const auto offset = static_cast<std::size_t>(range["byteOffset"].count().value_or(0));
    if (place.offset > 0) node.set("byteOffset", std::to_string(offset + place.offset));
}

void GltfJoiner::move_views() {
    const JsonValue views = root_["bufferViews"];
    views_ = views.size();
    for (std::size_t v = 0; v < views_; ++v) {
        JsonNode& node = *text_.member("bufferViews")->element(v);
        if (!views[v].is_object()) continue;
        move_range(node, views[v]);
        for (const std::string& name : views[v]["extensions"].keys()) {
            const JsonValue extension = views[v]["extensions"][name];
            if (extension.is_object()) move_range(*node.member("extensions")->member(name), extension);
        }
    }
}

// What is not there stays named.
Result<void> GltfJoiner::join_image(std::size_t index) {
    const JsonValue image = root_["images"][index];
    const auto uri = image["uri"].text();
    if (!uri || !image["bufferView"].is_null()) return {};
    const bool is_data = is_data_uri(*uri);
    const auto path = is_data ? Result<std::string>(*uri) : path_of_uri(*uri);
    if (!path) return {};
    JsonNode& node = *text_.member("images")->element(index);
    auto known = images_.find(*path);
    if (known == images_.end()) {
        const auto bytes = is_data ? decode_data_uri(*uri) : load_(*path);
        const bool is_missing = !is_data && (!place_.is_missing || place_.is_missing(*path));
        if (!bytes && !is_data && !is_missing) return bytes.error();
        if (!bytes || bytes->empty()) return {};
        const auto begin = add(*bytes);
        if (!begin) return begin.error();
        if (text_.member("bufferViews") == nullptr) text_.set("bufferViews", "[]");
        text_.member("bufferViews")
            ->append("{\"buffer\":0,\"byteOffset\":" + std::to_string(*begin) +
                     ",\"byteLength\":" + std::to_string(bytes->size()) + "}");
        if (!is_data) files_.push_back(*path);
        known = images_.emplace(*path, std::to_string(views_++)).first;
        if (image["mimeType"].is_null()) {
            std::string_view type = seen_type(*bytes);
            if (type.empty() && is_data) type = media_type_in(*uri);
            if (!type.empty()) known->second += ' ' + std::string(type);
        }
    }
    const std::size_t blank = known->second.find(' ');
    node.remove("uri");
    node.set("bufferView", known->second.substr(0, blank));
    if (image["mimeType"].is_null() && blank != std::string::npos)
        node.set("mimeType", json_string(known->second.substr(blank + 1)));
    return {};
}

// The first buffer with bytes keeps what else is said of it.
void GltfJoiner::list_buffers() {
    std::string list;
    const JsonValue buffers = root_["buffers"];
    if (!binary_.empty()) {
        std::string first = "{\"byteLength\":0}";
        for (std::size_t b = 0; b < buffers.size(); ++b) {
            if (buffers[b]["uri"].is_null()) continue;
            first.clear();
            text_.member("buffers")->element(b)->write(first);
            break;
        }
        JsonNode node(std::move(first));
        node.remove("uri");
        node.set("byteLength", std::to_string(binary_.size()));
        node.write(list);
    }
    for (const std::string& other : others_) list += (list.empty() ? "" : ",") + other;
    if (!list.empty()) text_.set("buffers", '[' + list + ']');
}

Result<void> GltfJoiner::join() {
    if (auto joined = join_buffers(); !joined) return joined;
    move_views();
    for (std::size_t k = 0; k < root_["images"].size(); ++k) {
        if (auto joined = join_image(k); !joined) return joined;
    }
    // Without bytes, buffers that have none keep their numbers.
    if (binary_.empty() && !others_.empty() && places_.front().buffer > 0)
        return Error{ErrorCode::unsupported, {}, "has buffers without bytes alone"};
    list_buffers();
    return {};
}

}  // namespace

Result<JoinedGltf> joined_gltf(std::span<const std::byte> text, const LoadBeside& load, const ModelPlace& place) {
    const auto chunks = gltf_chunks(text);
    if (!chunks) return chunks.error();
    const auto document = JsonDocument::parse(chunks->json);
    if (!document) return document.error();
    JsonText json(chunks->json);
    GltfJoiner joiner(document->root(), json.root(), load, place);
    if (auto joined = joiner.join(); !joined) return joined.error();
    std::string made = json.text();
    made.erase(0, made.find('{'));  // a byte order mark
    auto bytes = glb_of(std::move(made), joiner.binary());
    if (!bytes) return bytes.error();
    return JoinedGltf{std::move(*bytes), joiner.take_files()};
}

Result<DividedGltf> divided_gltf(std::span<const std::byte> glb, const std::string& uri) {
    const auto chunks = gltf_chunks(glb);
    if (!chunks) return chunks.error();
    const std::size_t known = 20 + chunks->json.size() + (chunks->binary.empty() ? 0 : 8 + chunks->binary.size());
    if (known < glb.size())
        return Error{ErrorCode::unsupported, {}, "has chunks that only GLB can hold, and so no .gltf is made of it"};
    const auto document = JsonDocument::parse(chunks->json);
    if (!document) return document.error();
    JsonText json(chunks->json);
    DividedGltf divided;
    const JsonValue first = document->root()["buffers"][0];
    if (!chunks->binary.empty() && first.is_object() && first["uri"].is_null()) {
        const auto length = static_cast<std::size_t>(first["byteLength"].count().value_or(0));
        if (length > chunks->binary.size()) return bad_gltf("buffer 0 is truncated");
        divided.binary.assign(chunks->binary.begin(), chunks->binary.begin() + static_cast<std::ptrdiff_t>(length));
        json.root().member("buffers")->element(0)->set("uri", json_string(uri));
    }
    std::string text = json.text();
    text.resize(text.find_last_not_of(std::string_view(" \0", 2)) + 1);
    const auto bytes = std::as_bytes(std::span(text));
    divided.text.assign(bytes.begin(), bytes.end());
    return divided;
}

}  // namespace tex::inline v1
