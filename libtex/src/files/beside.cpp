// SPDX-License-Identifier: Apache-2.0

#include "files/beside.h"

#include <optional>

#include "files/input_file.h"
#include "files/path_names.h"

namespace tex::inline v1 {

std::string beside(const std::string& path, const std::string& name) { return path.substr(0, name_begin(path)) + name; }

Result<void> check_regular(const std::string& path) {
    const std::optional<FileStatus> status = FileStatus::of(path);
    if (!status || status->kind == FileKind::regular) return {};
    return Error{ErrorCode::io, path, "is not a regular file"};
}

Result<std::vector<std::byte>> read_at_most(const std::string& path, std::int64_t most) {
    auto file = InputFile::open(path);
    if (!file) return file.error();
    if (file->size() && *file->size() > most)
        return Error{ErrorCode::unsupported, path, "has more than " + std::to_string(most) + " bytes"};
    return file->read_rest(most);
}

Result<std::vector<std::byte>> read_beside(const std::string& path, const std::string& name, std::int64_t most) {
    const std::string file = beside(path, name);
    if (const auto regular = check_regular(file); !regular) return regular.error();
    return read_at_most(file, most);
}

Result<std::vector<std::byte>> read_named(const std::string& path, const std::string& name, std::int64_t most) {
    auto bytes = read_beside(path, name, most);
    if (bytes) return bytes;
    Error error = bytes.error();
    error.reason += ", which " + path.substr(name_begin(path)) + " names";
    return error;
}

}  // namespace tex::inline v1
