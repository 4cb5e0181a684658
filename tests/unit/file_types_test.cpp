// SPDX-License-Identifier: Apache-2.0

#include "formats/file_types.h"

#include <set>
#include <string_view>

#include <gtest/gtest.h>

#include "formats/ktx2/ktx2.h"
#include "formats/png/png.h"
#include "rows/codecs.h"

namespace tex {
namespace {

std::span<const std::byte> bytes_of(std::string_view text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}

TEST(Codecs, HaveOneRowForEachContainer) {
    for (const auto& row : kContainerNames) {
        const FileType& type = file_type_of(row.value);
        EXPECT_EQ(type.container, row.value);
        EXPECT_NE(type.parse == nullptr, type.open_rows == nullptr) << row.name;
        const int ways = (type.layout != nullptr) + (type.open_target != nullptr) + (type.reader_name != nullptr);
        EXPECT_EQ(ways, 1) << row.name;
        const bool is_bare = row.value == Container::r16 || row.value == Container::r32;  // no header, so no magic
        EXPECT_EQ(type.magic.empty(), type.reader_name != nullptr || type.claims != nullptr || is_bare) << row.name;
    }
}

TEST(Codecs, AreChosenByTheFirstBytes) {
    for (const auto& row : kContainerNames) {
        const FileType& type = file_type_of(row.value);
        if (type.magic.empty()) continue;
        EXPECT_EQ(file_type_for(bytes_of(type.magic)).container, row.value) << row.name;
        EXPECT_LE(type.magic.size(), InputFile::kHeadBytes);
        const std::string_view cut = type.magic.substr(0, type.magic.size() - 1);
        EXPECT_NE(file_type_for(bytes_of(cut)).reader_name, nullptr) << row.name;
    }
    EXPECT_NE(file_type_for({}).reader_name, nullptr);
    EXPECT_NE(file_type_for(bytes_of("B")).reader_name, nullptr);
    // A TGA has no magic, but a header that can be told from others: colours of 24 bits, 1 x 1.
    const std::string_view tga("\0\0\2\0\0\0\0\0\0\0\0\0\1\0\1\0\x18\0", 18);
    EXPECT_EQ(file_type_for(bytes_of(tga)).container, Container::tga);
    EXPECT_NE(file_type_for(bytes_of(tga.substr(0, 17))).reader_name, nullptr);
    for (const std::size_t field : {1u, 2u, 16u}) {
        std::string other(tga);
        other[field] = '\7';
        EXPECT_NE(file_type_for(bytes_of(other)).reader_name, nullptr) << field;
    }
}

TEST(Codecs, FilesBeginWithTheMagicOfTheirRow) {
    EXPECT_EQ(kKtx2Magic.size(), 12u);  // the identifier of the specification, all bytes of it
    EXPECT_EQ(kPngMagic, std::string_view("\x89PNG"));
    EXPECT_EQ(file_type_for(bytes_of("DDS |")).container, Container::dds);
}

TEST(Marks, NumberOneFormatEach) {
    for (const auto registry : {&FormatRow::dxgi, &FormatRow::vk}) {
        std::set<std::uint32_t> seen;
        for (const auto& row : kFormatNames) {
            const FormatNumbers& numbers = format_row(row.value).*registry;
            for (const std::uint32_t number : {numbers.exact, numbers.srgb, numbers.typeless}) {
                if (number == 0) continue;
                EXPECT_TRUE(seen.insert(number).second) << row.name;
                const auto found = find_format(registry, number);
                ASSERT_TRUE(found);
                EXPECT_EQ(found->format, row.value);
                EXPECT_EQ(found->srgb, number == numbers.srgb);
            }
        }
        EXPECT_FALSE(find_format(registry, 0));
        EXPECT_FALSE(find_format(registry, 1000));
    }
}

}  // namespace
}  // namespace tex
