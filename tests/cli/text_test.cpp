// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "cli/text.h"

namespace tex::cli {

TEST(Text, NearestFindsWhatWasMeant) {
    const std::vector<std::string> kernels = {"forward", "central", "sobel",   "scharr",
                                              "prewitt", "sobel5",  "gaussian"};
    EXPECT_EQ(nearest("sobbel", kernels), "sobel");
    EXPECT_EQ(nearest("cnetral", kernels), "central");  // a transposition counts once
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
}

TEST(Text, WrapsAtBlanks) {
    EXPECT_EQ(wrapped("the quick brown fox", 10), (std::vector<std::string>{"the quick", "brown fox"}));
    EXPECT_EQ(wrapped("a verylongword b", 6), (std::vector<std::string>{"a", "verylongword", "b"}));
    EXPECT_EQ(wrapped("", 6), std::vector<std::string>{""});
}

}  // namespace tex::cli
