// SPDX-License-Identifier: Apache-2.0
// The file is written under a temporary name beside the target, and renamed while it is open. It is locked, as
// elsewhere, at a byte that no file has. Windows removes no file that another program reads without sharing it, so that
// the rename may have to wait for a moment.

#include "files/pending_file.h"

#include <fcntl.h>
#include <io.h>
#include <windows.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "files/atomic_file.h"
#include "files/descriptor.h"
#include "files/system_error.h"
#include "files/unfinished_files.h"
#include "files/wide_windows.h"

namespace tex::inline v1 {
namespace {

constexpr DWORD kSharedByAll = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;

// Closed when it goes.
class Handle {
public:
    explicit Handle(HANDLE handle) : handle_(handle) {}
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    ~Handle() {
        if (*this) CloseHandle(handle_);
    }
    explicit operator bool() const { return handle_ != INVALID_HANDLE_VALUE; }
    [[nodiscard]] HANDLE get() const { return handle_; }

private:
    HANDLE handle_;
};

// Where the file goes.
struct Target {
    std::string path;   // as the caller gave it, for messages
    std::wstring full;  // for Windows
    std::wstring folder, name;
    bool exists = false;
};

Error exists_error(const Target& target) { return {ErrorCode::io, target.path, "exists already"}; }

// What a link leads to.
Result<std::wstring> behind_link(const std::string& path, const std::wstring& link) {
    const Handle file(CreateFileW(link.c_str(), FILE_READ_ATTRIBUTES, kSharedByAll, nullptr, OPEN_EXISTING,
                                  FILE_FLAG_BACKUP_SEMANTICS, nullptr));
    if (!file) return Error{ErrorCode::io, path, "is a link that leads to no file"};
    std::wstring real(32768, L'\0');
    const DWORD count =
        GetFinalPathNameByHandleW(file.get(), real.data(), static_cast<DWORD>(real.size()), FILE_NAME_NORMALIZED);
    if (count == 0 || count >= real.size()) return system_error(path, set_errno(), "is a link that cannot be followed");
    real.resize(count);
    return real;
}

// A user who may not write a file may not replace it. Programs that have it open do not count here.
bool may_write(const std::wstring& full) {
    const Handle file(CreateFileW(full.c_str(), GENERIC_WRITE, kSharedByAll, nullptr, OPEN_EXISTING,
                                  FILE_FLAG_OPEN_REPARSE_POINT, nullptr));
    return file || GetLastError() != ERROR_ACCESS_DENIED;
}

Result<Target> find_target(const std::string& path, const AtomicFileOptions& options) {
    if (const char* const refusal = refusal_of_name(path); refusal != nullptr)
        return Error{ErrorCode::io, path, refusal};
    Target target;
    target.path = path;
    target.full = system_path(path);
    if (target.full.empty()) return system_error(path, errno);
    if (target.full.starts_with(L"\\\\.\\")) return Error{ErrorCode::io, path, "is the name of a device of Windows"};
    DWORD attributes = GetFileAttributesW(target.full.c_str());
    if (attributes != INVALID_FILE_ATTRIBUTES && (attributes & FILE_ATTRIBUTE_REPARSE_POINT) != 0 &&
        options.follow_links) {
        Result<std::wstring> real = behind_link(path, target.full);
        if (!real) return real.error();
        target.full = std::move(*real);
        attributes = GetFileAttributesW(target.full.c_str());
    }
    const std::size_t name = target.full.rfind(L'\\') + 1;
    target.folder = target.full.substr(0, name);
    target.name = target.full.substr(name);
    if (attributes == INVALID_FILE_ATTRIBUTES) {
        if (GetLastError() == ERROR_PATH_NOT_FOUND) return Error{ErrorCode::io, path, "the directory does not exist"};
        return target;
    }
    target.exists = true;
    if (options.no_clobber) return exists_error(target);
    if ((attributes & FILE_ATTRIBUTE_DIRECTORY) != 0) return system_error(path, EISDIR);
    if ((attributes & FILE_ATTRIBUTE_READONLY) != 0 || !may_write(target.full)) return system_error(path, EACCES);
    return target;
}

// Takes the lock of a temporary file, as long as the handle is open.
bool lock(HANDLE file) {
    OVERLAPPED place{};
    place.OffsetHigh = 0x7fffffff;
    return LockFileEx(file, LOCKFILE_EXCLUSIVE_LOCK | LOCKFILE_FAIL_IMMEDIATELY, 0, 1, 0, &place) != 0;
}

// Removes a temporary file if its writer is gone.
void sweep(const std::wstring& path) {
    const Handle file(CreateFileW(path.c_str(), GENERIC_READ | DELETE, kSharedByAll, nullptr, OPEN_EXISTING,
                                  FILE_FLAG_OPEN_REPARSE_POINT, nullptr));
    if (!file || !lock(file.get())) return;
    FILE_DISPOSITION_INFO removal{};
    removal.DeleteFile = TRUE;
    SetFileInformationByHandle(file.get(), FileDispositionInfo, &removal, sizeof removal);
}

// Locks a new file. False if another process has done so before, or has removed it.
bool is_ours(HANDLE file) {
    FILE_STANDARD_INFO info{};
    return lock(file) && GetFileInformationByHandleEx(file, FileStandardInfo, &info, sizeof info) != 0 &&
           info.DeletePending == FALSE;
}

HANDLE create_new(const std::wstring& path) {
    return CreateFileW(path.c_str(), GENERIC_READ | GENERIC_WRITE | DELETE, kSharedByAll, nullptr, CREATE_NEW,
                       FILE_ATTRIBUTE_NORMAL, nullptr);
}

// Opens a file with a temporary name. Errors: io, out_of_memory.
Result<Descriptor> open_named(const Target& target, std::wstring& temporary, UnfinishedFile& unfinished) {
    constexpr std::size_t kMostOfName = 100;
    constexpr int kMostWriters = 4096;
    const std::wstring stem = target.folder + L"." + target.name.substr(0, kMostOfName) + L".tex-tmp";
    for (int k = 0; k < 2 * kMostWriters; ++k) {
        temporary = stem + std::to_wstring(k / 2);
        const std::string name = narrow(temporary);
        const NameSection section;
        HANDLE handle = create_new(temporary);
        if (handle == INVALID_HANDLE_VALUE) {
            const int failed = set_errno();
            if (failed == ENOENT) return Error{ErrorCode::io, target.path, "the directory does not exist"};
            if (failed != EEXIST && failed != EBUSY)
                return system_error(target.path, failed, "the directory cannot be written");
            if (k % 2 == 0) sweep(temporary);
            continue;
        }
        if (!is_ours(handle)) {  // another process took it for a dead writer's file
            CloseHandle(handle);
            continue;
        }
        unfinished.add(section, -1, name);
        Descriptor file(_open_osfhandle(reinterpret_cast<intptr_t>(handle), _O_RDWR | _O_BINARY | _O_NOINHERIT));
        if (file) return file;
        unfinished.remove(section);
        CloseHandle(handle);
        DeleteFileW(temporary.c_str());
        return system_error(target.path, EMFILE);
    }
    return system_error(target.path, EEXIST, "the directory cannot be written");
}

// Gives the new file the access list of the file that it replaces. If that fails, it has the one of its folder.
void keep_access(const Target& target, HANDLE file) {
    constexpr SECURITY_INFORMATION kAccess = DACL_SECURITY_INFORMATION;
    DWORD size = 0;
    GetFileSecurityW(target.full.c_str(), kAccess, nullptr, 0, &size);
    std::vector<std::byte> list(size);
    if (size == 0 || GetFileSecurityW(target.full.c_str(), kAccess, list.data(), size, &size) == 0) return;
    SetKernelObjectSecurity(file, kAccess, list.data());
}

// Renames the open file. Returns 0 or an errno.
int rename_open(HANDLE file, const std::wstring& to, bool no_clobber) {
    std::vector<std::byte> memory(sizeof(FILE_RENAME_INFO) + (to.size() + 1) * sizeof(wchar_t));
    auto* const renaming = new (memory.data()) FILE_RENAME_INFO{};
    renaming->ReplaceIfExists = no_clobber ? FALSE : TRUE;
    renaming->FileNameLength = static_cast<DWORD>(to.size() * sizeof(wchar_t));
    std::memcpy(renaming->FileName, to.c_str(), (to.size() + 1) * sizeof(wchar_t));
    constexpr int kTries = 20;
    constexpr DWORD kMoment = 50;  // milliseconds: programs that look at every new file do so for a moment
    for (int k = 0;; ++k) {
        if (SetFileInformationByHandle(file, FileRenameInfo, renaming, static_cast<DWORD>(memory.size())) != 0)
            return 0;
        const int failed = set_errno();
        if ((failed != EBUSY && failed != EACCES) || k == kTries) return failed;
        Sleep(kMoment);
    }
}

}  // namespace

struct PendingFile::State {
    Target target;
    Descriptor file;
    std::wstring temporary;  // empty once the file has its name
    std::optional<UnfinishedFile> unfinished;

