#include "vm_protocol/core/message.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "vm_protocol/core/limits.h"

namespace vm {
namespace {

Message Parsed(std::string_view line) {
  const auto message = ParseMessage(line);
  EXPECT_TRUE(message) << line << ": " << (message ? "" : message.error().text);
  return message.value_or(Message{});
}

Error Refused(std::string_view line) {
  const auto message = ParseMessage(line);
  EXPECT_FALSE(message) << line;
  return message ? Error{} : message.error();
}

TEST(MessageTest, ReadsTheLinesOfTheOriginalsPrograms) {
  EXPECT_EQ(Parsed("set Speak = NOW"), Set("Speak", "NOW"));
  EXPECT_EQ(Parsed("inq Speak.stat"), Inq("Speak.stat"));
  EXPECT_EQ(Parsed("to @FSM set FaceExp = HAPPY 1 100 0"),
            To("FSM", Set("FaceExp", "HAPPY 1 100 0")));
  const Message rep = Parsed("From @SSM rep Speak.stat = IDLE");
  EXPECT_EQ(rep.from, "SSM");
  EXPECT_EQ(rep.command, Command::kRep);
  EXPECT_EQ(Parsed("tell Speak.sync = 1000"), Tell("Speak.sync = 1000"));
  EXPECT_EQ(Parsed("prop Text.pho = AutoOutput").command, Command::kProp);
}

TEST(MessageTest, AByteOrderMarkBeforeALineIsPassedOver) {
  const auto message = ParseMessage("\xEF\xBB\xBFinq#1 Run");
  ASSERT_TRUE(message);
  EXPECT_EQ(FormatMessage(*message), "inq#1 Run");
}

TEST(MessageTest, TheTagOfALineThatIsNoMessageIsFound) {
  for (const char* line : {"foo#7 x", "to @FSM foo#7 x", "To @A,@B set#7",
                           "\xEF\xBB\xBF"
                           "foo#7",
                           "to set#7 X = 1", "from @A foo#7"})
    EXPECT_EQ(TagOf(line), "7") << line;
  for (const char* line : {"", "foo", "hello foo#7", "a b c foo#7", "#7", "foo#", "foo# x"})
    EXPECT_EQ(TagOf(line), "") << line;
}

TEST(MessageTest, ReadsLooselyWhatTheOriginalReadLoosely) {
  EXPECT_EQ(Parsed("set Speak=NOW"), Set("Speak", "NOW"));
  EXPECT_EQ(Parsed("\tset\tSpeak\t=\tNOW\r"), Set("Speak", "NOW"));
  EXPECT_EQ(Parsed("TO @A FROM @B set X = 1").from, "B");
}

TEST(MessageTest, TakesSeveralReceiversWithAndWithoutTheirAtSign) {
  const std::vector<std::string> both{"SSM", "FSM"};
  EXPECT_EQ(Parsed("to @SSM,@FSM set Speak = STOP").to, both);
  EXPECT_EQ(Parsed("To @SSM,FSM set Speak = STOP").to, both);
  EXPECT_EQ(Parsed("to @SSM, @FSM set Speak = STOP").to, both);
}

TEST(MessageTest, AModuleOfAnotherAgentIsNamedWithItsAgent) {
  EXPECT_EQ(Parsed("to @LOBBY/FSM,@SSM set X = 1").to,
            (std::vector<std::string>{"LOBBY/FSM", "SSM"}));
  Message rep = Rep("X", "1");
  rep.from = "LOBBY/FSM";
  EXPECT_EQ(FormatMessage(rep), "From @LOBBY/FSM rep X = 1");
  EXPECT_EQ(Parsed("From @LOBBY/FSM rep X = 1"), rep);
  EXPECT_TRUE(IsValid(rep));
  for (const char* line : {"to @/FSM set X = 1", "to @LOBBY/ set X = 1", "to @A/B/C set X = 1"})
    EXPECT_EQ(Refused(line).code, Errc::kSyntax) << line;
  EXPECT_FALSE(IsModuleName("LOBBY/FSM")) << "no module can take such a name";
}

TEST(MessageTest, KnowsTagsRelationsAndBothOrdersOfIdentifiers) {
  const Message message = Parsed("from @A to @B set#r-17 Text << more");
  EXPECT_EQ(message.from, "A");
  EXPECT_EQ(message.tag, "r-17");
  EXPECT_EQ(message.relation, Relation::kAppend);
  EXPECT_EQ(message.value, "more");
  EXPECT_EQ(Parsed("set Text < a.txt").relation, Relation::kFromFile);
}

TEST(MessageTest, KeepsTheValueToTheEndOfTheLineAsItIs) {
  EXPECT_EQ(Parsed("set Text =   a = b  #c ").value, "a = b  #c ");
  EXPECT_EQ(Parsed("set Text = \"x\\n\"").value, "\"x\\n\"");
  EXPECT_EQ(Parsed("set Text =").value, "");
  EXPECT_EQ(Parsed("set Text = こんにちは。").value, "こんにちは。");
}

TEST(MessageTest, RunsFilesAndMacrosByDo) {
  EXPECT_EQ(Parsed("do greet").slot, "greet");
  const Message file = Parsed("do /tmp/some file.txt");
  EXPECT_EQ(file.slot, "");
  EXPECT_EQ(file.value, "/tmp/some file.txt");
}

TEST(MessageTest, BlankLinesAndCommentsAreNothing) {
  for (const auto* line : {"", "   ", "\t\r", "# note", "  # note"}) {
    EXPECT_EQ(Refused(line).code, Errc::kEmpty) << line;
  }
}

struct BadLine {
  const char* line;
  Errc code;
  std::size_t column;
  const char* part;
};

class BadLineTest : public testing::TestWithParam<BadLine> {};

TEST_P(BadLineTest, IsRefusedWithItsColumnWhatWasFoundAndWhatWasExpected) {
  const BadLine& bad = GetParam();
  const Error error = Refused(bad.line);
  EXPECT_EQ(error.code, bad.code) << error.text;
  EXPECT_EQ(error.column, bad.column) << error.text;
  EXPECT_NE(error.text.find(bad.part), std::string::npos) << error.text;
  EXPECT_NE(error.text.find("expected"), std::string::npos) << error.text;
}

INSTANTIATE_TEST_SUITE_P(
    Lines, BadLineTest,
    testing::Values(BadLine{"speak now", Errc::kUnknownCommand, 1, "'speak'"},
                    BadLine{"SET X = 1", Errc::kUnknownCommand, 1, "'SET'"},
                    BadLine{"to FSM set X = 1", Errc::kSyntax, 4, "'FSM'"},
                    BadLine{"to @ set X = 1", Errc::kSyntax, 4, "'@'"},
                    BadLine{"to @A;@B set X = 1", Errc::kSyntax, 6, "';@B'"},
                    BadLine{"to @A to @B set X = 1", Errc::kSyntax, 7, "second 'to'"},
                    BadLine{"to @A", Errc::kSyntax, 6, "end of the line"},
                    BadLine{"set", Errc::kSyntax, 4, "end of the line"},
                    BadLine{"set X", Errc::kSyntax, 6, "'= VALUE'"},
                    BadLine{"set X 1", Errc::kSyntax, 7, "'1'"},
                    BadLine{"set .X = 1", Errc::kSyntax, 5, "slot name"},
                    BadLine{"set X. = 1", Errc::kSyntax, 5, "slot name"},
                    BadLine{"set A..B = 1", Errc::kSyntax, 5, "slot name"},
                    BadLine{"set A/B = 1", Errc::kSyntax, 6, "'/B'"},
                    BadLine{"del X = 1", Errc::kSyntax, 7, "takes no value"},
                    BadLine{"rest X y", Errc::kSyntax, 8, "'y'"},
                    BadLine{"inq X=1", Errc::kSyntax, 6, "takes no value"},
                    BadLine{"set# X = 1", Errc::kSyntax, 4, "tag"},
                    BadLine{"set#a!b X = 1", Errc::kSyntax, 4, "'a!b'"},
                    BadLine{"tell", Errc::kSyntax, 5, "text"},
                    BadLine{"set X = \xff", Errc::kBadUtf8, 9, "UTF-8"},
                    BadLine{"set X = \xed\xa0\x80", Errc::kBadUtf8, 9, "UTF-8"},
                    BadLine{"set X = \xc0\x80", Errc::kBadUtf8, 9, "UTF-8"}));

TEST(MessageTest, RefusesWhatIsOverTheLimits) {
  EXPECT_EQ(Refused("set X = " + std::string(kMaxLineBytes, 'a')).code, Errc::kTooLong);
  EXPECT_TRUE(ParseMessage("set X = " + std::string(kMaxLineBytes - 8, 'a')));
  EXPECT_EQ(Refused("set " + std::string(kMaxNameBytes + 1, 'a') + " = 1").code, Errc::kSyntax);
  std::string many = "to @A";
  for (std::size_t i = 0; i < kMaxReceivers; ++i) many += ",@A";
  EXPECT_EQ(Refused(many + " set X = 1").code, Errc::kLimit);
  EXPECT_EQ(Refused(std::string("set X = a\0b", 11)).code, Errc::kSyntax);
}

TEST(MessageTest, WritesExactlyAsTheOriginal) {
  EXPECT_EQ(FormatMessage(Rep("Speak.stat", "IDLE")), "rep Speak.stat = IDLE");
  Message routed = Rep("Speak.stat", "IDLE");
  routed.from = "SSM";
  EXPECT_EQ(FormatMessage(routed), "From @SSM rep Speak.stat = IDLE");
  EXPECT_EQ(FormatMessage(Tell("Speak.sync = 1000")), "tell Speak.sync = 1000");
}

/// Makes random messages over the whole grammar, valid by construction.
class MessageMaker {
 public:
  explicit MessageMaker(unsigned seed) : random_(seed) {}

