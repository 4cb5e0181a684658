// SPDX-License-Identifier: Apache-2.0

#include "mesh/gltf_buffers.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>

#include "mesh/meshopt_buffers.h"

namespace tex::inline v1 {
namespace {

// The size in bytes of a component, or 0.
std::size_t size_of_type(std::int64_t type) {
    switch (type) {
        case 5120:
        case 5121: return 1;
        case 5122:
        case 5123: return 2;
        case 5125:
        case 5126: return 4;
        default: return 0;
    }
}

int components_of(const std::optional<std::string>& type) {
    if (type == "SCALAR") return 1;
    if (type == "VEC2") return 2;
    if (type == "VEC3") return 3;
    return type == "VEC4" ? 4 : 0;
}

std::uint32_t load_le(const std::byte* p, std::size_t size) {
    std::uint32_t value = 0;
    for (std::size_t k = size; k-- > 0;) value = value << 8 | std::to_integer<std::uint32_t>(p[k]);
    return value;
}

// Whether `count` elements of `size` bytes, `stride` bytes apart and the first at `offset`, lie within `bytes` bytes.
bool fits(std::size_t bytes, std::int64_t offset, std::size_t count, std::size_t stride, std::size_t size) {
    const auto from = static_cast<std::size_t>(offset);
    if (count == 0) return true;
    if (from > bytes || bytes - from < size) return false;
    return count - 1 <= (bytes - from - size) / stride;
}

// A number that may be missing; nullopt if it is there but not a count.
std::optional<std::int64_t> count_or(JsonValue value, std::int64_t otherwise) {
    return value.is_null() ? otherwise : value.count();
}

// Decoded buffers may have 64 bytes for each byte that the file holds, and 64 MiB more: zeros take almost no bytes.
constexpr std::size_t kMostExpansion = 64, kMostDecoded = std::size_t{64} << 20;

template <class T, std::size_t N>
std::optional<T> word_of(const std::optional<std::string>& word, const std::pair<std::string_view, T> (&words)[N]) {
    for (const auto& [name, value] : words) {
        if (word == name) return value;
    }
    return std::nullopt;
}

std::optional<MeshoptLayout> meshopt_layout(JsonValue compression) {
    constexpr std::pair<std::string_view, MeshoptMode> kModes[] = {{"ATTRIBUTES", MeshoptMode::attributes},
                                                                   {"TRIANGLES", MeshoptMode::triangles},
                                                                   {"INDICES", MeshoptMode::indices}};
    constexpr std::pair<std::string_view, MeshoptFilter> kFilters[] = {{"NONE", MeshoptFilter::none},
                                                                       {"OCTAHEDRAL", MeshoptFilter::octahedral},
                                                                       {"QUATERNION", MeshoptFilter::quaternion},
                                                                       {"EXPONENTIAL", MeshoptFilter::exponential},
                                                                       {"COLOR", MeshoptFilter::color}};
    const JsonValue filter = compression["filter"];
    const auto mode = word_of(compression["mode"].text(), kModes);
    const auto chosen = filter.is_null() ? std::optional(MeshoptFilter::none) : word_of(filter.text(), kFilters);
    const auto count = compression["count"].count(), stride = compression["byteStride"].count();
    if (!mode || !chosen || !count || !stride || *stride < 1 || *stride > 256) return std::nullopt;
    return MeshoptLayout{*mode, *chosen, static_cast<std::size_t>(*count), static_cast<std::size_t>(*stride)};
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

// The text with bytes for "%41" (RFC 3986); nullopt if a % is followed by something else.
std::optional<std::string> unescaped(std::string_view uri) {
    std::string text;
    text.reserve(uri.size());
    for (std::size_t k = 0; k < uri.size(); ++k) {
        if (uri[k] != '%') {
            text += uri[k];
            continue;
        }
        const int high = k + 1 < uri.size() ? hex_digit(uri[k + 1]) : -1;
        const int low = k + 2 < uri.size() ? hex_digit(uri[k + 2]) : -1;
        if (high < 0 || low < 0) return std::nullopt;
        text += static_cast<char>(high * 16 + low);
        k += 2;
    }
    return text;
}

int base64_digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+' || c == '-') return 62;
    return c == '/' || c == '_' ? 63 : -1;
}

}  // namespace

Result<std::string> path_of_uri(std::string_view uri) {
    const auto refused = [&](const std::string& why) {
        return Error{ErrorCode::unsupported, {}, "its buffer \"" + std::string(uri.substr(0, 80)) + "\" " + why};
    };
    if (uri.find(':') != std::string_view::npos) return refused("is not a file beside it");
    const std::optional<std::string> unescaped_path = unescaped(uri);
    if (!unescaped_path) return refused("is not a valid URI");
    const std::string& path = *unescaped_path;
    const auto is_odd = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == '\\'; };
    if (std::any_of(path.begin(), path.end(), is_odd)) return refused("is not a valid path");
    if (path.empty() || path.front() == '/') return refused("is not a relative path");
    std::string plain;  // without "." and "//", so that one file has one name
    for (std::size_t from = 0; from < path.size();) {
        const std::size_t end = std::min(path.find('/', from), path.size());
        const std::string step = path.substr(from, end - from);
        from = end + 1;
        if (step == "..") return refused("is outside of its folder");
        if (step.empty() || step == ".") continue;
        plain += plain.empty() ? step : "/" + step;
    }
    if (plain.empty()) return refused("is not a file");
    return plain;
}

