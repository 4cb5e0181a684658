// SPDX-License-Identifier: Apache-2.0
// scratch.h: a folder for the files of one test.

#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace tex {

// A new folder, which is removed together with its object. Tests run side by side, in processes that may have the same
// numbers (in containers, one after the other), so no other name is safe. Fixtures derive from it, too.
class Scratch {
public:
    Scratch() {
        std::random_device random;
        do {
            folder_ = (std::filesystem::temp_directory_path() / ("libtex_test." + std::to_string(random()))).string();
        } while (!std::filesystem::create_directory(folder_));
    }
    ~Scratch() {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;

    // Without a name: of the folder.
    [[nodiscard]] std::string path(const std::string& name = {}) const {
        return name.empty() ? folder_ : (std::filesystem::path(folder_) / name).string();
    }
    // Returns the path. The file's folder is made, too.
    std::string write(const std::string& name, std::string_view text) const {
        const std::filesystem::path file = path(name);
        std::filesystem::create_directories(file.parent_path());
        std::ofstream stream(file, std::ios::binary);
        if (!(stream << text).flush()) throw std::runtime_error("cannot write " + file.string());
        return file.string();
    }
    std::string write(const std::string& name, std::span<const std::byte> bytes) const {
        return write(name, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    }
    [[nodiscard]] std::string read(const std::string& name) const {
        std::ifstream file(path(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    [[nodiscard]] bool has(const std::string& name) const { return std::filesystem::exists(path(name)); }
    // The names of all files and folders in it, sorted.
    [[nodiscard]] std::vector<std::string> list() const {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
            names.push_back(entry.path().lexically_relative(folder_).string());
        }
        std::sort(names.begin(), names.end());
        return names;
    }
    // How many files and folders are directly in it.
    [[nodiscard]] std::size_t files() const {
        return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
    }
    // Copies a file of samples/ into the folder.
    void add_sample(const std::string& sample, const std::string& name) const {
        std::filesystem::copy_file(std::filesystem::path(TEX_SOURCE_DIR) / "samples" / sample, path(name));
    }

protected:
    std::string folder_;
};

}  // namespace tex
