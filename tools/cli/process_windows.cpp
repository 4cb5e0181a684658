// SPDX-License-Identifier: Apache-2.0
// Windows has no signals: it calls a handler, in a thread of its own, when Ctrl-C or Ctrl-Break is pressed, when the
// console is closed and when the user logs off. In the last two cases the process ends when the handler returns, so
// that it waits.

#include "cli/process.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <codecvt>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <locale>
#include <new>
#include <string>
#include <vector>

#include <fcntl.h>
#include <io.h>
#include <windows.h>

#include <shellapi.h>  // needs windows.h

#include <tex/file.h>

#include "cli/exit_code.h"
#include "files/wide_windows.h"

namespace tex::cli {
namespace {

constexpr int kOut = 1, kErr = 2;

bool is_console(int fd) {
    DWORD mode = 0;
    return GetConsoleMode(reinterpret_cast<HANDLE>(_get_osfhandle(fd)), &mode) != 0;
}

// A console takes text, whatever its code page; everything else takes bytes.
bool write_all(int fd, std::string_view text) {
    HANDLE handle = reinterpret_cast<HANDLE>(_get_osfhandle(fd));
    if (is_console(fd)) {
        const std::wstring characters = wide(text);
        DWORD written = 0;
        if (text.empty() || !characters.empty())
            return WriteConsoleW(handle, characters.data(), static_cast<DWORD>(characters.size()), &written, nullptr) !=
                   0;
    }
    constexpr std::size_t kMostAtOnce = std::size_t{1} << 20;
    while (!text.empty()) {
        DWORD written = 0;
        if (WriteFile(handle, text.data(), static_cast<DWORD>(std::min(text.size(), kMostAtOnce)), &written, nullptr) ==
            0) {
            set_errno();
            return false;
        }
        text.remove_prefix(written);
    }
    return true;
}

// Opens NUL in the wrong direction for each of the three streams that is closed, as elsewhere.
void fill_closed_streams() {
    for (int fd = 0; fd <= kErr; ++fd) {
        if (_get_osfhandle(fd) >= 0) continue;
        const int nul = _open("NUL", fd == 0 ? _O_WRONLY : _O_RDONLY);
        if (nul >= 0 && nul != fd) {
            _dup2(nul, fd);
            _close(nul);
        }
    }
}

std::atomic<DWORD> event{0};       // what the handler was told, and 1
constexpr DWORD kPatience = 1000;  // milliseconds

constexpr int kInterrupted = 128 + SIGINT;

[[noreturn]] void end_now(int status) {
    remove_unfinished_files();
    TerminateProcess(GetCurrentProcess(), static_cast<UINT>(status));
    for (;;) Sleep(INFINITE);
}

// The first event asks the running verbs to stop. The command ends at once if it does not stop within a second, or if
// there is a second event.
BOOL WINAPI on_event(DWORD kind) {
    if (event.exchange(kind + 1) != 0) end_now(kInterrupted);
    Sleep(kPatience);
    end_now(kInterrupted);
}

// See process_posix.cpp.
[[noreturn]] void on_terminate() {
    static std::atomic_flag is_ending;
    try {
        if (std::current_exception() != nullptr) throw;
    } catch (const std::bad_alloc&) {
        while (is_ending.test_and_set()) Sleep(INFINITE);
        Sleep(kPatience);
        write_all(kErr, "libtex: error: out of memory\n");
        end_now(static_cast<int>(ExitCode::io));
    } catch (...) {  // printed below
    }
    __gnu_cxx::__verbose_terminate_handler();
    std::abort();
}

}  // namespace

// The C++ library takes the characters of paths for those of the global locale, and gives them back as UTF-8.
Arguments own_arguments(int, char**) {
    std::locale::global(std::locale(std::locale::classic(), new std::codecvt_utf8_utf16<wchar_t>));
    static std::vector<std::string> texts;
    static std::vector<const char*> pointers;
    int count = 0;
    wchar_t** const words = CommandLineToArgvW(GetCommandLineW(), &count);
    for (int k = 0; words != nullptr && k < count; ++k) {
        texts.push_back(narrow(words[k]));
        // No name of a file holds a backslash here, and everything inside separates folders by slashes.
        for (char& c : texts.back()) c = c == '\\' ? '/' : c;
    }
    LocalFree(words);
    for (const std::string& text : texts) pointers.push_back(text.c_str());
    return pointers;
}

ProcessHost::ProcessHost() {
    SetErrorMode(SEM_FAILCRITICALERRORS | SEM_NOGPFAULTERRORBOX | SEM_NOOPENFILEERRORBOX);
    fill_closed_streams();
    for (int fd = 0; fd <= kErr; ++fd) _setmode(fd, _O_BINARY);
}

bool ProcessHost::write_out(std::string_view text) { return write_all(kOut, text); }
void ProcessHost::write_err(std::string_view text) { write_all(kErr, text); }

bool ProcessHost::out_is_terminal() const { return is_console(kOut); }

// A pipe without a reader; what a write would say.
bool ProcessHost::out_is_abandoned() const {
    HANDLE handle = reinterpret_cast<HANDLE>(_get_osfhandle(kOut));
    if (GetFileType(handle) != FILE_TYPE_PIPE) return false;
    DWORD written = 0;
    return WriteFile(handle, "", 0, &written, nullptr) == 0;
}

// One that knows the sequences which move the cursor: those of Windows 10 do, if they are asked to.
bool ProcessHost::err_is_terminal() const {
    HANDLE handle = reinterpret_cast<HANDLE>(_get_osfhandle(kErr));
    DWORD mode = 0;
    return GetConsoleMode(handle, &mode) != 0 && SetConsoleMode(handle, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING) != 0;
}

bool ProcessHost::err_has_color() const {
    const char* no_color = std::getenv("NO_COLOR");
    return err_is_terminal() && (no_color == nullptr || *no_color == '\0');
}

void ProcessHost::begin() {
    SetConsoleCtrlHandler(on_event, TRUE);
    std::set_terminate(on_terminate);
}

std::string_view ProcessHost::interruption() const {
    switch (event) {
        case 0: return {};
        case CTRL_C_EVENT + 1: return "Ctrl-C";
        case CTRL_BREAK_EVENT + 1: return "Ctrl-Break";
        default: return "the end of the session";
    }
}

void ProcessHost::end_interrupted() { end_now(kInterrupted); }

// Runs no destructors and no code of libraries.
void ProcessHost::end(ExitCode code) {
    TerminateProcess(GetCurrentProcess(), static_cast<UINT>(code));
    for (;;) Sleep(INFINITE);
}

}  // namespace tex::cli
