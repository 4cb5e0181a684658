// SPDX-License-Identifier: Apache-2.0

#include "files/wide_windows.h"

#include <windows.h>

#include <algorithm>
#include <cerrno>
#include <iterator>

namespace tex::inline v1 {
namespace {

bool is_letters(std::string_view text, std::string_view lower) {
    return std::equal(text.begin(), text.end(), lower.begin(), lower.end(), [](char a, char b) {
        return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
    });
}

// Names that Windows gives to devices, whatever their extension.
bool is_device(std::string_view name) {
    std::string_view stem = name.substr(0, name.find('.'));
    while (stem.ends_with(' ')) stem.remove_suffix(1);
    for (const std::string_view device : {"con", "prn", "aux", "nul", "conin$", "conout$", "clock$"}) {
        if (is_letters(stem, device)) return true;
    }
    if (stem.size() < 4) return false;
    if (!is_letters(stem.substr(0, 3), "com") && !is_letters(stem.substr(0, 3), "lpt")) return false;
    const std::string_view digit = stem.substr(3);  // superscript digits count, too
    return (digit.size() == 1 && digit[0] >= '0' && digit[0] <= '9') || digit == "\xc2\xb9" || digit == "\xc2\xb2" ||
           digit == "\xc2\xb3";
}

}  // namespace

std::wstring wide(std::string_view text) {
    std::wstring result;
    if (text.empty()) return result;
    const auto size = static_cast<int>(text.size());
    const int count = MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, text.data(), size, nullptr, 0);
    if (count <= 0) {
        errno = EILSEQ;
        return result;
    }
    result.resize(static_cast<std::size_t>(count));
    MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, text.data(), size, result.data(), count);
    return result;
}

std::string narrow(std::wstring_view text) {
    std::string result;
    if (text.empty()) return result;
    const auto size = static_cast<int>(text.size());
    const int count = WideCharToMultiByte(CP_UTF8, 0, text.data(), size, nullptr, 0, nullptr, nullptr);
    result.resize(static_cast<std::size_t>(std::max(count, 0)));
    WideCharToMultiByte(CP_UTF8, 0, text.data(), size, result.data(), count, nullptr, nullptr);
    return result;
}

std::wstring system_path(const std::string& path) {
    constexpr std::size_t kShort = 240;  // folders may have 248 characters without a prefix, files 260
    if (path.empty() || path.find('\0') != std::string::npos) {
        errno = ENOENT;
        return {};
    }
    const std::wstring given = wide(path);
    if (given.empty()) return {};
    std::wstring full;
    for (DWORD count = MAX_PATH; full.size() < count;) {
        full.resize(count);
        count = GetFullPathNameW(given.c_str(), count, full.data(), nullptr);
        if (count == 0) {
            set_errno();
            return {};
        }
        if (count < full.size()) {
            full.resize(count);
            break;
        }
    }
    if (full.size() < kShort || full.starts_with(L"\\\\?\\") || full.starts_with(L"\\\\.\\")) return full;
    if (full.starts_with(L"\\\\")) return L"\\\\?\\UNC" + full.substr(1);
    return L"\\\\?\\" + full;
}

const char* refusal_of_name(std::string_view path) {
    if (path.size() > 1 && path[1] == ':') path.remove_prefix(2);             // a drive
    const std::string_view name = path.substr(path.find_last_of("/\\") + 1);  // npos + 1 is 0
    if (name.empty() || name == "." || name == "..") return "names a directory, not a file";
    if (name.ends_with('.') || name.ends_with(' ')) return "ends with a dot or a blank, which Windows drops";
    for (const char c : name) {
        if (static_cast<unsigned char>(c) < 0x20 || std::string_view("<>:\"/\\|?*").find(c) != std::string_view::npos)
            return "holds a character that Windows allows in no name: one of < > : \" | ? * or a control character";
    }
    return is_device(name) ? "is the name of a device of Windows" : nullptr;
}

int errno_of(unsigned long windows_error) {
    struct Row {
        unsigned long error;
        int number;
    };
    constexpr Row kRows[] = {
        {ERROR_SUCCESS, 0},
        {ERROR_FILE_NOT_FOUND, ENOENT},
        {ERROR_PATH_NOT_FOUND, ENOENT},
        {ERROR_INVALID_DRIVE, ENOENT},
        {ERROR_BAD_NETPATH, ENOENT},
        {ERROR_BAD_NET_NAME, ENOENT},
        {ERROR_INVALID_NAME, ENOENT},
        {ERROR_BAD_PATHNAME, ENOENT},
        {ERROR_ACCESS_DENIED, EACCES},
        {ERROR_SHARING_VIOLATION, EBUSY},
        {ERROR_LOCK_VIOLATION, EBUSY},
        {ERROR_USER_MAPPED_FILE, EBUSY},
        {ERROR_DELETE_PENDING, EBUSY},
        {ERROR_WRITE_PROTECT, EROFS},
        {ERROR_DISK_FULL, ENOSPC},
        {ERROR_HANDLE_DISK_FULL, ENOSPC},
        {ERROR_FILE_EXISTS, EEXIST},
        {ERROR_ALREADY_EXISTS, EEXIST},
        {ERROR_DIRECTORY, ENOTDIR},
        {ERROR_DIR_NOT_EMPTY, ENOTEMPTY},
        {ERROR_NOT_SAME_DEVICE, EXDEV},
        {ERROR_FILENAME_EXCED_RANGE, ENAMETOOLONG},
        {ERROR_FILE_TOO_LARGE, EFBIG},
        {ERROR_CANT_RESOLVE_FILENAME, ELOOP},
        {ERROR_NOT_ENOUGH_MEMORY, ENOMEM},
        {ERROR_OUTOFMEMORY, ENOMEM},
        {ERROR_COMMITMENT_LIMIT, ENOMEM},
        {ERROR_NO_SYSTEM_RESOURCES, ENOMEM},
        {ERROR_TOO_MANY_OPEN_FILES, EMFILE},
        {ERROR_BROKEN_PIPE, EPIPE},
        {ERROR_NO_DATA, EPIPE},
        {ERROR_INVALID_HANDLE, EBADF},
        {ERROR_PRIVILEGE_NOT_HELD, EPERM},
        {ERROR_NOT_SUPPORTED, ENOTSUP},
        {ERROR_INVALID_FUNCTION, ENOTSUP},
    };
    const auto* const row = std::find_if(std::begin(kRows), std::end(kRows),
                                         [&](const Row& known) { return known.error == windows_error; });
    return row == std::end(kRows) ? EIO : row->number;
}

int set_errno() { return errno = errno_of(GetLastError()); }

}  // namespace tex::inline v1
