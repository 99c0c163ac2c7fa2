#include "vm_protocol/runtime/encoding.h"

#include <gtest/gtest.h>

namespace vm {
namespace {

// Byte values from the JIS tables: あ is A4 A2 in EUC-JP and 82 A0 in Shift_JIS.
TEST(EncodingTest, ConvertsTheEncodingsOfTheOriginalBothWays) {
  EXPECT_EQ(ToUtf8("\xa4\xa2", Encoding::kEucJp), "あ");
  EXPECT_EQ(ToUtf8("\x82\xa0", Encoding::kShiftJis), "あ");
  EXPECT_EQ(FromUtf8("あ", Encoding::kEucJp), "\xa4\xa2");
  EXPECT_EQ(FromUtf8("あ", Encoding::kShiftJis), "\x82\xa0");
  EXPECT_EQ(ToUtf8("あ", Encoding::kUtf8), "あ");
}

TEST(EncodingTest, NamesThePlaceOfABadByte) {
  const auto bad = ToUtf8("ab\xff", Encoding::kEucJp);
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().code, Errc::kBadUtf8);
  EXPECT_EQ(bad.error().column, 3u);
  EXPECT_FALSE(ToUtf8("\xff", Encoding::kUtf8));
  EXPECT_EQ(FromUtf8("a😀b", Encoding::kShiftJis), "a?b");
}

TEST(EncodingTest, KnowsTheNamesInAnyCase) {
  EXPECT_EQ(ParseEncoding("EUC-JP"), Encoding::kEucJp);
  EXPECT_EQ(ParseEncoding("Shift_JIS"), Encoding::kShiftJis);
  EXPECT_EQ(ParseEncoding("utf-8"), Encoding::kUtf8);
  EXPECT_FALSE(ParseEncoding("latin1"));
}

}  // namespace
}  // namespace vm
