#include "vm_protocol/core/line_framing.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace vm {
namespace {

/// Feeds `bytes` in pieces of `step` and lists what came out; errors as "!CODE".
std::vector<std::string> Lines(std::string_view bytes, std::size_t step,
                               Framing framing = Framing::kLf) {
  LineReader reader(framing);
  std::vector<std::string> lines;
  const auto take = [&lines](Result<std::string_view> line) {
    lines.push_back(line ? std::string(*line) : "!" + std::string(ErrcName(line.error().code)));
  };
  for (std::size_t at = 0; at < bytes.size(); at += step) reader.Feed(bytes.substr(at, step), take);
  reader.End(take);
  return lines;
}

using Strings = std::vector<std::string>;

class LineReaderChunkTest : public testing::TestWithParam<std::size_t> {};

TEST_P(LineReaderChunkTest, TheSameLinesComeHoweverTheBytesArrive) {
  EXPECT_EQ(Lines("one\r\ntwo\n\nthree", GetParam()), (Strings{"one", "two", "", "three"}));
  EXPECT_EQ(Lines("set Text =\na b./\r\nset Speak = NOW./\n", GetParam(), Framing::kMmi),
            (Strings{"set Text = a b", "set Speak = NOW"}));
  const std::string longer(kMaxLineBytes + 2, 'x');
  EXPECT_EQ(Lines(longer + "\nafter\n", GetParam()), (Strings{"!TOO_LONG", "after"}));
  const std::string longest(kMaxLineBytes, 'x');
  EXPECT_EQ(Lines(longest + "\r\nafter\n", GetParam()), (Strings{longest, "after"}));
}

INSTANTIATE_TEST_SUITE_P(Steps, LineReaderChunkTest, testing::Values(1, 2, 3, 7, 4096, 1 << 20));

TEST(LineReaderTest, AnOverlongLineIsReportedOnceAndAsSoonAsTheLimitIsPassed) {
  LineReader reader;
  int errors = 0;
  int lines = 0;
  const auto take = [&](Result<std::string_view> line) { ++(line ? lines : errors); };
  const std::string piece(1000, 'x');
  for (int i = 0; i < 1000; ++i) reader.Feed(piece, take);
  EXPECT_EQ(errors, 1);
  EXPECT_EQ(lines, 0);
  reader.Feed("\nok\n", take);
  EXPECT_EQ(errors, 1);
  EXPECT_EQ(lines, 1);
}

TEST(LineReaderTest, AutoTakesTheFramingOfTheFirstLine) {
  EXPECT_EQ(Lines("set A = 1./\nset B =\n2./\n", 5, Framing::kAuto),
            (Strings{"set A = 1", "set B = 2"}));
  EXPECT_EQ(Lines("set A = 1\nset B = ./\n", 5, Framing::kAuto),
            (Strings{"set A = 1", "set B = ./"}));
}

TEST(LineReaderTest, AMessageJoinedFromManyLinesHasTheSameLimit) {
  std::string bytes;
  for (int i = 0; i < 100; ++i) bytes += std::string(1000, 'x') + "\n";
  const auto lines = Lines(bytes + "./\nset A = 1./\n", 4096, Framing::kMmi);
  ASSERT_GE(lines.size(), 2u);
  EXPECT_EQ(lines.front(), "!TOO_LONG");
  EXPECT_NE(lines.back().find("set A = 1"), std::string::npos);
}

TEST(LineReaderTest, FramesForEitherSide) {
  EXPECT_EQ(Frame("rep Run = LIVE", Framing::kLf), "rep Run = LIVE\n");
  EXPECT_EQ(Frame("rep Run = LIVE", Framing::kMmi), "rep Run = LIVE./\n");
}

}  // namespace
}  // namespace vm
