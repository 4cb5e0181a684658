// SPDX-License-Identifier: Apache-2.0

#include "cli/value.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "cli/text.h"
#include "cli/usage_error.h"

namespace tex::cli {
namespace {

// Whether asked_number() waits for a number on this thread.
thread_local bool is_asking = false;

void ask(AskedNumber::Kind kind, Range range) {
    if (is_asking) throw AskedNumber{kind, interval_of(range)};
}

void check_range(std::string_view text, double value, const Range& given) {
    const Range range = interval_of(given);
    const bool too_small = range.least_too ? value < range.least : value <= range.least;
    if (!too_small && value <= range.greatest) return;
    if (std::isinf(range.greatest)) {
        throw UsageError(fmt::format("{} is not {} {}", printable(text), range.least_too ? "at least" : "greater than",
                                     range.least));
    }
    throw UsageError(fmt::format("{} is not {} {} and at most {}", printable(text),
                                 range.least_too ? "at least" : "greater than", range.least, range.greatest));
}

template <class T>
T parse_number(std::string_view text, const char* what) {
    std::string_view digits = text;
    if (digits.starts_with('+') && !digits.starts_with("+-")) digits.remove_prefix(1);
    T value{};
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc::result_out_of_range && end == digits.data() + digits.size()) {
        throw UsageError(fmt::format("{} is too large or too small a number", printable(text)));
    }
    if (error != std::errc() || end != digits.data() + digits.size()) {
        throw UsageError(fmt::format("'{}' is not {}", printable(text), what));
    }
    return value;
}

template <class T>
T parse_real(std::string_view text, Range range) {
    const T value = parse_number<T>(text, "a number");
    if (!std::isfinite(value)) throw UsageError(fmt::format("{} is not a finite number", printable(text)));
    check_range(text, static_cast<double>(value), range);
    return value;
}

}  // namespace

float parse_float(std::string_view text, Range range) {
    ask(AskedNumber::Kind::number, range);
    return parse_real<float>(text, range);
}
double parse_double(std::string_view text, Range range) {
    ask(AskedNumber::Kind::number, range);
    return parse_real<double>(text, range);
}

int parse_int(std::string_view text, int least, int greatest) {
    ask(AskedNumber::Kind::integer, {static_cast<double>(least), static_cast<double>(greatest)});
    const int value = parse_number<int>(text, "a whole number");
    check_range(text, value, {static_cast<double>(least), static_cast<double>(greatest)});
    return value;
}

int parse_int(std::string_view text, const Range& range) {
    const auto side = [](double value) {
        return static_cast<int>(
            std::clamp(value, double{std::numeric_limits<int>::min()}, double{std::numeric_limits<int>::max()}));
    };
    const Range interval = interval_of(range);
    return parse_int(text, side(interval.least), side(interval.greatest));
}

std::pair<int, int> parse_pair_of_sides(std::string_view text, int most) {
    const std::size_t by = text.find('x');
    const int width = parse_int(text.substr(0, by), 1, most);
    return {width, by == std::string_view::npos ? width : parse_int(text.substr(by + 1), 1, most)};
}

std::int64_t parse_count(std::string_view text) {
    ask(AskedNumber::Kind::count, {1.0});
    std::string_view digits = text;
    int shift = 0;
    if (!digits.empty()) {
        const std::size_t place = std::string_view("KMGTkmgt").find(digits.back());
        if (place != std::string_view::npos) {
            shift = 10 * (static_cast<int>(place % 4) + 1);
            digits.remove_suffix(1);
        }
    }
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size() || value < 1 ||
        value > (std::numeric_limits<std::int64_t>::max() >> shift)) {
        throw UsageError(fmt::format("'{}' is not a count such as 65536, 512M or 4G", printable(text)));
    }
    return value << shift;
}

std::optional<AskedNumber> asked_number(const std::function<void()>& take) {
    is_asking = true;
    std::optional<AskedNumber> asked;
    try {
        take();
    } catch (const AskedNumber& number) {
        asked = number;
    } catch (const UsageError&) {  // a word was expected, or more parts
    }
    is_asking = false;
    return asked;
}

std::string count_text(std::int64_t count) {
    int power = 0;
    for (; power < 4 && count % 1024 == 0 && count > 0; ++power) count /= 1024;
    return fmt::format("{}{}", count, power == 0 ? "" : std::string(1, "KMGT"[power - 1]));
}

std::pair<std::string, std::string> cut(std::string_view text, char separator) {
    const std::size_t place = text.find(separator);
    if (place == std::string_view::npos) return {std::string(text), std::string()};
    return {std::string(text.substr(0, place)), std::string(text.substr(place + 1))};
}

std::vector<std::string> split(std::string_view text, char separator) {
    std::vector<std::string> parts;
    std::size_t place = 0;
    for (std::size_t end = 0; (end = text.find(separator, place)) != std::string_view::npos; place = end + 1)
        parts.emplace_back(text.substr(place, end - place));
    parts.emplace_back(text.substr(place));
    return parts;
}

}  // namespace tex::cli
