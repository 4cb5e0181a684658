// SPDX-License-Identifier: Apache-2.0
// replay: gives files to a fuzz target, for builds without libFuzzer.
//
//     dds_fuzz FILE|FOLDER...
//
// Folders are searched with all below them. Exit code 77 (skipped) where none of the arguments is there, 1 where a file
// cannot be read; a target that finds a bug ends the process itself.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

bool replay(const std::filesystem::path& path) {
    std::printf("%s\n", path.c_str());  // before the target runs: the last line names the file that broke it
    std::fflush(stdout);
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (!file) return false;
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    return true;
}

}  // namespace

int main(int argc, char** argv) {
    namespace fs = std::filesystem;
    int count = 0;
    int unreadable = 0;
    for (int k = 1; k < argc; ++k) {
        if (fs::is_regular_file(argv[k])) {
            ++count;
            if (!replay(argv[k])) ++unreadable;
        } else if (fs::is_directory(argv[k])) {
            for (const fs::directory_entry& entry : fs::recursive_directory_iterator(argv[k])) {
                if (!entry.is_regular_file()) continue;
                ++count;
                if (!replay(entry.path())) ++unreadable;
            }
        }
    }
    std::printf("%d inputs replayed, %d unreadable\n", count, unreadable);
    if (count == 0) return 77;
    return unreadable == 0 ? 0 : 1;
}
