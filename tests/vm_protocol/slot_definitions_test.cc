#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "vm_protocol/core/limits.h"
#include "vm_protocol/core/slot_machine.h"

namespace vm {
namespace {

using Strings = std::vector<std::string>;

/// A machine with two slots and a world of files in memory.
class DefinitionsTest : public testing::Test {
 protected:
  DefinitionsTest() : slots_("M") {
    slots_.set_output(
        [this](PeerId, const Message& message) { said_.push_back(FormatMessage(message)); });
    slots_.set_on_error(
        [this](PeerId, const std::string&, const Error& error) { errors_.push_back(error); });
    slots_.set_read_file([this](const std::string& path) -> Result<std::string> {
      const auto found = files_.find(path);
      if (found == files_.end()) return Fail(Errc::kUnavailable, "cannot read '" + path + "'");
      return found->second;
    });
    slots_.set_append_file(
        [this](const std::string& path, const std::string& text) -> Result<void> {
          files_[path] += text;
          return {};
        });
    slots_.Declare({.name = "A", .grammar = "<number>", .initial = "1"});
    slots_.Declare({.name = "B", .grammar = "<text>", .initial = "x"});
    slots_.Declare({.name = "Act", .grammar = "GO", .access = Access::kWriteOnly});
  }
  Strings Say(std::string_view line) {
    said_.clear();
    slots_.HandleLine(line);
    return said_;
  }
  Errc LastError() { return errors_.empty() ? Errc::kEmpty : errors_.back().code; }