    ~State() {
        if (temporary.empty()) return;
        const NameSection section;
        unfinished->remove(section);
        file.reset();
        DeleteFileW(temporary.c_str());
    }
    [[nodiscard]] HANDLE handle() const { return reinterpret_cast<HANDLE>(_get_osfhandle(file.get())); }
};

PendingFile::PendingFile(std::unique_ptr<State> state) : state_(std::move(state)) {}
PendingFile::PendingFile(PendingFile&&) noexcept = default;
PendingFile::~PendingFile() = default;

Result<PendingFile> PendingFile::open(const std::string& path, const AtomicFileOptions& options) {
    Result<Target> target = find_target(path, options);
    if (!target) return target.error();
    auto state = std::make_unique<State>();
    state->target = std::move(*target);
    std::wstring temporary;
    Result<Descriptor> file = open_named(state->target, temporary, state->unfinished.emplace());
    if (!file) return file.error();
    state->file = std::move(*file);
    state->temporary = std::move(temporary);
    return PendingFile(std::move(state));
}

int PendingFile::descriptor() const { return state_->file.get(); }

Result<void> PendingFile::settle(bool sync) {
    const Target& target = state_->target;
    if (target.exists) keep_access(target, state_->handle());
    if (sync && FlushFileBuffers(state_->handle()) == 0)
        return system_error(target.path, set_errno(), "cannot be written");
    return {};
}

std::string PendingFile::complete_path() const { return narrow(state_->temporary); }

Result<void> PendingFile::put_into_place(bool no_clobber) {
    const Target& target = state_->target;
    int failed = 0;
    {
        const NameSection section;
        failed = rename_open(state_->handle(), target.full, no_clobber);
        state_->unfinished->remove(section);
        if (failed == 0) {
            state_->temporary.clear();
            state_->file.reset();
        }
    }
    if (failed == 0) return {};
    if (no_clobber && failed == EEXIST) return exists_error(target);
    return system_error(target.path, failed, "cannot be put into place");
}

}  // namespace tex::inline v1
