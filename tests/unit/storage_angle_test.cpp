// SPDX-License-Identifier: Apache-2.0
// The table of largest angles in normal-maps(7), derived again: normals on the borders between codes, where rounding
// moves them farthest, go through pack() and unpack().

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/pack.h>

namespace tex {
namespace {

constexpr double kDegrees = 180 / 3.14159265358979323846;
constexpr double kLeastZ[] = {0, 0.15, 0.25, 0.5};  // the columns of the table
using Row = std::array<double, 4>;

// The numbers of the row of the manual that begins with these encodings.
Row row_of_the_manual(const std::string& encodings) {
    std::ifstream manual(TEX_SOURCE_DIR "/man/shared/encoding-errors.mdoc");
    const std::string start = ".It Cm " + encodings + " Ta ";
    for (std::string line; std::getline(manual, line);) {
        if (!line.starts_with(start)) continue;
        Row row{};
        std::string separator;
        std::istringstream numbers(line.substr(start.size()));
        for (double& number : row) {
            if (numbers >> number; !numbers) break;
            numbers >> separator;
        }
        if (row[3] > 0) return row;
    }
    ADD_FAILURE() << "the manual has no row for " << encodings;
    return {};
}

struct Vectors {
    std::vector<float> x, y;
    // Adds (x, y) if it lies in the unit circle.
    void add(double a, double b) {
        if (a * a + b * b > 1) return;
        x.push_back(static_cast<float>(a));
        y.push_back(static_cast<float>(b));
    }
};

// The largest angles by which the encoding moves the vectors, for each column.
Row largest_angles(const Vectors& vectors, Encoding encoding) {
    constexpr int kWidth = 1024;
    const int count = static_cast<int>(vectors.x.size());
    NormalMap map({kWidth, (count + kWidth - 1) / kWidth});
    for (int k = 0; k < kWidth * map.extent().height; ++k) {
        const auto from = static_cast<std::size_t>(std::min(k, count - 1));
        const double x = static_cast<double>(vectors.x[from]);
        const double y = static_cast<double>(vectors.y[from]);
        map.x.at(k % kWidth, k / kWidth) = vectors.x[from];
        map.y.at(k % kWidth, k / kWidth) = vectors.y[from];
        map.z.at(k % kWidth, k / kWidth) = static_cast<float>(std::sqrt(std::max(0.0, 1 - x * x - y * y)));
    }
    MipChain chain;
    chain.levels.push_back(std::move(map));
    const auto texture = pack(chain, {encoding});
    EXPECT_TRUE(texture);
    const auto back = unpack(*texture);
    EXPECT_TRUE(back);
    Row largest{};
    for (int k = 0; k < count; ++k) {
        const NormalMap& before = chain.levels[0];
        const NormalMap& after = back->levels[0];
        const auto at = [k](const Plane<float>& plane) {
            return static_cast<double>(plane.at(k % kWidth, k / kWidth));
        };
        const double x = at(before.x), y = at(before.y), p = at(after.x), q = at(after.y), r = at(after.z);
        const double z = std::sqrt(std::max(0.0, 1 - x * x - y * y));
        const double cross = std::hypot(y * r - z * q, z * p - x * r, x * q - y * p);
        const double angle = std::atan2(cross, x * p + y * q + z * r) * kDegrees;
        for (std::size_t c = 0; c < 4; ++c) {
            if (z >= kLeastZ[c]) largest[c] = std::max(largest[c], angle);
        }
    }
    return largest;
}

// No angle exceeds the manual's, and the manual's exceed the largest by at most a part of them.
void expect_row(const std::string& encodings, Encoding encoding, const Vectors& vectors, double part) {
    const Row stated = row_of_the_manual(encodings);
    const Row found = largest_angles(vectors, encoding);
    for (std::size_t c = 0; c < 4; ++c) {
        SCOPED_TRACE(encodings + ", z >= " + std::to_string(kLeastZ[c]));
        EXPECT_LE(found[c], stated[c]);
        EXPECT_GE(found[c], stated[c] * (1 - part));
    }
}

// A point within a code's cell moves farthest if it is a corner of the cell. Corners are moved a little to each side,
// so that they round to each of the four neighbours. Cells that the unit circle cuts end on the circle.
Vectors corners(int top, const std::vector<int>& codes, int from_diagonal) {
    constexpr double kAside = 2e-7;
    Vectors vectors;
    for (const int i : codes) {
        for (const int j : codes) {
            if (from_diagonal > 0 && std::abs(i - j) > from_diagonal) continue;
            for (const double a : {-kAside, kAside}) {
                for (const double b : {-kAside, kAside})
                    vectors.add((2 * i + 1.0) / top - 1 + a, (2 * j + 1.0) / top - 1 + b);
            }
        }
    }
    std::mt19937 random(1);
    for (int k = 0; k < 400'000; ++k) {
        const double around = static_cast<double>(random()) / 4294967296.0 * 2 * 3.14159265358979;
        vectors.add((1 - 1e-7) * std::cos(around), (1 - 1e-7) * std::sin(around));
    }
    return vectors;
}

TEST(StorageAngle, OfXAndYIn8BitsIsTheManuals) {
    std::vector<int> all;
    for (int code = 0; code < 255; ++code) all.push_back(code);
    const Vectors vectors = corners(255, all, 0);
    expect_row("rg8 , ag8", Encoding::rg8, vectors, 0.06);
    expect_row("rg8 , ag8", Encoding::ag8, vectors, 0.06);
}

// Not all corners: those along the diagonal, where the errors of x and y add up, in the half where z is small.
TEST(StorageAngle, OfXAndYIn16BitsIsTheManuals) {
    std::vector<int> codes;
    for (int code = 50'000; code < 56'000; ++code) codes.push_back(code);
    const Vectors vectors = corners(65535, codes, 8);
    expect_row("rg16", Encoding::rg16, vectors, 0.09);
}

TEST(StorageAngle, OfThreeComponentsIsTheManuals) {
    std::vector<int> all;
    for (int code = 0; code < 255; ++code) all.push_back(code);
    expect_row("rgb8 , rgba8", Encoding::rgb8, corners(255, all, 0), 0.06);
    expect_row("rgb8 , rgba8", Encoding::rgba8, corners(255, all, 0), 0.06);
    // Many vectors near corners of x and y, so that z also comes near the border between codes.
    Vectors vectors;
    std::mt19937 random(2);
    for (int k = 0; k < 2'000'000; ++k) {
        const double top = 65535;
        const auto corner = [&] { return (2.0 * static_cast<double>(random() % 65535) + 1) / top - 1; };
        vectors.add(corner(), corner());
    }
    expect_row("rgb16 , rgba16", Encoding::rgb16, vectors, 0.09);
    // Halves are coarsest from 1/2 on, where x and y lie in the middle between two of them.
    Vectors halves;
    for (int k = 0; k < 2'000'000; ++k) {
        const auto middle = [&] { return 0.5 + (static_cast<double>(random() % 512) + 0.5) / 2048; };
        halves.add(middle(), random() % 2 == 0 ? middle() : -middle());
    }
    expect_row("half , rgba16f", Encoding::half, halves, 0.06);
}

}  // namespace
}  // namespace tex
