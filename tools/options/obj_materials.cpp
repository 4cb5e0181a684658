// SPDX-License-Identifier: Apache-2.0

#include "options/obj_materials.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "cli/text.h"
#include "files/path_names.h"

namespace tex::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBlank = " \t\r";
// An OBJ file may be large, but names its materials at its beginning as a rule; MTL files are small.
constexpr std::size_t kMostBytes = std::size_t{16} << 20;

std::string_view without_blanks(std::string_view text) {
    const std::size_t from = text.find_first_not_of(kBlank);
    return from == std::string_view::npos ? std::string_view()
                                          : text.substr(from, text.find_last_not_of(kBlank) + 1 - from);
}

// The first word, which is taken away.
std::string_view take_word(std::string_view& line) {
    line = without_blanks(line);
    const std::size_t end = std::min(line.find_first_of(kBlank), line.size());
    const std::string_view word = line.substr(0, end);
    line = without_blanks(line.substr(end));
    return word;
}

// The path of a regular file that `file` names, in its folder or below.
std::optional<std::string> beside(const std::string& file, std::string_view name) {
    std::string plain(without_blanks(name));
    std::replace(plain.begin(), plain.end(), '\\', '/');  // programs on Windows write them
    const fs::path path(plain);
    const bool leads_out = std::any_of(path.begin(), path.end(), [](const fs::path& part) { return part == ".."; });
    if (plain.empty() || path.is_absolute() || leads_out) return std::nullopt;
    const fs::path whole = fs::path(file).parent_path() / path;
    std::error_code error;
    if (!fs::is_regular_file(whole, error)) return std::nullopt;
    return slashed(whole);
}

bool is_number(std::string_view word) {
    return !word.empty() && word.find_first_not_of("+-.0123456789eE") == std::string_view::npos;
}

// The name after the options, such as "-s 1 1 1 -clamp on leaf.png".
std::string_view without_options(std::string_view line) {
    while (line.starts_with('-')) {
        const std::string_view option = take_word(line);
        const bool has_numbers = option == "-o" || option == "-s" || option == "-t" || option == "-mm";
        if (!has_numbers) take_word(line);
        for (int k = 0; has_numbers && k < 3; ++k) {
            std::string_view rest = line;
            if (!is_number(take_word(rest))) break;
            line = rest;
        }
    }
    return line;
}

// The beginning of a file; empty if it cannot be read.
std::string head_of(const std::string& file) {
    std::string head(kMostBytes, '\0');
    std::ifstream in(fs::path(file), std::ios::binary);
    in.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(in.gcount()));
    return head;
}

// Calls use(keyword, rest) for each line. Old Macs end lines with CR.
template <class Use>
void visit_lines(const std::string& file, const Use& use) {
    const std::string text = head_of(file);
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find_first_of("\n\r", at), text.size());
        std::string_view rest = std::string_view(text).substr(at, end - at);
        rest = rest.substr(0, rest.find('#'));
        const std::string_view keyword = take_word(rest);
        if (!keyword.empty()) use(keyword, rest);
        at = end + 1;
    }
}

void read_materials(const std::string& file, ObjMaterials& all) {
    ObjAlpha* current = nullptr;
    visit_lines(file, [&](std::string_view keyword, std::string_view rest) {
        if (keyword == "newmtl") current = &all.alphas[std::string(rest)];
        if (current == nullptr) return;
        if (keyword == "d" && is_number(rest)) current->factor = std::strtod(std::string(rest).c_str(), nullptr);
        if (keyword != "map_d") return;
        if (auto picture = beside(file, without_options(rest))) {
            all.files.push_back(*picture);
            current->picture = std::move(*picture);
        }
    });
}

}  // namespace

ObjMaterials obj_materials(const std::string& mesh) {
    ObjMaterials all;
    std::error_code error;
    if (lower_case(slashed(fs::path(mesh).extension())) != ".obj" || !fs::is_regular_file(mesh, error)) return all;
    std::vector<std::string> libraries;
    visit_lines(mesh, [&](std::string_view keyword, std::string_view rest) {
        if (keyword != "mtllib") return;
        if (auto whole = beside(mesh, rest)) {  // names may have blanks
            libraries.push_back(std::move(*whole));
            return;
        }
        while (!rest.empty()) {
            if (auto one = beside(mesh, take_word(rest))) libraries.push_back(std::move(*one));
        }
    });
    for (const std::string& library : libraries) {
        if (std::find(all.files.begin(), all.files.end(), library) != all.files.end()) continue;
        all.files.push_back(library);
        read_materials(library, all);
    }
    return all;
}

void add_obj_files(const std::string& mesh, std::vector<std::string>& files) {
    for (std::string& file : obj_materials(mesh).files) files.push_back(std::move(file));
}

}  // namespace tex::cli
