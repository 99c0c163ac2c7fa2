#include "task_manager/platform/json_line.h"

#include <gtest/gtest.h>

#include <limits>

namespace vxml {
namespace {

TEST(JsonLineTest, FieldsStandInTheOrderTheyWereAdded) {
  JsonLine inner;
  inner.List("z", {"b", "a"}).Bool("a", true);
  JsonLine line;
  line.Text("y", "1\n\"").Number("x", 2).Number("w", 0.5).Add(inner).Add(R"({"q":null})");
  EXPECT_EQ(line.str(), R"({"y":"1\n\"","x":2,"w":0.5,"z":["b","a"],"a":true,"q":null})");
}

TEST(JsonLineTest, BytesThatAreNoUtf8AreReplaced) {
  JsonLine line;
  line.Text("a", "x\xff").Raw("b", "\"\xed\xa0\x80\"");  // half of a surrogate pair
  EXPECT_EQ(line.str().find('\xff'), std::string::npos);
  EXPECT_EQ(line.str().find('\xed'), std::string::npos);
  EXPECT_TRUE(line.str().starts_with("{\"a\":\"x\uFFFD\",\"b\":")) << line.str();
}

TEST(JsonLineTest, WhatIsNoJsonIsAText) {
  JsonLine line;
  line.Raw("a", "undefined").Raw("b", "[1,").Raw("c", "[1,{\"d\":2}]").Add("nonsense");
  line.Number("e", std::numeric_limits<double>::infinity());
  EXPECT_EQ(line.str(), R"({"a":null,"b":"[1,","c":[1,{"d":2}],"e":null})");
}

}  // namespace
}  // namespace vxml
