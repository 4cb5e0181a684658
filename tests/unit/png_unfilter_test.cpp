// SPDX-License-Identifier: Apache-2.0

#include "kernels/png_unfilter.h"

#include <algorithm>
#include <cstdlib>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "unit/targets.h"

namespace tex {
namespace {

using Row = std::vector<std::uint8_t>;

// What the specification states, one byte after the other.
Row unfiltered(const Row& row, const Row& above, std::size_t step, int filter) {
    Row out;
    for (std::size_t i = 0; i < row.size(); ++i) {
        const int a = i < step ? 0 : out[i - step];
        const int b = above[i];
        const int c = i < step ? 0 : above[i - step];
        const int p = a + b - c;
        const int pa = std::abs(p - a), pb = std::abs(p - b), pc = std::abs(p - c);
        const int paeth = pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
        const int predicted[] = {0, a, b, (a + b) / 2, paeth};
        out.push_back(static_cast<std::uint8_t>(row[i] + predicted[filter]));
    }
    return out;
}

// Rows in memory as unfilter_png_rows() wants them. Their margins have no more room than promised.
struct Rows {
    Rows(std::size_t row_bytes, int row_count)
        : count(row_bytes), stride(row_bytes + kPngRowGap),
          bytes(kPngZeros + static_cast<std::size_t>(row_count) * stride + row_bytes + kPngRowGap - kPngZeros) {}

    std::uint8_t* row(int k) { return bytes.data() + kPngZeros + static_cast<std::size_t>(k + 1) * stride; }
    Row get(int k) { return {row(k), row(k) + count}; }
    // The margin after row k may have any contents, except its last bytes.
    void put(int k, const Row& from, std::mt19937& random) {
        std::copy(from.begin(), from.end(), row(k));
        std::generate_n(row(k) + count, kPngRowGap - kPngZeros, [&] { return static_cast<std::uint8_t>(random()); });
    }
    [[nodiscard]] bool has_zeros_before(int k) {
        return std::all_of(row(k) - kPngZeros, row(k), [](std::uint8_t b) { return b == 0; });
    }

    std::size_t count, stride;
    std::vector<std::uint8_t> bytes;
};

Row random_row(std::size_t count, std::mt19937& random) {
    Row row(count);
    // Few different bytes give many ties between the neighbours.
    const unsigned mask = random() % 2 == 0 ? 255 : 3;
    for (std::uint8_t& b : row) b = static_cast<std::uint8_t>(random() & mask);
    return row;
}

void expect_unfiltered(std::size_t count, std::size_t step, int rows, int only_filter, std::mt19937& random) {
    Rows held(count, rows);
    Row above = random() % 4 == 0 ? Row(count) : random_row(count, random);
    held.put(-1, above, random);
    std::vector<std::uint8_t> filters;
    std::vector<Row> expected;
    for (int k = 0; k < rows; ++k) {
        filters.push_back(static_cast<std::uint8_t>(only_filter >= 0 ? only_filter : static_cast<int>(random() % 5)));
        const Row row = random_row(count, random);
        held.put(k, row, random);
        expected.push_back(unfiltered(row, above, step, filters.back()));
        above = expected.back();
    }
    const Row before = held.get(-1);
    unfilter_png_rows(held.row(-1), held.stride, count, step, rows, filters.data());
    ASSERT_EQ(held.get(-1), before);
    for (int k = 0; k < rows; ++k) {
        ASSERT_EQ(held.get(k), expected[static_cast<std::size_t>(k)])
            << count << " bytes, texels of " << step << ", row " << k << " of " << rows << ", filter "
            << int{filters[static_cast<std::size_t>(k)]};
        ASSERT_TRUE(held.has_zeros_before(k));
    }
}

TEST(PngUnfilter, IsThatOfTheSpecificationOnEveryTarget) {
    on_every_target([] {
        std::mt19937 random(5);
        for (const std::size_t step : {1u, 2u, 3u, 4u, 6u, 8u}) {
            for (int rows = 1; rows <= kPngRowsTogether; ++rows) {
                for (const std::size_t texels : {1u, 2u, 5u, 15u, 16u, 17u, 48u, 61u})
                    expect_unfiltered(texels * step, step, rows, -1, random);
            }
        }
    });
}

TEST(PngUnfilter, EveryFilterAloneOnEveryTarget) {
    on_every_target([] {
        std::mt19937 random(6);
        for (const std::size_t step : {1u, 3u, 8u}) {
            for (int filter = 0; filter < 5; ++filter) {
                for (const int rows : {1, 4, 5, kPngRowsTogether})
                    expect_unfiltered(40 * step, step, rows, filter, random);
            }
        }
    });
}

}  // namespace
}  // namespace tex