bool is_data_uri(std::string_view uri) {
    constexpr std::string_view kScheme = "data:";
    return uri.size() >= kScheme.size() && std::equal(kScheme.begin(), kScheme.end(), uri.begin(), [](char a, char b) {
               return a == (b >= 'A' && b <= 'Z' ? b - 'A' + 'a' : b);
           });
}

Result<std::vector<std::byte>> decode_data_uri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos) return bad_gltf("a data URI has no data");
    const auto text = unescaped(uri.substr(comma + 1));
    if (!text) return bad_gltf("a data URI is not a valid URI");
    if (!uri.substr(0, comma).ends_with(";base64")) {
        const auto* const bytes = reinterpret_cast<const std::byte*>(text->data());
        return std::vector<std::byte>(bytes, bytes + text->size());
    }
    std::string_view digits = *text;
    while (digits.ends_with('=')) digits.remove_suffix(1);
    if (digits.size() % 4 == 1) return bad_gltf("a data URI is truncated");
    std::vector<std::byte> bytes;
    bytes.reserve(digits.size() * 3 / 4);
    std::uint32_t buffer = 0;
    int bits = 0;
    for (const char c : digits) {
        const int digit = base64_digit(c);
        if (digit < 0) return bad_gltf("a data URI is not base64");
        buffer = (buffer << 6 | static_cast<std::uint32_t>(digit)) & 0xffffff;
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        bytes.push_back(static_cast<std::byte>(buffer >> bits & 0xff));
    }
    return bytes;
}

const std::byte* GltfAccessor::at(std::size_t element) const {
    const auto place = std::lower_bound(replaced_.begin(), replaced_.end(), element);
    if (place != replaced_.end() && *place == element)
        return replacements_ + static_cast<std::size_t>(place - replaced_.begin()) * size_;
    return data_ == nullptr ? nullptr : data_ + element * stride_;
}

float GltfAccessor::number(std::size_t element, int k) const {
    const std::byte* p = at(element);
    if (p == nullptr) return 0.0f;
    const std::size_t size = size_of_type(type);
    const std::uint32_t bits = load_le(p + static_cast<std::size_t>(k) * size, size);
    const auto scaled = [&](auto value, float most) {
        return normalized ? std::max(static_cast<float>(value) / most, -1.0f) : static_cast<float>(value);
    };
    switch (type) {
        case 5120: return scaled(static_cast<std::int8_t>(bits), 127.0f);
        case 5121: return scaled(bits, 255.0f);
        case 5122: return scaled(static_cast<std::int16_t>(bits), 32767.0f);
        case 5123: return scaled(bits, 65535.0f);
        case 5125: return static_cast<float>(bits);
        default: return std::bit_cast<float>(bits);
    }
}

std::uint32_t GltfAccessor::integer(std::size_t element) const {
    const std::byte* p = at(element);
    return p == nullptr ? 0 : load_le(p, size_of_type(type));
}

void GltfAccessor::copy(std::size_t element, std::byte* to) const {
    const std::byte* p = at(element);
    p == nullptr ? std::fill_n(to, size_, std::byte{0}) : std::copy_n(p, size_, to);
}

