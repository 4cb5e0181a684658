// SPDX-License-Identifier: Apache-2.0

#include "tasks/find_files.h"

#include <algorithm>
#include <cerrno>
#include <memory>
#include <utility>

#include <dirent.h>
#include <sys/stat.h>

#include "files/system_error.h"

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
    using Identity = std::pair<dev_t, ino_t>;

    // `folder` is "" or ends with "/".
    void enter(const std::string& folder) {
        const std::string path = root_.empty() ? (folder.empty() ? "." : folder) : root_ + "/" + folder;
        if (search_.entered) search_.entered(folder);
        const std::unique_ptr<DIR, int (*)(DIR*)> dir(opendir(path.c_str()),
                                                      [](DIR* open) { return open == nullptr ? 0 : closedir(open); });
        struct stat status {};
        if (!dir || fstat(dirfd(dir.get()), &status) != 0) return search_.unreadable(path, system_reason(errno));
        const Identity self{status.st_dev, status.st_ino};
        if (std::find(parents_.begin(), parents_.end(), self) != parents_.end()) return;
        parents_.push_back(self);
        std::vector<std::string> folders;
        errno = 0;
        while (const dirent* entry = readdir(dir.get())) {
            const std::string name = entry->d_name;
            if (name == "." || name == "..") continue;
            look_at(dirfd(dir.get()), *entry, folder + name, folders);
            errno = 0;
        }
        if (errno != 0) search_.unreadable(path, system_reason(errno));
        for (const std::string& inner : folders) enter(inner);
        parents_.pop_back();
    }

    void look_at(int dir, const dirent& entry, const std::string& path, std::vector<std::string>& folders) {
        const auto any = [this](const auto& test) {
            return std::any_of(search_.globs.begin(), search_.globs.end(),
                               [&](const Glob* glob) { return test(*glob); });
        };
        const bool may_be_folder = entry.d_type == DT_DIR || entry.d_type == DT_LNK || entry.d_type == DT_UNKNOWN;
        const bool matches = entry.d_type != DT_DIR && any([&](const Glob& glob) { return glob.matches(path); });
        const bool reaches = may_be_folder && any([&](const Glob& glob) { return glob.reaches(path + "/"); });
        if (!matches && entry.d_type != DT_DIR && search_.passed_over) search_.passed_over(path);
        if (!matches && !reaches) return;
        struct stat status {};
        if (entry.d_type == DT_DIR) {
            status.st_mode = S_IFDIR;
        } else if (fstatat(dir, entry.d_name, &status, 0) != 0) {
            // A dangling link: the file is reported when it is read.
            if (matches) found_.push_back({path, 0});
            return;
        }
        if (S_ISREG(status.st_mode) && matches) found_.push_back({path, status.st_size});
        if (S_ISDIR(status.st_mode) && reaches && !search_.skip(path + "/")) folders.push_back(path + "/");
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
