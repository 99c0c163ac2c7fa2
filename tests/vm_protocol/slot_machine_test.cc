#include "vm_protocol/core/slot_machine.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "vm_protocol/core/limits.h"
#include "vm_protocol/core/module.h"
#include "vm_protocol/core/utf8.h"

namespace vm {
namespace {

using Strings = std::vector<std::string>;

/// A machine with a few slots, and everything it says as "peer:line".
class SlotMachineTest : public testing::Test {
 protected:
  SlotMachineTest() : slots_("FSM") {
    slots_.set_output([this](PeerId peer, const Message& message) {
      said_.push_back(std::to_string(peer) + ":" + FormatMessage(message));
    });
    slots_.set_on_error(
        [this](PeerId, const std::string&, const Error& error) { errors_.push_back(error); });
    slots_.Declare({.name = "Volume",
                    .grammar = "<number 0..200>",
                    .initial = "100",
                    .help = "Loudness in %."});
    slots_.Declare({.name = "State",
                    .grammar = "<text>",
                    .access = Access::kReadOnly,
                    .initial = "IDLE",
                    .auto_output = true,
                    .help = "What it does."});
    slots_.Declare({.name = "Play",
                    .grammar = "NOW | STOP",
                    .access = Access::kWriteOnly,
                    .help = "Starts and stops.",
                    .on_set = [this](const SetValue& value) -> Result<std::string> {
                      if (value.word(0) == "NOW" && slots_.Value("State") != "IDLE") {
                        return Fail(Errc::kBusy, "already playing, expected STOP first");
                      }
                      slots_.Report("State", value.word(0) == "NOW" ? "PLAYING" : "IDLE");
                      return value.word(0);
                    }});
    slots_.Declare({.name = "Mask",
                    .grammar = "<word>",
                    .initial = "anna",
                    .help = "The face.",
                    .quoted = true});
    slots_.Declare({.name = "Later",
                    .grammar = "<text>",
                    .access = Access::kWriteOnly,
                    .help = "Answers later.",
                    .on_set_later = [this](const SetValue&, const Reply& reply) {
                      replies_.push_back(reply);
                    }});
  }

  Strings Say(std::string_view line, PeerId peer = 1) {
    said_.clear();
    slots_.HandleLine(line, peer);
    return said_;
  }

