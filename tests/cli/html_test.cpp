// SPDX-License-Identifier: Apache-2.0
// The parts of a page: text that stays text, bytes, and a limited size.

#include "reports/html.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "reports/html_marks.h"
#include "reports/html_report.h"

namespace tex::cli {
namespace {

std::vector<std::byte> bytes_of(const std::string& text) {
    const auto* from = reinterpret_cast<const std::byte*>(text.data());
    return {from, from + text.size()};
}

TEST(HtmlText, CanNeitherBeginATagNorEndAnAttribute) {
    EXPECT_EQ(html_text("<script>\"&'"), "&lt;script&gt;&quot;&amp;&#39;");
    EXPECT_EQ(html_text("a\nb\x1b"), "a\\x0ab\\x1b");
    EXPECT_EQ(html_text("\xff"), "\\xff") << "not UTF-8";
    EXPECT_EQ(html_text("\xc3\xa4"), "\xc3\xa4");
    EXPECT_EQ(script_json(Json("</script><!--")), "\"\\u003c/script>\\u003c!--\"");
}

TEST(Base64, IsThatOfRfc4648) {
    const std::pair<const char*, const char*> examples[] = {{"", ""},
                                                            {"f", "Zg=="},
                                                            {"fo", "Zm8="},
                                                            {"foo", "Zm9v"},
                                                            {"foob", "Zm9vYg=="},
                                                            {"fooba", "Zm9vYmE="},
                                                            {"foobar", "Zm9vYmFy"}};
    for (const auto& [text, code] : examples) EXPECT_EQ(base64(bytes_of(text)), code);
    EXPECT_EQ(base64(bytes_of("\xfb\xff\xfe")), "+//+");
}

// A map whose levels have the size of those in an uncompressed texture.
HtmlEntry entry(const std::string& name, int side) {
    HtmlEntry made;
    made.title = name;
    HtmlMap map;
    map.file = name;
    map.extent = {side, side};
    map.lit.png = bytes_of("lit");
    for (int n = side; n >= 1; n /= 2)
        map.decoded.levels.push_back(
            {{n, n}, std::vector<std::byte>(static_cast<std::size_t>(n) * static_cast<std::size_t>(n) * 3)});
    made.maps.push_back(std::move(map));
    return made;
}

TEST(HtmlReport, StaysSmallAndDoesNotDependOnTheOrder) {
    std::vector<std::string> names;
    for (int k = 0; k < 12; ++k) names.push_back("map" + std::to_string(k));
    const auto page = [&] {
        HtmlReport report("check-normals", check_columns());
        for (const std::string& name : names) report.add(name, entry(name, name == "map3" ? 64 : 1024));
        return report.page("summary");
    };
    const std::string first = page();
    EXPECT_LT(first.size(), kHtmlBudget + 200'000);
    EXPECT_GT(first.size(), kHtmlBudget / 4) << "no more is left out than must be";
    EXPECT_NE(first.find("[512,512,786432]"), std::string::npos);
    EXPECT_EQ(first.find("[1024,1024,"), std::string::npos);
    EXPECT_NE(first.find("[64,64,12288]"), std::string::npos);
    std::reverse(names.begin(), names.end());
    EXPECT_EQ(page(), first);
    std::rotate(names.begin(), names.begin() + 5, names.end());
    EXPECT_EQ(page(), first);
}

TEST(HtmlReport, HasNoMarksLeft) {
    HtmlReport report("check-normals", check_columns());
    report.add("<!--data-->", entry("<!--data-->", 4));
    const std::string page = report.page("<!--table-->");
    for (const char* mark :
         {"<!--data-->", "<!--table-->", "<!--title-->", "<!--script-->", "<!--sections-->", "<!--version-->"}) {
        EXPECT_EQ(page.find(mark), std::string::npos) << mark;
    }
}

TEST(HtmlSizes, ShrinkWithTheNumberOfFiles) {
    EXPECT_EQ(html_sizes(1).view, 192);
    EXPECT_EQ(html_sizes(100).view, 128);
    EXPECT_EQ(html_sizes(5000).lit, 0);
    EXPECT_GT(html_sizes(5000).thumbnail, 0);
    EXPECT_EQ(marks_side(1), 512);
    EXPECT_EQ(marks_side(100), 128);
    EXPECT_EQ(marks_side(5000), 0);
}

}  // namespace
}  // namespace tex::cli