// Each file is loaded once, however often it is named.
Result<std::span<const std::byte>> GltfBuffers::load(const std::string& uri) {
    const bool inside = is_data_uri(uri);
    const auto path = inside ? Result<std::string>(uri) : path_of_uri(uri);
    if (!path) return path.error();
    auto found = loaded_.find(*path);
    if (found == loaded_.end()) {
        auto read = inside ? decode_data_uri(uri) : load_(*path);
        if (!read) return read.error();
        bytes_ += read->size();
        found = loaded_.emplace(*path, std::move(*read)).first;
    }
    return std::span<const std::byte>(found->second);
}

Result<std::span<const std::byte>> GltfBuffers::buffer(std::int64_t index) {
    const std::string name = "buffer " + std::to_string(index);
    const JsonValue description = root_["buffers"][static_cast<std::size_t>(index)];
    const std::optional<std::int64_t> length = description["byteLength"].count();
    if (!length) return bad_gltf(name + " does not exist or has no length");
    std::span<const std::byte> bytes = binary_;
    if (const JsonValue uri = description["uri"]; !uri.is_null()) {
        const std::optional<std::string> text = uri.text();
        if (!text) return bad_gltf(name + ": its URI is not a text");
        const auto loaded = load(*text);
        if (!loaded) return loaded.error();
        bytes = *loaded;
    } else if (index != 0 || binary_.empty()) {
        return bad_gltf(name + " has no bytes");
    }
    if (static_cast<std::size_t>(*length) > bytes.size()) {
        return bad_gltf(name + " is truncated: it claims " + std::to_string(*length) + " bytes, there are " +
                        std::to_string(bytes.size()));
    }
    return bytes.first(static_cast<std::size_t>(*length));
}

// The bytes that `buffer`, `byteOffset` and `byteLength` of a description name.
Result<std::span<const std::byte>> GltfBuffers::range(JsonValue description, const std::string& name) {
    const auto of = description["buffer"].count(), offset = count_or(description["byteOffset"], 0),
               length = description["byteLength"].count();
    if (!of || !offset || !length) return bad_gltf(name + " is damaged");
    auto bytes = buffer(*of);
    if (!bytes) return bytes.error();
    const auto from = static_cast<std::size_t>(*offset), size = static_cast<std::size_t>(*length);
    if (from > bytes->size() || bytes->size() - from < size) return bad_gltf(name + " leaves its buffer");
    return bytes->subspan(from, size);
}

// A buffer view that EXT_meshopt_compression or KHR_meshopt_compression describes. Each is decoded once.
Result<GltfBuffers::View> GltfBuffers::compressed_view(std::int64_t number, JsonValue compression) {
    const std::string name = "buffer view " + std::to_string(number);
    const auto layout = meshopt_layout(compression);
    if (!layout) return bad_gltf(name + ": its compression is damaged");
    const View view{{}, layout->mode == MeshoptMode::attributes ? layout->stride : 0};
    auto found = decoded_.find(number);
    if (found == decoded_.end()) {
        const auto bytes = range(compression, name);
        if (!bytes) return bytes.error();
        const std::size_t most = kMostDecoded + kMostExpansion * (bytes_ - decoded_bytes_);
        if (decoded_bytes_ > most || layout->count > (most - decoded_bytes_) / layout->stride)
            return Error{ErrorCode::unsupported, {}, name + " claims too many elements for its compressed bytes"};
        auto decoded = decode_meshopt(*layout, *bytes);
        if (!decoded) return bad_gltf(name + ": " + decoded.error().reason);
        count_decoded(decoded->size());
        found = decoded_.emplace(number, std::move(*decoded)).first;
    }
    return View{found->second, view.stride};
}

Result<GltfBuffers::View> GltfBuffers::view(JsonValue index) {
    const std::optional<std::int64_t> number = index.count();
    const JsonValue description = number ? root_["bufferViews"][static_cast<std::size_t>(*number)] : JsonValue();
    if (!description.is_object()) return bad_gltf("a buffer view does not exist");
    for (const std::string_view extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
        const JsonValue compression = description["extensions"][extension];
        if (!compression.is_null()) return compressed_view(*number, compression);
    }
    const std::string name = "buffer view " + std::to_string(*number);
    const auto stride = count_or(description["byteStride"], 0);
    if (!stride) return bad_gltf(name + " is damaged");
    if (*stride != 0 && (*stride < 4 || *stride > 252)) return bad_gltf(name + ": its stride must be from 4 to 252");
    const auto bytes = range(description, name);
    if (!bytes) return bytes.error();
    return View{*bytes, static_cast<std::size_t>(*stride)};
}

