// SPDX-License-Identifier: Apache-2.0
// gltf_views.h: bytes of buffers that change, and the views that move with them.

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tex/types.h>

#include "mesh/gltf_buffers.h"
#include "mesh/json.h"
#include "mesh/json_text.h"

namespace tex::inline v1 {

// "data:image/png;base64,...": the bytes as a URI. `media_type` may be empty.
std::string encode_data_uri(std::string_view media_type, std::span<const std::byte> bytes);

// A buffer with its new bytes.
struct ChangedBuffer {
    std::size_t index = 0;
    std::vector<std::byte> bytes;
};

class GltfViews {
public:
    // What it is given must outlive it.
    explicit GltfViews(JsonValue root);

    // Whether the bytes of a view may change: as often as it says, and only that often, something names the view, and
    // no other view has bytes of it.
    [[nodiscard]] bool is_own(std::int64_t view, std::size_t uses) const;

    // Gives the view other bytes. Precondition: is_own(). The bytes must outlive this.
    void replace(std::int64_t view, std::span<const std::byte> bytes);
    // Adds a view of new bytes at the end of the buffer. Returns its number. `more`: further members, as text that
    // begins with a comma.
    std::int64_t add(std::size_t buffer, std::span<const std::byte> bytes, std::string more = {});
    [[nodiscard]] std::size_t buffer_of(std::int64_t view) const;
    // How often something names the view.
    [[nodiscard]] std::size_t uses(std::int64_t view) const;

    // Makes the new buffers, and changes the views in the text, and their lengths. `load` has the bytes of a buffer.
    // Errors: bad_data, those of `load`.
    template <class Load>
    Result<std::vector<ChangedBuffer>> finish(JsonNode& text, const Load& load) {
        std::vector<ChangedBuffer> changed;
        for (auto& [buffer, changes] : changes_) {
            auto bytes = load(buffer);
            if (!bytes) return bytes.error();
            auto made = remake(buffer, changes, std::move(*bytes), text);
            if (!made) return made.error();
            changed.push_back({buffer, std::move(*made)});
        }
        if (!added_.empty() && text.member("bufferViews") == nullptr) text.set("bufferViews", "[]");
        for (std::string& view : added_) text.member("bufferViews")->append(std::move(view));
        return changed;
    }

private:
    // Bytes of a buffer that a view names, itself or in an extension (EXT_meshopt_compression).
    struct Range {
        std::size_t begin = 0, end = 0, view = 0;
        std::string extension;  // or empty
    };
    struct Replaced {
        std::size_t view = 0;
        std::span<const std::byte> bytes;
    };
    struct Changes {
        std::vector<Replaced> replaced;
        std::vector<std::span<const std::byte>> added;
        std::vector<std::size_t> numbers;  // of the views of `added`, counted in added_
        std::vector<std::string> more;     // of the views of `added`
    };
    Result<std::vector<std::byte>> remake(std::size_t buffer, const Changes& changes, std::vector<std::byte> bytes,
                                          JsonNode& text);

    JsonValue root_;
    std::map<std::size_t, std::vector<Range>> ranges_;  // by buffer
    std::map<std::int64_t, std::size_t> uses_;          // how often "bufferView" names a view
    std::map<std::size_t, Changes> changes_;
    std::vector<std::string> added_;
};

// What a document has instead of its buffers: those in its text are there already.
struct FinishedBuffers {
    std::optional<std::vector<std::byte>> binary;  // the chunk, if that changes
    std::vector<ChangedBuffer> files;
};

// GltfViews::finish() of a document with this binary chunk. Errors: those of `load`; bad_data.
Result<FinishedBuffers> finish_buffers(JsonValue root, JsonNode& text, GltfViews& views,
                                       std::span<const std::byte> binary, const LoadBeside& load);

}  // namespace tex::inline v1
