// SPDX-License-Identifier: Apache-2.0
// digits.cpp: std::to_chars() to a number of digits, in place of libc++'s ryu/d2fixed.cpp, whose tables take 105 KB.
// printf() is exact in musl, too.

#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>

#include "include/ryu/d2fixed.h"

_LIBCPP_BEGIN_NAMESPACE_STD

static to_chars_result print(char* first, char* last, const char* form, double value, uint32_t digits) {
    char text[400];
    const int count = snprintf(text, sizeof text, form, static_cast<int>(digits), value);
    if (count < 0 || count > last - first) return {last, errc::value_too_large};
    if (static_cast<size_t>(count) < sizeof text) {
        memcpy(first, text, static_cast<size_t>(count));
    } else {
        const auto size = static_cast<size_t>(count) + 1;
        const unique_ptr<char[]> all(new char[size]);
        snprintf(all.get(), size, form, static_cast<int>(digits), value);
        memcpy(first, all.get(), size - 1);
    }
    return {first + count, errc()};
}

to_chars_result __d2fixed_buffered_n(char* first, char* const last, const double value, const uint32_t digits) {
    return print(first, last, "%.*f", value, digits);
}

to_chars_result __d2exp_buffered_n(char* first, char* const last, const double value, uint32_t digits) {
    return print(first, last, "%.*e", value, digits);
}

void __append_n_digits(const uint32_t count, uint32_t digits, char* const to) {
    for (uint32_t k = count; k > 0; digits /= 10) to[--k] = static_cast<char>('0' + digits % 10);
}

void __append_nine_digits(uint32_t digits, char* const to) { __append_n_digits(9, digits, to); }

_LIBCPP_END_NAMESPACE_STD