  SlotMachine slots_;
  std::map<std::string, std::string> files_;
  Strings said_;
  std::vector<Error> errors_;
};

TEST_F(DefinitionsTest, NamesThatAreReservedAreLeftToTheModule) {
  slots_.Reserve("Module.");
  EXPECT_EQ(Say("def#1 Module.X.state = y"),
            (Strings{"rep#1 Module.X.state.error = ACCESS slot 'Module.X.state' cannot be defined: "
                     "names that begin with 'Module.' are the module's own"}));
  slots_.Declare({.name = "Module.X.state", .grammar = "<text>"});
  EXPECT_EQ(Say("def#2 Modules = y"), (Strings{"rep#2 Modules = y"}));
}

TEST_F(DefinitionsTest, SaveKeepsAndRestBringsBack) {
  EXPECT_EQ(Say("save#1 calm"), Strings{"rep#1 calm = 2 slots"});
  Say("set A = 5");
  Say("set B = y");
  EXPECT_EQ(Say("rest#2 calm"), Strings{"rep#2 calm = 2 slots"});
  EXPECT_EQ(slots_.Value("A"), "1");
  EXPECT_EQ(slots_.Value("B"), "x");
  Say("rest nothing");
  EXPECT_EQ(LastError(), Errc::kUnknownSlot);
}

TEST_F(DefinitionsTest, InitialValuesComeBackAndUsersKeepTheirs) {
  Say("def Own = 3");
  Say("set A = 5");
  Say("set B = y");
  Say("set C = z");
  slots_.StoreInitialValues();
  EXPECT_EQ(slots_.Value("A"), "1");
  EXPECT_EQ(slots_.Value("B"), "x");
  EXPECT_EQ(slots_.Value("Own"), "3");
  EXPECT_NE(slots_.Value("Error"), "") << "what was refused is still told";
}

TEST_F(DefinitionsTest, SaveTakesAListOfSlots) {
  Say("save only = A");
  Say("set A = 5");
  Say("set B = y");
  Say("rest only");
  EXPECT_EQ(slots_.Value("A"), "1");
  EXPECT_EQ(slots_.Value("B"), "y");
  Say("save bad = A Act");
  EXPECT_EQ(LastError(), Errc::kAccess);
  Say("save bad = Z");
  EXPECT_EQ(LastError(), Errc::kUnknownSlot);
}

TEST_F(DefinitionsTest, SaveToAFileIsBroughtBackByDo) {
  Say("save calm << state.txt");
  Say("set A = 5");
  Say("do state.txt");
  EXPECT_EQ(slots_.Value("A"), "1");
}

TEST_F(DefinitionsTest, DefMakesSlotsAndDelRemovesThem) {
  Say("def Mood = calm");
  EXPECT_EQ(Say("inq Mood"), Strings{"rep Mood = calm"});
  Say("prop Mood = AutoOutput");
  EXPECT_EQ(Say("set Mood = wild"), Strings{"rep Mood = wild"});
  EXPECT_EQ(Say("del#1 Mood"), Strings{"rep#1 Mood = deleted"});
  Say("inq Mood");
  EXPECT_EQ(LastError(), Errc::kUnknownSlot);
  Say("def A = 2");
  EXPECT_EQ(LastError(), Errc::kAccess);
  Say("del A");
  EXPECT_EQ(LastError(), Errc::kAccess);
}

TEST_F(DefinitionsTest, MacrosAreLinesAppendedAndRun) {
  Say("def up << set A = 7");
  Say("def up << set B = high");
  EXPECT_EQ(Say("do#1 up"), Strings{"rep#1 up = 2 lines"});
  EXPECT_EQ(slots_.Value("A"), "7");
  EXPECT_EQ(slots_.Value("B"), "high");
  Say("def up << speak loudly");
  EXPECT_EQ(LastError(), Errc::kUnknownCommand);
  Say("del up");
  Say("do up");
  EXPECT_EQ(LastError(), Errc::kUnavailable) << "neither a macro nor a file any more";
}

TEST_F(DefinitionsTest, AMacroMayComeFromAFile) {
  files_["m.txt"] = "# comment\nset A = 3\n\nset B = from file\n";
  Say("def m < m.txt");
  Say("do m");
  EXPECT_EQ(slots_.Value("B"), "from file");
  files_["bad.txt"] = "set A = 3\nset\n";
  Say("def n < bad.txt");
  ASSERT_FALSE(errors_.empty());
  EXPECT_NE(errors_.back().text.find("line 2 of macro 'n'"), std::string::npos)
      << errors_.back().text;
}

TEST_F(DefinitionsTest, AMacroThatCallsItselfEnds) {
  Say("def loop << do loop");
  Say("def loop << do loop");
  Say("do loop");
  EXPECT_EQ(LastError(), Errc::kLimit);
  Say("set A = 9");
  EXPECT_EQ(slots_.Value("A"), "9");
}

TEST_F(DefinitionsTest, ValuesComeFromFilesAndAreAppended) {
  files_["t.txt"] = "one\r\ntwo\n";
  Say("set B < t.txt");
  EXPECT_EQ(slots_.Value("B"), "one two");
  Say("set B << three");
  EXPECT_EQ(slots_.Value("B"), "one two three");
  Say("set B < none.txt");
  EXPECT_EQ(LastError(), Errc::kUnavailable);
  files_["big.txt"] = std::string(kMaxLineBytes + 1, 'x');
  Say("set B < big.txt");
  EXPECT_EQ(LastError(), Errc::kTooLong);
}

TEST_F(DefinitionsTest, UserSlotsAndSavedSetsAreLimited) {
  for (std::size_t i = 0; i <= kMaxUserSlots; ++i) Say("def U" + std::to_string(i) + " = 1");
  EXPECT_EQ(LastError(), Errc::kLimit);
  errors_.clear();
  for (std::size_t i = 0; i <= kMaxSavedSets; ++i) Say("save S" + std::to_string(i) + " = A");
  EXPECT_EQ(LastError(), Errc::kLimit);
}

TEST_F(DefinitionsTest, AModuleMayTakeDefinitionsItself) {
  Strings taken;
  slots_.set_definition_hook([&](const Message& message, PeerId, const Reply& reply) {
    if (!message.slot.starts_with("Exp")) return false;
    taken.push_back(message.slot);
    reply.Ok("mine");
    return true;
  });
  EXPECT_EQ(Say("def#1 Exp.Wink = 46L 1"), Strings{"rep#1 Exp.Wink = mine"});
  Say("def Other = 1");
  EXPECT_EQ(taken, Strings{"Exp.Wink"});
  EXPECT_TRUE(slots_.Has("Other"));
}

}  // namespace
}  // namespace vm
