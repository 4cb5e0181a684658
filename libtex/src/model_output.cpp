// SPDX-License-Identifier: Apache-2.0

#include <tex/pipeline.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include <tex/file.h>
#include <tex/mesh.h>

#include "files/atomic_file.h"
#include "files/beside.h"
#include "files/descriptor.h"
#include "files/input_file.h"
#include "files/path_names.h"
#include "files/system_error.h"
#include "mesh/gltf.h"
#include "mesh/gltf_names.h"
#include "mesh/gltf_output.h"
#include "mesh/json.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

namespace fs = std::filesystem;

// Files that are complete and wait for their places have a descriptor each.
constexpr std::size_t kMostWaiting = 256;

struct Prepared {
    WrittenGltf made;
    ModelFiles files;  // the model is the last one; the others are in the order of made.beside
};

fs::path folder_of(const std::string& path) {
    const fs::path folder = fs::path(path).parent_path();
    return folder.empty() ? fs::path(".") : folder;
}

// Readers of glTF go by the extension, and so does the form of the output.
Result<bool> is_binary_name(const std::string& output) {
    std::string extension = slashed(fs::path(output).extension());
    for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    if (extension == ".glb") return true;
    if (extension == ".gltf") return false;
    return Error{ErrorCode::unsupported, output, "a model must be called .glb or .gltf"};
}

// Copies that cannot be made are left out, and listed.
Result<void> list_files(const std::string& input, const std::string& output, Prepared& prepared) {
    std::vector<BesideModel> beside_output;
    for (BesideModel& file : prepared.made.beside) {
        const std::string from = file.from.empty() ? std::string() : beside(input, file.from);
        if (!file.is_changed) {
            if (!FileStatus::of(from)) {
                prepared.files.missing.push_back(file.from);
                continue;
            }
            if (auto regular = check_regular(from); !regular) return regular;
        }
        if (!GltfNames::is_usual(file.path)) {
            return Error{ErrorCode::unsupported, input,
                         "its file \"" + file.path.substr(0, 80) + "\" would be written, and models use no such files"};
        }
        prepared.files.files.push_back({beside(output, file.path), from, file.is_changed});
        beside_output.push_back(std::move(file));
    }
    prepared.made.beside = std::move(beside_output);
    prepared.files.files.push_back({output, {}, true});
    prepared.files.outside = prepared.made.outside;
    for (const std::string& file : prepared.made.joined) prepared.files.joined.push_back(beside(input, file));
    prepared.files.compressed = prepared.made.compressed;
    prepared.files.mirrors = prepared.made.mirrors;
    prepared.files.left_mirrors = prepared.made.left_mirrors;
    return {};
}

Result<Prepared> prepare(const std::string& input, const std::string& output, const ModelChanges& changes,
                         const MeshReadOptions& options) {
    if (input == "-") return Error{ErrorCode::unsupported, input, "a model cannot come from standard input"};
    const auto bytes = read_at_most(input, options.max_bytes);
    if (!bytes) return bytes.error();
    if (!is_gltf(*bytes)) return Error{ErrorCode::unsupported, input, "is not a glTF model"};
    const auto is_binary = is_binary_name(output);
    if (!is_binary) return is_binary.error();
    const LoadBeside load = [&](const std::string& name) { return read_named(input, name, options.max_bytes); };
    ModelPlace place;
    std::error_code error;
    place.is_same_folder = fs::equivalent(folder_of(input), folder_of(output), error);
    place.name = output.substr(name_begin(output));
    place.is_binary = *is_binary;
    place.is_missing = [&](const std::string& name) { return !FileStatus::of(beside(input, name)); };
    auto made = write_gltf(*bytes, load, place, changes);
    if (!made) return made.error().of(input);
    Prepared prepared{std::move(*made), {}};
    if (auto listed = list_files(input, output, prepared); !listed) return listed.error();
    return prepared;
}

Result<void> copy_bytes(const std::string& from, AtomicFile& to) {
    auto file = InputFile::open(from);
    if (!file) return file.error();
    std::vector<std::byte> part(std::size_t{1} << 20);
    for (std::uint64_t at = 0;;) {
        const auto count = file->read(part.data(), part.size());
        if (!count) return count.error();
        if (*count == 0) return {};
        if (auto written = to.write_at(at, std::span(part).first(*count)); !written) return written;
        at += *count;
    }
}

// Whether a file exists and has these bytes, or those of the file `from` if there are none.
bool has_bytes(const std::string& path, std::span<const std::byte> bytes, const std::string& from) {
    constexpr std::int64_t kMost = std::int64_t{1} << 40;
    const auto status = FileStatus::of(path);
    if (!status || status->kind != FileKind::regular) return false;
    const auto now = read_at_most(path, kMost);
    if (!now) return false;
    if (from.empty()) return std::equal(now->begin(), now->end(), bytes.begin(), bytes.end());
    const auto wanted = read_at_most(from, kMost);
    return wanted && *now == *wanted;
}

