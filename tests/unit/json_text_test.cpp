// SPDX-License-Identifier: Apache-2.0

#include "mesh/json_text.h"

#include <random>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace tex {
namespace {

TEST(JsonText, KeepsWhatDoesNotChange) {
    const std::string text =
        " {\n  \"a\" : [ 1.0e+2 , -0.0,\t{\"b\":\"]}\\\"\" } ],\n  \"c\\u0064\": { },\r\n  \"e\": [ ]\n}\n ";
    JsonText json(text);
    EXPECT_EQ(json.text(), text);
    EXPECT_EQ(json.root().size(), 3u);
    EXPECT_EQ(json.root().member("a")->size(), 3u);
    EXPECT_NE(json.root().member("a")->element(2)->member("b"), nullptr);
    EXPECT_NE(json.root().member("cd"), nullptr) << "escapes in keys";
    EXPECT_EQ(json.root().member("cd")->size(), 0u);
    EXPECT_EQ(json.root().member("e")->size(), 0u);
    EXPECT_EQ(json.root().member("none"), nullptr);
    EXPECT_EQ(json.root().member("a")->element(3), nullptr);
    EXPECT_EQ(json.text(), text) << "opening parts changes nothing";
}

TEST(JsonText, ChangesOnlyWhatIsNamed) {
    JsonText json("{\n  \"list\": [\n    {\"x\": 1},\n    {\"x\": 2.50}\n  ],\n  \"last\": true\n}\n");
    json.root().member("list")->element(0)->set("x", "7");
    json.root().member("list")->element(1)->set("y", "\"new\"");
    json.root().member("list")->append("{}");
    json.root().set("more", "null");
    EXPECT_EQ(json.text(),
              "{\n  \"list\": [\n    {\"x\": 7},\n    {\"x\": 2.50,\"y\": \"new\"},\n    {}\n  ],\n  \"last\": true,\n"
              "  \"more\": null\n}\n");
    json.root().remove("list");
    json.root().remove("more");
    EXPECT_EQ(json.text(), "{\n  \"last\": true\n}\n");
    json.root().remove("last");
    EXPECT_EQ(json.text(), "{}\n");
    json.root().set("a", "[]");
    json.root().member("a")->append("1");
    json.root().member("a")->append("2");
    json.root().member("a")->remove_element(0);
    EXPECT_EQ(json.text(), "{\"a\":[2]}\n");
}

TEST(JsonText, OfEqualKeysTheLastCounts) {
    JsonText json(R"({"k":1,"k":2})");
    json.root().set("k", "3");
    EXPECT_EQ(json.text(), R"({"k":1,"k":3})");
    json.root().remove("k");
    EXPECT_EQ(json.text(), "{}");
}

TEST(JsonText, KeepsAByteOrderMark) {
    JsonText json("\xef\xbb\xbf{\"a\":1}");
    json.root().set("a", "2");
    EXPECT_EQ(json.text(), "\xef\xbb\xbf{\"a\":2}");
}

// Random edits, beside the same ones of nlohmann-json.
TEST(JsonText, EditsAreThoseOfAParser) {
    std::minstd_rand random(3);
    const auto below = [&](std::size_t n) { return random() % n; };
    for (int round = 0; round < 500; ++round) {
        nlohmann::ordered_json model = {
            {"a", {1, "x,]", nullptr}}, {"b", {{"c", 1.5}, {"d", {{"e", "}"}}}}}, {"f", {}}};
        const std::string text = model.dump(round % 3 == 0 ? 2 : -1);
        JsonText json(text);
        for (int step = 0; step < 8; ++step) {
            const std::string key(1, static_cast<char>('a' + below(8)));
            nlohmann::ordered_json* part = &model;
            JsonNode* node = &json.root();
            if (below(2) == 0 && model.contains("b") && model["b"].is_object()) {
                part = &model["b"];
                node = json.root().member("b");
                ASSERT_NE(node, nullptr);
            }
            if (below(3) == 0) {
                part->erase(key);
                node->remove(key);
                continue;
            }
            (*part)[key] = step;
            node->set(key, std::to_string(step));
        }
        ASSERT_EQ(nlohmann::ordered_json::parse(json.text()), model) << json.text();
    }
}

TEST(JsonText, StringsAreQuoted) {
    EXPECT_EQ(json_string("a\"b\\\n"), R"("a\"b\\\n")");
    EXPECT_EQ(json_string("\xff"), "\"\xef\xbf\xbd\"") << "not UTF-8";
}

}  // namespace
}  // namespace tex
