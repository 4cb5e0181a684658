// SPDX-License-Identifier: Apache-2.0

#include "formats/reader/reader_mesh.h"

#include <algorithm>
#include <cerrno>

#include "files/input_file.h"
#include "files/path_names.h"
#include "files/system_error.h"
#include "formats/reader/reader_process.h"

namespace tex::inline v1 {
namespace {

// The extension in lower-case letters, or "-" if the path has no plain one.
std::string extension_hint(const std::string& path) {
    const std::size_t dot = path.rfind('.');
    if (dot == std::string::npos || name_begin(path) > dot) return "-";
    std::string hint = path.substr(dot + 1);
    for (char& c : hint) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    const bool is_plain = !hint.empty() && hint.size() <= 8 && std::all_of(hint.begin(), hint.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    });
    return is_plain ? hint : "-";
}

Result<std::vector<std::byte>> answer_of_mesh_reader(const std::string& path, const char* verb, const std::string& hint,
                                                     std::span<const std::byte> bytes, const ReadOptions& options) {
    const Result<Descriptor> input = memory_file(path);
    const Result<Descriptor> result = memory_file(path);
    if (!input) return input.error();
    if (!result) return result.error();
    if (!write_exactly(input->get(), 0, bytes)) return system_error(path, errno, "a file in memory");
    const Result<ReaderHeader> reply =
        run_reader({ReaderProgram::meshes, path, verb, hint, input->get(), result->get()}, options);
    if (!reply) return reply.error();
    return answered_bytes(path, result->get(), *reply);
}

}  // namespace

Result<std::vector<std::byte>> read_with_mesh_reader(const std::string& path, std::span<const std::byte> file,
                                                     const ReadOptions& options) {
    return answer_of_mesh_reader(path, "mesh", extension_hint(path), file, options);
}

Result<std::vector<std::byte>> decode_draco_with_reader(const std::string& path, std::span<const std::byte> request,
                                                        const ReadOptions& options) {
    return answer_of_mesh_reader(path, "draco", "-", request, options);
}

}  // namespace tex::inline v1
