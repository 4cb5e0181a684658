// SPDX-License-Identifier: Apache-2.0

#include "formats/bil/bil.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "formats/bil/bil_header.h"
#include "formats/words.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

constexpr std::size_t kExtensionLength = 4;  // of all of them, with the dot
constexpr std::int64_t kLongestHeader = std::int64_t{1} << 16;

// The header of a file, with its name as the user would write it.
Result<InputFile> open_header(const std::string& path) {
    const std::string stem = path.substr(0, path.size() - kExtensionLength);
    Result<InputFile> header = InputFile::open(stem + ".hdr");
    if (header || header.error().code != ErrorCode::io) return header;
    Result<InputFile> upper = InputFile::open(stem + ".HDR");
    if (upper || upper.error().code != ErrorCode::io) return upper;
    return Error{ErrorCode::io, path, "cannot read its header " + stem + ".hdr, without which its extent is not known"};
}

}  // namespace

bool is_bil(const InputFile& file, const ReadOptions&) {
    constexpr std::array<std::string_view, 4> kExtensions = {".bil", ".bip", ".bsq", ".flt"};
    return std::any_of(kExtensions.begin(), kExtensions.end(),
                       [&](std::string_view extension) { return has_extension(file.path(), extension); });
}

Result<std::unique_ptr<RowSource>> open_bil(InputFile& file, const ReadOptions& options) {
    return no_throw([&]() -> Result<std::unique_ptr<RowSource>> {
        Result<InputFile> header = open_header(file.path());
        if (!header) return header.error();
        const Result<std::vector<std::byte>> text = header->read_rest(kLongestHeader);
        if (!text) return text.error();
        if (const Result<void> settled = file.settle(largest_file(options)); !settled) return settled.error();
        Result<RawTexels> place =
            read_bil_header(*text, header->path(), has_extension(file.path(), ".flt"), *file.size(), options);
        if (!place) return place.error();
        const std::int64_t left = *file.size() - place->end();
        if (left < 0) {
            return Error{ErrorCode::bad_data, file.path(),
                         std::to_string(*file.size()) + " bytes, but its header wants " + std::to_string(place->end())};
        }
        if (left > 0) {
            place->remark +=
                (place->remark.empty() ? "" : "; ") + std::to_string(left) + " bytes after the last row were not read";
        }
        return open_raw_rows(file, std::move(*place));
    });
}

}  // namespace tex::inline v1
