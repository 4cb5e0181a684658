// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "cli/text.h"

namespace tex::cli {

TEST(Text, NearestFindsWhatWasMeant) {
    const std::vector<std::string> kernels = {"forward", "central", "sobel", "scharr", "prewitt", "sobel5", "gaussian"};
    EXPECT_EQ(nearest("sobbel", kernels), "sobel");
    EXPECT_EQ(nearest("cnetral", kernels), "central");  // a transposition counts as one edit
    EXPECT_EQ(nearest("gauss", kernels), "gaussian");
    EXPECT_EQ(nearest("fwd", kernels), "");
    EXPECT_EQ(nearest("", kernels), "");
    EXPECT_EQ(nearest("--bumpyness", {"--bumpiness", "--blur"}), "--bumpiness");
    EXPECT_EQ(did_you_mean("scahrr", kernels), "; did you mean scharr?");
    EXPECT_EQ(did_you_mean("teapot", kernels), "");
}

TEST(Text, PrintableTextCannotDriveATerminal) {
    EXPECT_EQ(printable("a\nb\x1b[31m\x7f"), "a\\x0ab\\x1b[31m\\x7f");
    EXPECT_EQ(printable("Gelände.png"), "Gelände.png");
    EXPECT_EQ(printable("\xe2\x82\xac \xf0\x9f\xa7\xb1"), "\xe2\x82\xac \xf0\x9f\xa7\xb1");
    EXPECT_EQ(printable("\xc2\x9b"
                        "31m"),
              "\\xc2\\x9b31m");  // CSI as one character
    EXPECT_EQ(printable("\x9b"
                        "31m"),
              "\\x9b31m");  // and as one byte
    EXPECT_EQ(printable("a\xff\xe2\x82"), "a\\xff\\xe2\\x82");
    EXPECT_EQ(printable("\xc0\xaf\xed\xa0\x80\xf4\x90\x80\x80"),
              "\\xc0\\xaf\\xed\\xa0\\x80\\xf4\\x90\\x80\\x80");                       // not UTF-8
    EXPECT_EQ(printable("\xef\xbf\xbe\xef\xbf\xbd"), "\\xef\\xbf\\xbe\xef\xbf\xbd");  // a noncharacter, and a character
}

TEST(Text, PrintableTextReadsInItsOwnOrder) {
    EXPECT_EQ(printable("a\u202egnp.exe"), "a\\xe2\\x80\\xaegnp.exe");
    for (const char* const hidden : {"\u061c", "\u200b", "\u200e", "\u200f", "\u2028", "\u2029",     "\u202a",
                                     "\u202b", "\u202c", "\u202d", "\u202e", "\u2060", "\u2066",     "\u2067",
                                     "\u2068", "\u2069", "\u206f", "\ufeff", "\ufff9", "\U000e0041", "\u0085"}) {
        const std::string text = printable(hidden);
        EXPECT_EQ(text.size(), 4 * std::string_view(hidden).size()) << text;
        EXPECT_TRUE(text.starts_with("\\x")) << text;
    }
    // Joiners are part of words. The code points next to the escaped ones are ordinary characters.
    for (const char* const shown : {"\u200c", "\u200d", "\u2010", "\u2027", "\u202f", "\u2070", "\ufeee", "\U0001f9f1"})
        EXPECT_EQ(printable(shown), shown);
}

TEST(Text, WrapsAtBlanks) {
    EXPECT_EQ(wrapped("the quick brown fox", 10), (std::vector<std::string>{"the quick", "brown fox"}));
    EXPECT_EQ(wrapped("a verylongword b", 6), (std::vector<std::string>{"a", "verylongword", "b"}));
    EXPECT_EQ(wrapped("", 6), std::vector<std::string>{""});
}

}  // namespace tex::cli