// The files that the model at `path` names, if there is one.
std::vector<std::string> named_by(const std::string& path, const MeshReadOptions& options) {
    const auto status = FileStatus::of(path);
    if (!status || status->kind != FileKind::regular) return {};
    const auto bytes = read_at_most(path, options.max_bytes);
    if (!bytes || !is_gltf(*bytes)) return {};
    const auto chunks = gltf_chunks(*bytes);
    if (!chunks) return {};
    const auto document = JsonDocument::parse(chunks->json);
    if (!document) return {};
    return GltfNames(document->root(), {}).kept();
}

// Names beside the output come from the input, so that a file which has one of them may be anybody's. It is replaced if
// the model whose place the output takes names it, too, or if nothing would be lost.
Result<void> check_free(const std::string& output, const Prepared& prepared, const MeshReadOptions& options) {
    std::optional<std::vector<std::string>> own;
    for (std::size_t k = 0; k < prepared.made.beside.size(); ++k) {
        const ModelFile& file = prepared.files.files[k];
        const BesideModel& made = prepared.made.beside[k];
        std::error_code error;
        if (fs::symlink_status(file.path, error).type() == fs::file_type::not_found) continue;
        if (!own) own = named_by(output, options);
        if (std::find(own->begin(), own->end(), made.path) != own->end()) continue;
        if (has_bytes(file.path, made.bytes, file.is_changed ? "" : file.from)) continue;
        return Error{ErrorCode::io, file.path,
                     "exists and is not known to be a file of " + output + "; give the model a folder for itself"};
    }
    return {};
}

Result<void> commit_all(std::vector<AtomicFile>& waiting) {
    for (AtomicFile& file : waiting) {
        if (auto placed = file.commit(); !placed) return placed;
    }
    waiting.clear();
    return {};
}

Result<void> write_all(const Prepared& prepared, const WriteOptions& writing) {
    std::vector<AtomicFile> waiting;
    std::error_code ignored;
    const bool has_folder = fs::is_directory(folder_of(prepared.files.files.back().path), ignored);
    for (std::size_t k = 0; k < prepared.files.files.size(); ++k) {
        const ModelFile& file = prepared.files.files[k];
        const bool is_model = k == prepared.made.beside.size();
        const std::vector<std::byte>& bytes = is_model ? prepared.made.bytes : prepared.made.beside[k].bytes;
        AtomicFileOptions options = AtomicFileOptions::of(writing);
        if (!is_model) {
            options.follow_links = false;
            if (writing.no_clobber && has_bytes(file.path, bytes, file.is_changed ? "" : file.from)) continue;
            std::error_code error;
            if (has_folder) fs::create_directories(folder_of(file.path), error);
            if (error) return system_error(slashed(folder_of(file.path)), error.value(), "cannot be created");
        }
        auto made = AtomicFile::open(file.path, options);
        if (!made) return made.error();
        auto written = file.is_changed ? made->write_at(0, bytes) : copy_bytes(file.from, *made);
        if (!written) return written;
        waiting.push_back(std::move(*made));
        if (waiting.size() < kMostWaiting || is_model) continue;
        if (auto placed = commit_all(waiting); !placed) return placed;
    }
    return commit_all(waiting);
}

}  // namespace

Result<ModelFiles> model_files(const std::string& input, const std::string& output, const ModelChanges& changes,
                               const MeshReadOptions& options) {
    return no_throw([&]() -> Result<ModelFiles> {
        auto prepared = prepare(input, output, changes, options);
        if (!prepared) return prepared.error();
        return std::move(prepared->files);
    });
}

Result<ModelFiles> write_model(const std::string& input, const std::string& output, const ModelChanges& changes,
                               const MeshReadOptions& options, const WriteOptions& writing) {
    return no_throw([&]() -> Result<ModelFiles> {
        for (const ModelPicture& picture : changes.pictures) {
            if (picture.bytes.empty()) return Error{ErrorCode::bad_option, output, "a picture has no bytes"};
        }
        for (const ModelTangents& part : changes.tangents) {
            if (part.tangents.empty()) return Error{ErrorCode::bad_option, output, "a part has no tangents"};
        }
        auto prepared = prepare(input, output, changes, options);
        if (!prepared) return prepared.error();
        if (auto is_free = check_free(output, *prepared, options); !is_free) return is_free.error();
        if (auto written = write_all(*prepared, writing); !written) return written.error();
        return std::move(prepared->files);
    });
}

}  // namespace tex::inline v1