  Message Make() {
    Message message;
    for (auto n = Below(4); n > 0; --n) message.to.push_back(Name(12));
    if (Below(2) == 0) message.from = Name(12);
    message.command = static_cast<Command>(Below(10));
    if (Below(3) == 0) message.tag = Tag();
    switch (message.command) {
      case Command::kTell:
        message.value = "t" + Text();
        return message;
      case Command::kInq:
      case Command::kDel:
      case Command::kRest:
        message.slot = Slot();
        return message;
      case Command::kSet:
      case Command::kProp:
      case Command::kRep:
        message.relation = static_cast<Relation>(1 + Below(3));
        break;
      default:
        message.relation = static_cast<Relation>(Below(4));
    }
    if (message.command == Command::kDo && Below(2) == 0) {
      message.relation = Relation::kNone;
      message.value = "/" + Text();
      return message;
    }
    message.slot = Slot();
    if (message.relation != Relation::kNone) message.value = Text();
    while (!message.value.empty() && (message.value[0] == ' ' || message.value[0] == '\t')) {
      message.value.erase(0, 1);
    }
    return message;
  }

 private:
  std::size_t Below(std::size_t n) { return random_() % n; }
  std::string Name(std::size_t most) {
    static constexpr std::string_view kLetters = "abcXYZ019_-";
    std::string name;
    for (std::size_t n = 1 + Below(most); n > 0; --n) name += kLetters[Below(kLetters.size())];
    if (Below(8) == 0) name += "顔";
    return name;
  }
  std::string Tag() {
    std::string tag(1 + Below(kMaxTagBytes), 'q');
    return tag;
  }
  std::string Slot() {
    std::string slot = Name(6);
    for (auto n = Below(3); n > 0; --n) slot += "." + Name(4);
    return slot;
  }
  std::string Text() {
    static constexpr std::string_view kPieces[] = {" ",   "=",     "<",  "<<", "#",  "@",
                                                   "a",   "to @X", "あ", "\t", "\"", "\\",
                                                   "set", "1.5",   "é",  "😀",  "./", "from"};
    std::string text;
    for (auto n = Below(12); n > 0; --n) text += kPieces[Below(std::size(kPieces))];
    return text;
  }
  std::mt19937 random_;
};

TEST(MessageTest, ParsingIsTheInverseOfFormattingForEveryValidMessage) {
  MessageMaker maker(20021101);
  for (int i = 0; i < 20000; ++i) {
    const Message message = maker.Make();
    ASSERT_TRUE(IsValid(message)) << FormatMessage(message);
    const std::string line = FormatMessage(message);
    const auto back = ParseMessage(line);
    ASSERT_TRUE(back) << line << ": " << back.error().text;
    ASSERT_EQ(*back, message) << line;
  }
}

TEST(MessageTest, WhateverIsReadIsValidAndReadsTheSameAgain) {
  std::mt19937 random(7);
  static constexpr std::string_view kBytes = "seti nqprop=<#@.,to\tfrom AB1\"\\\xe3\x81\x82";
  int read = 0;
  for (int i = 0; i < 50000; ++i) {
    std::string line = i % 2 == 0 ? "set " : "";
    for (auto n = random() % 24; n > 0; --n) line += kBytes[random() % kBytes.size()];
    const auto message = ParseMessage(line);
    if (!message) continue;
    ++read;
    ASSERT_TRUE(IsValid(*message)) << line;
    ASSERT_EQ(ParseMessage(FormatMessage(*message)), message) << line;
  }
  EXPECT_GT(read, 100) << "the lines made must be readable often enough to mean something";
}

TEST(MessageTest, AnErrorNeverCutsACharacterInHalf) {
  const Error error = Refused(std::string("x") + "ああああああああああああああああああああ 1");
  EXPECT_TRUE(ParseMessage("tell " + error.text)) << "the error's text must itself be UTF-8";
}

}  // namespace
}  // namespace vm
