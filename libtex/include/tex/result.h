// SPDX-License-Identifier: Apache-2.0
// result.h: how libtex reports failure.
//
// Functions that can fail return Result<T>: the value, or an Error that says which file is concerned and why, in one
// sentence that a technical artist understands. libtex throws no exception across its interface, prints nothing and
// never ends the process. (The constructors of Plane and the standard containers in its structs may throw
// std::bad_alloc in the caller's own code.)

#pragma once

#include <string>
#include <utility>
#include <variant>

#include <tex/names.h>

#pragma GCC visibility push(default)
namespace tex {

// What kind of failure it was. The commands map it to their exit codes (see normal-maps(7)).
enum class ErrorCode {
    io,             // a file cannot be opened, read, written or renamed; the disk is full
    bad_data,       // a file is damaged, truncated, or holds values that cannot be used (NaN heights)
    unsupported,    // a file is sound but of a type that libtex does not handle
    bad_option,     // the options contradict each other or the data (a channel that the file does not have)
    out_of_memory,  // memory, threads or another resource of the system ran out
    cancelled,      // the progress callback asked to stop, or a signal arrived while a FIFO waited for its reader
};

inline constexpr Named<ErrorCode> kErrorCodeNames[] = {
    {ErrorCode::io, "io", "a file cannot be read or written"},
    {ErrorCode::bad_data, "bad-data", "a file is damaged"},
    {ErrorCode::unsupported, "unsupported", "a file is of an unsupported kind"},
    {ErrorCode::bad_option, "bad-option", "the options do not fit"},
    {ErrorCode::out_of_memory, "out-of-memory", "memory or threads ran out"},
    {ErrorCode::cancelled, "cancelled", "cancelled"},
};

// What a program may act on, beyond the kind of failure.
enum class ErrorDetail {
    none,
    no_space,             // io: the disk, or the quota that the file counts towards, is full
    missing_heights,      // bad_data: some heights are missing, but not all (HeightOptions::fill_invalid fills them)
    uastc_without_alpha,  // unsupported: a KTX2 file without the channel that y is transcoded from
    several_materials,    // bad_option: MeshSelection::material must choose one
    no_tangents,          // bad_option: the mesh has no tangents of its own (TangentSource)
    no_uvs,               // what was selected of the mesh has no UVs
};

// A failure. `file` is the path concerned, as the caller gave it, or empty if no file is involved; `reason` is one
// clause without a final full stop ("truncated: level 3 wants 64 bytes, 12 are left").
struct Error {
    ErrorCode code = ErrorCode::io;
    std::string file;
    std::string reason;
    ErrorDetail detail = ErrorDetail::none;

    // "FILE: reason", or just the reason if no file is named.
    [[nodiscard]] std::string message() const { return file.empty() ? reason : file + ": " + reason; }

    // The same error for the file `path`, unless the error already names a file.
    [[nodiscard]] Error of(const std::string& path) const { return {code, file.empty() ? path : file, reason, detail}; }
};

// A value or an Error. Test it, then use value() or error(). Asking for the one that is absent is a programming error
// (std::bad_variant_access, as std::variant defines it).
template <class T>
class [[nodiscard]] Result {
public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

    [[nodiscard]] bool has_value() const noexcept { return state_.index() == 0; }
    explicit operator bool() const noexcept { return has_value(); }

    [[nodiscard]] T& value() & { return std::get<0>(state_); }
    [[nodiscard]] const T& value() const& { return std::get<0>(state_); }
    [[nodiscard]] T&& value() && { return std::get<0>(std::move(state_)); }
    [[nodiscard]] const Error& error() const& { return std::get<1>(state_); }
    [[nodiscard]] Error&& error() && { return std::get<1>(std::move(state_)); }

    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    T&& operator*() && { return std::move(*this).value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }

private:
    std::variant<T, Error> state_;
};

// Success without a value, or an Error.
template <>
class [[nodiscard]] Result<void> {
public:
    Result() = default;
    Result(Error error) : failed_(true), error_(std::move(error)) {}

    [[nodiscard]] bool has_value() const noexcept { return !failed_; }
    explicit operator bool() const noexcept { return has_value(); }
    [[nodiscard]] const Error& error() const& { return error_; }
    [[nodiscard]] Error&& error() && { return std::move(error_); }

private:
    bool failed_ = false;
    Error error_;
};

}  // namespace tex
#pragma GCC visibility pop
