// SPDX-License-Identifier: Apache-2.0
// The file is written under a temporary name beside the target, and renamed while it is open. It is locked, as
// elsewhere, at a byte that no file has. Windows removes no file that another program reads without sharing it, so that
// the rename may have to wait for a moment.

#include "files/atomic_file.h"

#include <fcntl.h>
#include <io.h>
#include <windows.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include <tex/file.h>

#include "files/descriptor.h"
#include "files/system_error.h"
#include "files/through_file.h"
#include "files/unfinished_files.h"
#include "files/wide_windows.h"
#include "threads/guard.h"

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

AtomicFileOptions AtomicFileOptions::of(const WriteOptions& options) {
    return {options.sync, options.no_clobber, options.follow_links, options.before_replacing, options.replaced};
}

struct AtomicFile::State {
    Target target;
    AtomicFileOptions options;
    Descriptor file;
    std::wstring temporary;  // empty once the file has its name
    std::optional<UnfinishedFile> unfinished;
    std::optional<ThroughFile> through;  // if set, nothing above is used

    ~State() {
        if (temporary.empty()) return;
        const NameSection section;
        unfinished->remove(section);
        file.reset();
        DeleteFileW(temporary.c_str());
    }
    [[nodiscard]] HANDLE handle() const { return reinterpret_cast<HANDLE>(_get_osfhandle(file.get())); }
};

AtomicFile::AtomicFile(std::unique_ptr<State> state) : state_(std::move(state)) {}
AtomicFile::AtomicFile(AtomicFile&&) noexcept = default;
AtomicFile::~AtomicFile() = default;

Result<AtomicFile> AtomicFile::open(const std::string& path, const AtomicFileOptions& options) {
    return guarded([&]() -> Result<AtomicFile> {
        if (path.find('\0') != std::string::npos) return Error{ErrorCode::io, path, "the name holds a zero byte"};
        if (const char* const refusal = refusal_of_name(path); refusal != nullptr && !named_descriptor(path))
            return Error{ErrorCode::io, path, refusal};
        auto state = std::make_unique<State>();
        state->options = options;
        if (options.follow_links || named_descriptor(path)) {
            Result<std::optional<ThroughFile>> through = ThroughFile::open(path);
            if (!through) return through.error();
            if (*through) {
                state->through = std::move(*through);
                return AtomicFile(std::move(state));
            }
        }
        Result<Target> target = find_target(path, options);
        if (!target) return target.error();
        state->target = std::move(*target);
        std::wstring temporary;
        Result<Descriptor> file = open_named(state->target, temporary, state->unfinished.emplace());
        if (!file) return file.error();
        state->file = std::move(*file);
        state->temporary = std::move(temporary);
        return AtomicFile(std::move(state));
    });
}

Result<void> AtomicFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) {
    return guarded([&]() -> Result<void> {
        if (state_->through) {
            state_->through->hold(offset, bytes);
            return {};
        }
        while (!bytes.empty()) {
            const std::ptrdiff_t n = write_some_at(state_->file.get(), offset, bytes.data(), bytes.size());
            if (n < 0) return system_error(state_->target.path, errno, "cannot be written");
            bytes = bytes.subspan(static_cast<std::size_t>(n));
            offset += static_cast<std::uint64_t>(n);
        }
        return {};
    });
}

Result<void> AtomicFile::commit() {
    return guarded([&]() -> Result<void> {
        if (state_->through) return state_->through->write_held();
        const Target& target = state_->target;
        const AtomicFileOptions& options = state_->options;
        if (target.exists) keep_access(target, state_->handle());
        if (options.sync && FlushFileBuffers(state_->handle()) == 0)
            return system_error(target.path, set_errno(), "cannot be written");
        if (options.before_replacing) {
            if (Result<void> accepted = options.before_replacing(target.path, narrow(state_->temporary)); !accepted)
                return accepted;
        }
        const Result<void> placed = put_into_place();
        if (placed && options.replaced) options.replaced(target.path);
        return placed;
    });
}

Result<void> AtomicFile::put_into_place() {
    const Target& target = state_->target;
    int failed = 0;
    {
        const NameSection section;
        failed = rename_open(state_->handle(), target.full, state_->options.no_clobber);
        state_->unfinished->remove(section);
        if (failed == 0) {
            state_->temporary.clear();
            state_->file.reset();
        }
    }
    if (failed == 0) return {};
    if (state_->options.no_clobber && failed == EEXIST) return exists_error(target);
    return system_error(target.path, failed, "cannot be put into place");
}

Result<void> write_atomically(const std::string& path, std::span<const std::byte> bytes,
                              const AtomicFileOptions& options) {
    Result<AtomicFile> file = AtomicFile::open(path, options);
    if (!file) return file.error();
    if (file->state_->through) return file->state_->through->write(bytes);
    if (Result<void> written = file->write_at(0, bytes); !written) return written;
    return file->commit();
}

}  // namespace tex::inline v1
