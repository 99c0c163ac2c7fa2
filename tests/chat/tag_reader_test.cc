#include "chat/text/tag_reader.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "chat/tables/tables.h"

namespace chat {
namespace {

const TagTable& ShippedTags() {
  static const TagTable table = *TagTable::Parse("tags.txt", tables::Tags());
  return table;
}

/// The text with each cue as {its lines}, fed in pieces of so many bytes.
std::string Read(const std::string& text, std::size_t piece) {
  TagReader reader(ShippedTags());
  std::string read;
  const auto take = [&read](const std::vector<TagReader::Item>& items) {
    for (const auto& item : items) {
      if (const auto* const words = std::get_if<std::string>(&item)) {
        read += *words;
        continue;
      }
      for (const vm::Message& message : std::get<Cue>(item))
        read += "{" + vm::FormatMessage(message) + "}";
    }
  };
  for (std::size_t at = 0; at < text.size(); at += piece) take(reader.Feed(text.substr(at, piece)));
  take(reader.Flush());
  return read;
}

void ExpectRead(const std::string& text, const std::string& expected) {
  for (const std::size_t piece : {std::size_t{1}, std::size_t{2}, std::size_t{5}, text.size() + 1})
    EXPECT_EQ(Read(text, piece), expected) << text << " in pieces of " << piece;
}

TEST(TagReaderTest, OfAnyWordOnlyPlainOnesGetIntoACommand) {
  ExpectRead("Good. [end kyoto]", "Good. {to @CHAT set Talk = END kyoto}");
  ExpectRead("Good. [end 京都]", "Good. {to @CHAT set Talk = END 京都}");
  ExpectRead("Good. [end]", "Good. {to @CHAT set Talk = END -}");
  ExpectRead("Good. <end result=\"a b\"/>", "Good. ");
  ExpectRead("Good. [end a|b]", "Good. ");
  ExpectRead("Good. [end " + std::string(65, 'x') + "]", "Good. ");
}

TEST(TagReaderTest, TagsBecomeCommandsHoweverTheStreamIsCut) {
  ExpectRead("[happy] Hi", "{to @AM-MCL set Emotion = HAPPY 80} Hi");
  ExpectRead("a <emotion name=\"SAD\" strength='30'/> b", "a {to @AM-MCL set Emotion = SAD 30} b");
  ExpectRead("[emotion HAPPY 60][nod/]",
             "{to @AM-MCL set Emotion = HAPPY 60}{to @FSM set FaceMot = NOD 1}");
  ExpectRead("[HAPPY: 40%] x", "{to @AM-MCL set Emotion = HAPPY 40} x");
  ExpectRead("<emotion name=happy>x</emotion>",
             "{to @AM-MCL set Emotion = HAPPY 80}x{to @AM-MCL set Emotion = NEUTRAL}");
}

TEST(TagReaderTest, NumbersAreTakenToTheirLimitsAndOtherValuesDropTheTag) {
  ExpectRead("[sad 900]", "{to @AM-MCL set Emotion = SAD 100}");
  ExpectRead("[sad -5]", "{to @AM-MCL set Emotion = SAD 0}");
  ExpectRead("[sad nan][sad 1e999][emotion HUNGRY][emotion]x", "x");
  ExpectRead("<emotion name=\"HAPPY 1\" strength=\"1 to @AM set Run = EXIT\"/>x", "x");
}

TEST(TagReaderTest, UnknownTagsAreNeverSpoken) {
  ExpectRead("a[laughs softly]b<br/>c<script src=\"x>y\">d[12]e</div>", "abcde");
  ExpectRead("<!-- no -->x", "x");
}

TEST(TagReaderTest, WhatIsNoTagIsText) {
  ExpectRead("3 < 4 and [ 5", "3 < 4 and [ 5");
  ExpectRead("<unclosed", "<unclosed");
  ExpectRead("[a\nb]", "[a\nb]");
  const std::string long_one = "[" + std::string(TagReader::kMaxTagBytes, 'a') + "]";
  ExpectRead(long_one, long_one);
  ExpectRead(std::string(1000, '['), std::string(1000, '['));
}

TEST(TagReaderTest, LinksLeaveTheirWords) {
  ExpectRead("See [our page](http://x.y/z) now", "See our page now");
  ExpectRead("[happy](smiles)", "{to @AM-MCL set Emotion = HAPPY 80}(smiles)");
}

TEST(TagReaderTest, ThoughtsAreNotForTheListener) {
  ExpectRead("<think>He asks. [happy] <b>Hm</b></think>Yes.", "Yes.");
  ExpectRead("<think>never closed", "");
}

TEST(TagTableTest, FaultsNameFileAndLine) {
  for (const char* const wrong :
       {"x", "x | set Y = 1", "x | nonsense", "x y | to @A set B = 1", "x y: | to @A set B = 1",
        "x y:2..1 | to @A set B = 1", "x y:A,B=C | to @A set B = 1", "at NIGHT | to @A set B = 1",
        "a | to @A set B = 1\na | to @A set B = 1"}) {
    const auto table = TagTable::Parse("my.txt", std::string("# head\n") + wrong);
    ASSERT_FALSE(table) << wrong;
    EXPECT_TRUE(table.error().text.starts_with("my.txt:")) << table.error().text;
  }
}

TEST(TagTableTest, TheShippedPromptAsksOnlyForTagsThatAreThere) {
  const std::string_view prompt = tables::Prompt();
  int count = 0;
  for (std::size_t at = prompt.find('['); at != std::string_view::npos;
       at = prompt.find('[', at + 1)) {
    const std::string_view inside = prompt.substr(at + 1, prompt.find(']', at) - at - 1);
    EXPECT_TRUE(ShippedTags().CueOf(ParseTag(inside))) << inside;
    ++count;
  }
  EXPECT_GT(count, 10);
}

TEST(TagTableTest, StatesKnowTheFacesLife) {
  const Cue speaks = ShippedTags().AtState("SPEAKS", "LIVELY");
  ASSERT_EQ(speaks.size(), 2u);
  EXPECT_EQ(vm::FormatMessage(speaks[1]), "to @FSM set Life = LIVELY");
  EXPECT_TRUE(ShippedTags().AtState("SLEEPS", "").empty());
}

}  // namespace
}  // namespace chat
