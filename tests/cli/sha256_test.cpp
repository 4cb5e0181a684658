// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <string>

#include "tree/sha256.h"

namespace tex::cli {

// The examples of FIPS 180-4, and two from NIST's byte-oriented test vectors (SHAVS).
TEST(Sha256, GivesTheSumsOfTheStandard) {
    EXPECT_EQ(digest_of("").hex(), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(digest_of("abc").hex(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(digest_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq").hex(),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    EXPECT_EQ(digest_of("\xd3").hex(), "28969cdfa74a12c82f3bad960b0b000aca2ac329deea5c2328ebc6f2ba9802c1");
    EXPECT_EQ(digest_of(std::string(1000000, 'a')).hex(),
              "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, DoesNotDependOnThePieces) {
    std::string text;
    for (int k = 0; k < 1000; ++k) text += static_cast<char>(k * 37);
    const Digest whole = digest_of(text);
    for (std::size_t piece : {1u, 7u, 63u, 64u, 65u, 200u}) {
        Sha256 sum;
        for (std::size_t at = 0; at < text.size(); at += piece) sum.add(std::string_view(text).substr(at, piece));
        EXPECT_EQ(sum.finish(), whole) << piece;
    }
}

TEST(Sha256, HexadecimalDigitsGoBothWays) {
    const Digest digest = digest_of("abc");
    EXPECT_EQ(Digest::from_hex(digest.hex()), digest);
    EXPECT_FALSE(Digest::from_hex("ab"));
    EXPECT_FALSE(Digest::from_hex(std::string(64, 'G')));
}

}  // namespace tex::cli