Result<std::span<const std::byte>> GltfBuffers::view_bytes(JsonValue index) {
    const auto found = view(index);
    if (!found) return found.error();
    return found->bytes;
}

Result<void> GltfBuffers::make_sparse(JsonValue sparse, GltfAccessor& accessor) {
    const auto count = sparse["count"].count(), type = sparse["indices"]["componentType"].count(),
               index_offset = count_or(sparse["indices"]["byteOffset"], 0),
               value_offset = count_or(sparse["values"]["byteOffset"], 0);
    if (!count || *count == 0 || !index_offset || !value_offset || !type ||
        (*type != 5121 && *type != 5123 && *type != 5125))
        return bad_gltf("its sparse elements are damaged");
    const auto indices = view(sparse["indices"]["bufferView"]);
    if (!indices) return indices.error();
    const auto values = view(sparse["values"]["bufferView"]);
    if (!values) return values.error();
    const auto n = static_cast<std::size_t>(*count);
    const std::size_t index_size = size_of_type(*type);
    if (!fits(indices->bytes.size(), *index_offset, n, index_size, index_size) ||
        !fits(values->bytes.size(), *value_offset, n, accessor.size_, accessor.size_))
        return bad_gltf("its sparse elements leave their buffer view");
    for (std::size_t k = 0; k < n; ++k) {
        const std::uint32_t element =
            load_le(indices->bytes.data() + static_cast<std::size_t>(*index_offset) + k * index_size, index_size);
        if (element >= accessor.count || (k > 0 && element <= accessor.replaced_.back()))
            return bad_gltf("its sparse elements are not in ascending order or out of range");
        accessor.replaced_.push_back(element);
    }
    accessor.replacements_ = values->bytes.data() + static_cast<std::size_t>(*value_offset);
    return {};
}

Result<GltfAccessor> GltfBuffers::make(JsonValue description) {
    const auto count = description["count"].count(), type = description["componentType"].count(),
               offset = count_or(description["byteOffset"], 0);
    GltfAccessor accessor;
    accessor.components = components_of(description["type"].text());
    if (!count || *count == 0 || !type || !offset || size_of_type(*type) == 0 || accessor.components == 0)
        return bad_gltf("is damaged");
    accessor.count = static_cast<std::size_t>(*count);
    accessor.type = static_cast<int>(*type);
    accessor.normalized = description["normalized"].boolean().value_or(false);
    accessor.size_ = size_of_type(*type) * static_cast<std::size_t>(accessor.components);
    if (const JsonValue index = description["bufferView"]; !index.is_null()) {
        const auto bytes = view(index);
        if (!bytes) return bytes.error();
        accessor.stride_ = bytes->stride == 0 ? accessor.size_ : bytes->stride;
        if (accessor.stride_ < accessor.size_) return bad_gltf("its elements are longer than their stride");
        if (!fits(bytes->bytes.size(), *offset, accessor.count, accessor.stride_, accessor.size_)) {
            return bad_gltf("leaves its buffer view: " + std::to_string(accessor.count) + " elements of " +
                            std::to_string(accessor.size_) + " bytes in " + std::to_string(bytes->bytes.size()));
        }
        accessor.data_ = bytes->bytes.data() + static_cast<std::size_t>(*offset);
    }
    if (const JsonValue sparse = description["sparse"]; !sparse.is_null()) {
        if (const auto made = make_sparse(sparse, accessor); !made) return made.error();
    }
    if (accessor.data_ == nullptr && accessor.count > bytes_)
        return bad_gltf("claims " + std::to_string(accessor.count) + " elements without bytes");
    return accessor;
}

Result<const GltfAccessor*> GltfBuffers::accessor(JsonValue index) {
    const std::optional<std::int64_t> number = index.count();
    const JsonValue description = number ? root_["accessors"][static_cast<std::size_t>(*number)] : JsonValue();
    if (!description.is_object()) return bad_gltf("an accessor does not exist");
    auto found = accessors_.find(*number);
    if (found == accessors_.end()) {
        auto made = make(description);
        if (!made) {
            Error error = made.error();
            if (error.file.empty()) error.reason = "accessor " + std::to_string(*number) + ": " + error.reason;
            return error;
        }
        found = accessors_.emplace(*number, std::move(*made)).first;
    }
    return &found->second;
}

}  // namespace tex::inline v1
