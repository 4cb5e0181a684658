// SPDX-License-Identifier: Apache-2.0

#include "formats/model/model_file.h"

#include <string_view>

namespace tex::inline v1 {

bool may_be_model(std::span<const std::byte> head) {
    constexpr std::string_view kByteOrderMark8 = "\xEF\xBB\xBF";
    std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
    if (text.starts_with("glTF")) return true;
    if (text.starts_with(kByteOrderMark8)) text.remove_prefix(kByteOrderMark8.size());
    constexpr std::string_view kBlanks = " \t\r\n";
    const std::size_t brace = text.find_first_not_of(kBlanks);
    if (brace == std::string_view::npos || text[brace] != '{') return false;
    const std::size_t next = text.find_first_not_of(kBlanks, brace + 1);  // not a binary file that happens to begin so
    return next != std::string_view::npos && (text[next] == '"' || text[next] == '}');
}

Result<std::unique_ptr<RowSource>> refuse_model(InputFile& file, const ReadOptions&) {
    return Error{
        ErrorCode::unsupported, file.path(),
        "a glTF model, or other JSON, not a picture: check-normals, compare-normals, convert-normals, pack-normals "
        "and preview-normals read the normal maps of a model if its file is given"};
}

}  // namespace tex::inline v1
