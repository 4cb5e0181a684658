// SPDX-License-Identifier: Apache-2.0

#include "files/beside.h"

#include "files/input_file.h"

namespace tex::inline v1 {

std::string beside(const std::string& path, const std::string& name) {
    const std::size_t slash = path.rfind('/');
    return slash == std::string::npos ? name : path.substr(0, slash + 1) + name;
}

Result<std::vector<std::byte>> read_at_most(const std::string& path, std::int64_t most) {
    auto file = InputFile::open(path);
    if (!file) return file.error();
    if (file->size() && *file->size() > most)
        return Error{ErrorCode::unsupported, path, "has more than " + std::to_string(most) + " bytes"};
    return file->read_rest(most);
}

}  // namespace tex::inline v1