  SlotMachine slots_;
  Strings said_;
  std::vector<Error> errors_;
  std::vector<Reply> replies_;
};

TEST_F(SlotMachineTest, ASetIsSilentAndAnInqSaysTheValue) {
  EXPECT_EQ(Say("set Volume = 50"), Strings{});
  EXPECT_EQ(Say("inq Volume"), Strings{"1:rep Volume = 50"});
  EXPECT_EQ(Say("inq Mask"), Strings{"1:rep Mask = \"anna\""});
}

TEST_F(SlotMachineTest, AutoOutputReportsChangesToEveryone) {
  EXPECT_EQ(Say("set Play = now"), Strings{"0:rep State = PLAYING"});
  Say("prop State = NoAutoOutput");
  EXPECT_EQ(Say("set Play = STOP"), Strings{});
  Say("prop Volume = AutoOutput");
  EXPECT_EQ(Say("set Volume = 10"), Strings{"0:rep Volume = 10"});
}

TEST_F(SlotMachineTest, EveryTaggedRequestIsAnsweredOnceWithItsTag) {
  EXPECT_EQ(Say("set#7 Volume = 50"), Strings{"1:rep#7 Volume = 50"});
  EXPECT_EQ(Say("inq#8 Volume"), Strings{"1:rep#8 Volume = 50"});
  EXPECT_EQ(Say("prop#9 Volume = AutoOutput"), Strings{"1:rep#9 Volume = AutoOutput"});
  EXPECT_EQ(
      Say("set#a Volume = 999"),
      Strings{"1:rep#a Volume.error = BAD_VALUE column 1: found '999', expected <number 0..200>"});
  EXPECT_EQ(Say("inq#b Nose"), Strings{"1:rep#b Nose.error = UNKNOWN_SLOT module FSM has no slot "
                                       "'Nose' (inq Slots lists them)"});
}

TEST_F(SlotMachineTest, ARefusalWithoutTagIsReportedOnlyToThoseWhoAskedForErrors) {
  EXPECT_EQ(Say("set Volume = x"), Strings{});
  ASSERT_EQ(errors_.size(), 1u);
  EXPECT_EQ(errors_[0].code, Errc::kBadValue);
  Say("prop Error = AutoOutput", 2);
  EXPECT_EQ(Say("set Volume = x", 1), Strings{}) << "not the asker's business of peer 2";
  EXPECT_EQ(Say("set Volume = x", 2).size(), 1u);
  EXPECT_EQ(
      Say("nonsense", 2),
      Strings{
          "2:rep Error = UNKNOWN_COMMAND column 1: found 'nonsense', expected one of set inq prop "
          "save rest del def do rep tell"});
  slots_.PeerGone(2);
  EXPECT_EQ(Say("set Volume = x", 2), Strings{});
}

TEST_F(SlotMachineTest, AccessIsKept) {
  EXPECT_EQ(Say("set#1 State = X"),
            Strings{"1:rep#1 State.error = ACCESS slot 'State' can only be asked (inq)"});
  EXPECT_EQ(Say("inq#2 Play"), Strings{"1:rep#2 Play.error = ACCESS slot 'Play' can only be set"});
  EXPECT_EQ(Say("prop#3 State = Loud"), Strings{"1:rep#3 State.error = BAD_VALUE column 1: found "
                                                "'Loud', expected AutoOutput or NoAutoOutput"});
}

TEST_F(SlotMachineTest, ARefusedActionChangesNothing) {
  Say("set Play = NOW");
  EXPECT_EQ(Say("set#1 Play = NOW"),
            Strings{"1:rep#1 Play.error = BUSY already playing, expected STOP first"});
  EXPECT_EQ(slots_.Value("State"), "PLAYING");
}

TEST_F(SlotMachineTest, AnAnswerMayComeLaterAndComesOnce) {
  EXPECT_EQ(Say("set#5 Later = x", 3), Strings{});
  ASSERT_EQ(replies_.size(), 1u);
  said_.clear();
  replies_[0].Ok("done");
  replies_[0].Fail({Errc::kInternal, "again", 0});
  EXPECT_EQ(said_, Strings{"3:rep#5 Later = done"});
}

TEST(ReplyTest, AReplyMayOutliveItsMachine) {
  std::optional<Reply> kept;
  {
    SlotMachine slots("X");
    slots.Declare({.name = "Later",
                   .grammar = "<text>",
                   .access = Access::kWriteOnly,
                   .on_set_later = [&](const SetValue&, const Reply& reply) { kept = reply; }});
    slots.HandleLine("set#1 Later = x");
  }
  ASSERT_TRUE(kept);
  kept->Ok("too late");
}

TEST_F(SlotMachineTest, ListsAndExplainsItself) {
  EXPECT_EQ(Say("inq Slots"),
            Strings{"1:rep Slots = Slots Slots.files Error Volume State Play Mask Later"});
  EXPECT_EQ(Say("inq Volume.help"),
            Strings{"1:rep Volume.help = Loudness in %. Value: <number 0..200>"});
  EXPECT_EQ(Say("inq Volume.prop"),
            Strings{"1:rep Volume.prop = NoAutoOutput ReadWrite default 100"});
  EXPECT_NE(slots_.DocsMarkdown().find("| `Play` | `NOW \\| STOP` | WriteOnly | off |"),
            std::string::npos);
}

TEST_F(SlotMachineTest, AGroupListsItsMembersAndIsReachedByProp) {
  slots_.Declare({.name = "All",
                  .grammar = "<text>",
                  .access = Access::kWriteOnly,
                  .help = "Both.",
                  .group = {"Volume", "Mask"}});
  EXPECT_EQ(Say("inq All"), (Strings{"1:rep Volume = 100", "1:rep Mask = \"anna\""}));
  EXPECT_EQ(Say("inq#4 All"),
            (Strings{"1:rep#4 Volume = 100", "1:rep#4 Mask = \"anna\"", "1:rep#4 All = "}));
  Say("prop All = AutoOutput");
  EXPECT_EQ(Say("set Mask = bob"), Strings{"0:rep Mask = \"bob\""});
}

TEST_F(SlotMachineTest, ShortcutsStandForWholeLines) {
  slots_.AddShortcut("o", "set Play = NOW");
  EXPECT_EQ(Say("o"), Strings{"0:rep State = PLAYING"});
}

TEST_F(SlotMachineTest, WhatItSaysAlwaysFitsALine) {
  slots_.Report("State", std::string(2 * kMaxLineBytes, 'x'));
  ASSERT_EQ(said_.size(), 1u);
  EXPECT_LE(said_[0].size(), kMaxLineBytes + 2) << "two bytes of it are the test's";
}

TEST_F(SlotMachineTest, ReportsOfOthersAreNotForIt) {
  EXPECT_EQ(Say("rep Volume = 1"), Strings{});
  EXPECT_EQ(Say("From @SSM tell hello"), Strings{});
  EXPECT_EQ(slots_.Value("Volume"), "100");
}

TEST_F(SlotMachineTest, EveryModuleHasTheCommonSlots) {
  bool ended = false;
  DeclareCommonSlots(slots_, {.module_version = "V 1",
                              .protocol_version = "P 2",
                              .quoted_versions = true,
                              .auto_output = true,
                              .on_exit = [&] { ended = true; }});
  EXPECT_EQ(Say("inq ModuleVersion"), Strings{"1:rep ModuleVersion = \"V 1\""});
  EXPECT_EQ(Say("inq Run"), Strings{"1:rep Run = LIVE"});
  EXPECT_EQ(Say("set#1 Run = EXIT"), (Strings{"0:rep Run = EXIT", "1:rep#1 Run = EXIT"}));
  EXPECT_TRUE(ended);
  EXPECT_EQ(Say("set#2 Run = INIT")[0].substr(0, 34), "1:rep#2 Run.error = BAD_VALUE colu");
}

TEST_F(SlotMachineTest, AModuleThatWorksIsStartedAndStoppedByRun) {
  bool broken = true;
  int stops = 0;
  DeclareCommonSlots(slots_, {.on_start = [&]() -> Result<void> {
                                if (broken) return Fail(Errc::kUnavailable, "no camera");
                                return {};
                              },
                              .on_stop = [&] { ++stops; },
                              .work = "sound is heard"});
  EXPECT_EQ(Say("set#1 Run = START"), Strings{"1:rep#1 Run.error = UNAVAILABLE no camera"});
  EXPECT_EQ(slots_.Value("Run"), "LIVE");
  broken = false;
  EXPECT_EQ(Say("set#2 Run = START"), Strings{"1:rep#2 Run = START"});
  EXPECT_EQ(Say("set#3 Run = SLEEP"), Strings{"1:rep#3 Run = LIVE"});
  EXPECT_EQ(slots_.Value("Run"), "START");
  EXPECT_EQ(stops, 0);
  EXPECT_EQ(Say("set#4 Run = STOP"), Strings{"1:rep#4 Run = STOP"});
  EXPECT_EQ(stops, 1);
}

TEST_F(SlotMachineTest, SaysWhichOfItsSlotsTakeFiles) {
  EXPECT_EQ(Say("inq Slots.files"), Strings{"1:rep Slots.files = "});
  slots_.Declare({.name = "Save", .grammar = "<file> | STOP", .access = Access::kWriteOnly});
  slots_.Declare({.name = "Log", .grammar = "<file>", .access = Access::kReadOnly});
  slots_.Declare({.name = "Film", .grammar = "<int> <file>"});
  EXPECT_EQ(Say("inq Slots.files"),
            Strings{"1:rep Slots.files = Save <file> | STOP; Film <int> <file>"});
}

TEST_F(SlotMachineTest, ALongAnswerEndsBetweenTwoSignsAndLeavesRoomForAHub) {
  std::string kana;
  while (kana.size() < 2 * kMaxLineBytes) kana += "あ";
  slots_.Report("State", kana);
  ASSERT_EQ(said_.size(), 1u);
  const std::string line = said_[0].substr(2);
  EXPECT_FALSE(FirstBadUtf8(line));
  EXPECT_LE(line.size() + std::string("From @ ").size() + kMaxModuleNameBytes, kMaxLineBytes);
  EXPECT_TRUE(ParseMessage(line));
}

TEST_F(SlotMachineTest, WhatIsNoTextIsNeverSaid) {
  slots_.Report("State", "a\r\nb\xff");
  EXPECT_EQ(said_, Strings{"0:rep State = a  b\xef\xbf\xbd"});
}

TEST_F(SlotMachineTest, ATaggedLineThatCannotBeReadIsAnsweredWithItsTag) {
  EXPECT_EQ(Say("set#7 Volume 50"),
            Strings{"1:rep#7 Error = SYNTAX column 14: found '50', expected '=', '<' or '<<'"});
  EXPECT_EQ(Say("to @A inq#x_1 a b").size(), 1u);
  EXPECT_EQ(Say("sett#7 Volume = 50").size(), 1u);
  EXPECT_EQ(Say("sett Volume#7 = 50"), Strings{}) << "no command, no tag";
}

TEST_F(SlotMachineTest, AMistypedSlotIsGuessed) {
  slots_.Declare({.name = "HeadRotAbs.1", .grammar = "<number>"});
  EXPECT_EQ(Say("inq#1 HeadRotAbs"), Strings{"1:rep#1 HeadRotAbs.error = UNKNOWN_SLOT module FSM "
                                             "has no slot 'HeadRotAbs', did you mean "
                                             "'HeadRotAbs.1'?"});
  EXPECT_NE(Say("inq#1 volum")[0].find("did you mean 'Volume'?"), std::string::npos);
}

TEST_F(SlotMachineTest, AValueInPlaceOfASlotIsGuessed) {
  slots_.Declare({.name = "FaceMot", .grammar = "NOD | BLINK <int 1..>"});
  EXPECT_EQ(Say("set#1 Blnik = 1"), Strings{"1:rep#1 Blnik.error = UNKNOWN_SLOT module FSM has no "
                                            "slot 'Blnik', did you mean 'FaceMot = BLINK'?"});
  EXPECT_NE(Say("inq#1 Blizzard")[0].find("(inq Slots lists them)"), std::string::npos);
}

TEST_F(SlotMachineTest, ABlankAtTheEndIsPartOfTextsOnly) {
  Say("set Mask = bob \t");
  EXPECT_EQ(Say("inq Mask"), Strings{"1:rep Mask = \"bob\""});
  Say("def T = a b ");
  EXPECT_EQ(Say("inq T"), Strings{"1:rep T = a b "});
}

TEST_F(SlotMachineTest, WhatUsersKeepIsBounded) {
  const std::string much(60'000, 'x');
  std::string refused;
  for (int i = 0; i < 400 && refused.empty(); ++i) {
    for (const std::string& line : {"def#1 U" + std::to_string(i) + " = " + much,
                                    "def#1 M << tell " + much, "save#1 S" + std::to_string(i)}) {
      const Strings said = Say(line);
      if (refused.empty() && said[0].find(".error = LIMIT") != std::string::npos) refused = line;
    }
  }
  EXPECT_NE(refused, "");
  for (int i = 0; i < 400; ++i) {
    Say("del U" + std::to_string(i));
    Say("del S" + std::to_string(i));
  }
  Say("del M");
  EXPECT_EQ(Say("def#1 U = 1"), Strings{"1:rep#1 U = 1"}) << "what was deleted counts no longer";
  Say("set U = " + much);
  EXPECT_NE(Say("set#1 U << " + much)[0].find("TOO_LONG"), std::string::npos);
}

TEST_F(SlotMachineTest, TheWayOutIsHeldByTheGate) {
  std::vector<std::function<void()>> held;
  slots_.set_exit_gate([&](std::function<void()> exit) { held.push_back(std::move(exit)); });
  DeclareCommonSlots(slots_, {.auto_output = true});
  EXPECT_EQ(Say("set#1 Run = exit"), Strings{});
  ASSERT_EQ(held.size(), 1u);
  held[0]();
  EXPECT_EQ(said_, (Strings{"0:rep Run = EXIT", "1:rep#1 Run = EXIT"}));
}

}  // namespace
}  // namespace vm
