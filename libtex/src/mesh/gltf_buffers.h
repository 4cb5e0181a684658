// SPDX-License-Identifier: Apache-2.0
// gltf_buffers.h: the numbers of a glTF file: buffers, views and accessors.

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tex/types.h>

#include "mesh/json.h"

namespace tex::inline v1 {

// The error of a file whose data is wrong.
inline Error bad_gltf(std::string reason) { return {ErrorCode::bad_data, {}, std::move(reason)}; }

// Loads the file that a glTF file names: a relative path without "..", already decoded.
using LoadBeside = std::function<Result<std::vector<std::byte>>(const std::string& path)>;

// The path that a URI names; bad_data or unsupported if it is not one that mesh_io.h accepts.
Result<std::string> path_of_uri(std::string_view uri);

// Whether the URI has its bytes in itself: "data:...", in any case.
bool is_data_uri(std::string_view uri);

// The bytes of "data:...;base64,...", or of "data:...,..." (RFC 2397). Errors: bad_data.
Result<std::vector<std::byte>> decode_data_uri(std::string_view uri);

// Elements of one to four numbers. Views point into the buffers.
class GltfAccessor {
public:
    std::size_t count = 0;
    int components = 1;  // of an element: 1 (SCALAR) to 4 (VEC4)
    int type = 5126;     // componentType: 5120 (signed byte) to 5126 (float)
    bool normalized = false;

    // Component `k` of an element. Normalised integers are divided as glTF 2.0, 3.11 says.
    [[nodiscard]] float number(std::size_t element, int k) const;
    // An unsigned integer. Precondition: type is one of 5121, 5123, 5125.
    [[nodiscard]] std::uint32_t integer(std::size_t element) const;

    // The bytes of an element, and their number.
    void copy(std::size_t element, std::byte* to) const;
    [[nodiscard]] std::size_t element_size() const { return size_; }

private:
    friend class GltfBuffers;
    [[nodiscard]] const std::byte* at(std::size_t element) const;

    const std::byte* data_ = nullptr;  // null: zeros
    std::size_t stride_ = 0;
    std::vector<std::uint32_t> replaced_;  // of a sparse accessor: elements in ascending order
    const std::byte* replacements_ = nullptr;
    std::size_t size_ = 0;  // of an element in bytes
};

// Loads buffers when an accessor needs them, so that what only pictures need is not loaded.
class GltfBuffers {
public:
    GltfBuffers(JsonValue root, std::size_t json_bytes, std::span<const std::byte> binary, const LoadBeside& load)
        : root_(root), binary_(binary), load_(load), bytes_(json_bytes + binary.size()) {}

    // Errors: bad_data, unsupported, those of LoadBeside.
    Result<const GltfAccessor*> accessor(JsonValue index);

    // The bytes of a buffer view, decoded if meshoptimizer compressed them. Errors: as accessor().
    Result<std::span<const std::byte>> view_bytes(JsonValue index);

    // All bytes that the file has held so far, those that were decoded included: what it claims may not exceed them.
    [[nodiscard]] std::size_t bytes() const { return bytes_; }
    void count_decoded(std::size_t bytes) {
        bytes_ += bytes;
        decoded_bytes_ += bytes;
    }

private:
    struct View {
        std::span<const std::byte> bytes;
        std::size_t stride = 0;  // 0: elements are packed
    };
    Result<std::span<const std::byte>> buffer(std::int64_t index);
    Result<View> view(JsonValue index);
    Result<GltfAccessor> make(JsonValue description);
    Result<void> make_sparse(JsonValue description, GltfAccessor& accessor);
    Result<std::span<const std::byte>> range(JsonValue description, const std::string& name);
    Result<View> compressed_view(std::int64_t number, JsonValue compression);
    Result<std::span<const std::byte>> load(const std::string& uri);

    JsonValue root_;
    std::span<const std::byte> binary_;
    const LoadBeside& load_;
    std::size_t bytes_;
    std::map<std::string, std::vector<std::byte>> loaded_;  // by path or data URI
    std::map<std::int64_t, GltfAccessor> accessors_;
    std::map<std::int64_t, std::vector<std::byte>> decoded_;  // by view
    std::size_t decoded_bytes_ = 0;                           // of bytes_
};

}  // namespace tex::inline v1
