#include "vm_protocol/runtime/encoding.h"

#include <gtest/gtest.h>

#include "vm_protocol/core/charset.h"

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

// 髙 (FB FC) and ① (87 40) are signs of IBM and NEC, which plain Shift_JIS lacks; ｱ is B1.
TEST(EncodingTest, ShiftJisMeansTheSupersetOfPcs) {
  EXPECT_EQ(ToUtf8("\xfb\xfc\x87\x40\xb1", Encoding::kShiftJis), "髙①ｱ");
  EXPECT_EQ(FromUtf8("髙①ｱ", Encoding::kShiftJis), "\xfb\xfc\x87\x40\xb1");
  EXPECT_EQ(DecodeCharset("\x87\x40", "Shift_JIS"), "①");
}

TEST(EncodingTest, ACharsetWithStatesIsLeftInItsFirst) {
  EXPECT_EQ(EncodeCharset("あ", "ISO-2022-JP"), "\x1b$B$\"\x1b(B");
  EXPECT_EQ(DecodeCharset("\x1b$B$\"\x1b(B", "ISO-2022-JP"), "あ");
  EXPECT_EQ(DecodeCharset("x", "bogus").error().code, Errc::kBadValue);
  EXPECT_EQ(DecodeCharset("\xa4", "EUC-JP").error().code, Errc::kBadUtf8) << "half a character";
}

TEST(EncodingTest, ALineThatIsNotUtf8IsRecognisedByWhatItWouldSay) {
  for (const auto* text : {"set Text = こんにちは", "set Text = 今日は、いい天気です。",
                           "set Text = カタカナ", "set Text = 東京", "rep Voice = 男性１"}) {
    for (const Encoding encoding : {Encoding::kEucJp, Encoding::kShiftJis}) {
      const std::string line = FromUtf8(text, encoding);
      EXPECT_EQ(RecogniseEncoding(line), encoding) << text;
    }
  }
  for (const auto* garbage : {"\xff\xfe", "set Text = \x80", "a\xa0", "\xfd\xfd\xfd"})
    EXPECT_EQ(RecogniseEncoding(garbage), Encoding::kUtf8) << "none of them";
}

TEST(EncodingTest, APeerIsRememberedInTheEncodingItSpokeFirst) {
  PeerEncoding original(Encoding::kUtf8);
  EXPECT_TRUE(original.IsPlain("inq Run"));
  EXPECT_FALSE(original.IsPlain("def A = \xa4\xa2"));
  EXPECT_EQ(original.Read("def A = \xa4\xa2"), "def A = あ");
  EXPECT_EQ(original.encoding(), Encoding::kEucJp);
  EXPECT_FALSE(original.IsPlain("inq A"));

  PeerEncoding modern(Encoding::kUtf8);
  EXPECT_TRUE(modern.IsPlain("def A = あ"));
  EXPECT_TRUE(modern.IsPlain("def A = \xa4\xa2")) << "one bad line does not change it";
  EXPECT_EQ(modern.encoding(), Encoding::kUtf8);
}

}  // namespace
}  // namespace vm
