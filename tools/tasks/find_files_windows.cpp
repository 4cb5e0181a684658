// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cerrno>
#include <utility>

#include <windows.h>

#include "cli/file_status.h"
#include "files/system_error.h"
#include "files/wide_windows.h"
#include "tasks/find_files.h"

namespace tex::cli {
namespace {

class Walk {
public:
    Walk(const std::string& root, const FileSearch& search) : root_(root), search_(search) {}

    std::vector<FoundFile> run() {
        enter("");
        std::sort(found_.begin(), found_.end(), [](const FoundFile& a, const FoundFile& b) { return a.path < b.path; });
        return std::move(found_);
    }

private:
    using Identity = std::pair<std::uint64_t, std::uint64_t>;

    // `folder` is "" or ends with "/".
    void enter(const std::string& folder) {
        const std::string path = root_.empty() ? (folder.empty() ? "." : folder) : root_ + "/" + folder;
        if (search_.entered) search_.entered(folder);
        const auto status = status_of(path);
        if (!status) return search_.unreadable(path, system_reason(errno));
        if (status->kind != FileKind::folder) return search_.unreadable(path, system_reason(ENOTDIR));
        const Identity self{status->device, status->inode};
        if (std::find(parents_.begin(), parents_.end(), self) != parents_.end()) return;
        parents_.push_back(self);
        std::vector<std::string> folders;
        WIN32_FIND_DATAW entry{};
        HANDLE search = FindFirstFileExW((system_path(path) + L"\\*").c_str(), FindExInfoBasic, &entry,
                                         FindExSearchNameMatch, nullptr, 0);
        bool more = search != INVALID_HANDLE_VALUE;
        while (more) {
            const std::string name = narrow(entry.cFileName);
            if (name != "." && name != "..") look_at(entry, path, folder + name, folders);
            more = FindNextFileW(search, &entry) != 0;
        }
        const DWORD reason = GetLastError();
        if (search != INVALID_HANDLE_VALUE) FindClose(search);
        if (reason != ERROR_NO_MORE_FILES) search_.unreadable(path, system_reason(errno_of(reason)));
        for (const std::string& inner : folders) enter(inner);
        parents_.pop_back();
    }

    void look_at(const WIN32_FIND_DATAW& entry, const std::string& folder, const std::string& path,
                 std::vector<std::string>& folders) {
        const auto any = [this](const auto& test) {
            return std::any_of(search_.globs.begin(), search_.globs.end(),
                               [&](const Glob* glob) { return test(*glob); });
        };
        const bool is_link = (entry.dwFileAttributes & FILE_ATTRIBUTE_REPARSE_POINT) != 0;
        bool is_folder = (entry.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) != 0;
        const bool matches = (!is_folder || is_link) && any([&](const Glob& glob) { return glob.matches(path); });
        const bool reaches = (is_folder || is_link) && any([&](const Glob& glob) { return glob.reaches(path + "/"); });
        if (!matches && !is_folder && search_.passed_over) search_.passed_over(path);
        if (!matches && !reaches) return;
        std::int64_t size = std::int64_t{entry.nFileSizeHigh} << 32 | entry.nFileSizeLow;
        if (is_link) {
            const auto status = status_of(folder + "/" + narrow(entry.cFileName));
            // A dangling link: the file is reported when it is read.
            if (!status && matches) found_.push_back({path, 0});
            if (!status || status->kind == FileKind::special) return;
            is_folder = status->kind == FileKind::folder;
            size = status->size;
        }
        if (!is_folder && matches) found_.push_back({path, size});
        if (is_folder && reaches && !search_.skip(path + "/")) folders.push_back(path + "/");
    }

    const std::string& root_;
    const FileSearch& search_;
    std::vector<Identity> parents_;  // the folders from the root to the current one
    std::vector<FoundFile> found_;
};

}  // namespace

std::vector<FoundFile> find_files(const std::string& root, const FileSearch& search) {
    return Walk(root, search).run();
}

}  // namespace tex::cli
