// SPDX-License-Identifier: Apache-2.0
// wide_windows.h: paths and errors as Windows has them. Everywhere else, paths are UTF-8 and errors are those of errno.

#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tex::inline v1 {

// UTF-16. Empty, and errno is EILSEQ, if the text is not UTF-8.
std::wstring wide(std::string_view text);
// UTF-8. Halves of surrogate pairs, which names may hold, become U+FFFD.
std::string narrow(std::wstring_view text);

// A path for calls of Windows: absolute, without "." and "..", and in the form that may be longer than 260 characters.
// Empty, and errno is set, if it cannot be one.
std::wstring system_path(const std::string& path);

// Why the last name of a path cannot be that of a new file; null if it can. Windows gives some names to devices (con,
// nul, com1), forbids characters, takes what follows a colon for a stream, and drops dots and blanks at the end, so
// that the file would have another name.
const char* refusal_of_name(std::string_view path);

// Sets errno to what GetLastError() says. Returns it.
int set_errno();
int errno_of(unsigned long windows_error);

// In nanoseconds since 1970: of a time of Windows, which counts 100 ns since 1601.
constexpr std::int64_t nanoseconds_of(std::int64_t filetime) {
    constexpr std::int64_t kYears = 116444736000000000;  // from 1601 to 1970
    return (filetime - kYears) * 100;
}
constexpr std::int64_t filetime_of(std::int64_t nanoseconds) { return nanoseconds / 100 + 116444736000000000; }

}  // namespace tex::inline v1
