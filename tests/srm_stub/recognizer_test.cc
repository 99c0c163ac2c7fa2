#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "srm_stub/recognizer_module.h"
#include "tests/support/process.h"

namespace srm_stub {
namespace {

using Lines = std::vector<std::string>;

TEST(ScriptTest, LinesAreReadInOrderOfTime) {
  const auto script = ParseScript("# talk\n500 second one\r\n\n 100\tfirst\n500 third");
  ASSERT_TRUE(script);
  ASSERT_EQ(script->size(), 3u);
  EXPECT_EQ((*script)[0].text, "first");
  EXPECT_EQ((*script)[1].text, "second one");
  EXPECT_EQ((*script)[1].number, 2u);
  for (const char* bad : {"x hello", "100", "-5 hello", "100hello", "99999999999999999999 x"}) {
    const auto wrong = ParseScript(std::string("\n") + bad);
    ASSERT_FALSE(wrong) << bad;
    EXPECT_TRUE(wrong.error().text.starts_with("line 2 ")) << wrong.error().text;
  }
}

class RecognizerTest : public testing::Test {
 protected:
  vm::VirtualScheduler clock_;
  std::map<std::string, std::string> files_;
  RecognizerModule module_{
      clock_,
      {.module_version = "test",
       .read_file = [this](const std::string& path) -> vm::Result<std::string> {
         const auto found = files_.find(path);
         if (found != files_.end()) return found->second;
         return vm::Fail(vm::Errc::kUnavailable, "no file '" + path + "'");
       }}};
  Lines said_;
  Lines errors_;

  RecognizerTest() {
    module_.slots().set_output([this](vm::PeerId, const vm::Message& message) {
      said_.push_back(std::to_string(clock_.Now().count() / 1000) + " " +
                      vm::FormatMessage(message));
    });
    module_.slots().set_on_error([this](vm::PeerId, const std::string&, const vm::Error& error) {
      errors_.push_back(vm::FormatError(error));
    });
  }
  void Tell(const std::string& line) { module_.slots().HandleLine(line, 1); }
  void UntilIdle() { clock_.RunUntilIdle(clock_.Now() + std::chrono::hours(1)); }
  Lines Said() { return std::exchange(said_, {}); }
};

TEST_F(RecognizerTest, TextIsHeardAtOnceByDefault) {
  Tell("set Run = START");
  Tell("set#1 Input.text = Hello there");
  EXPECT_EQ(
      Said(),
      (Lines{"0 rep Run = START", "0 rep Listen.stat = LISTENING", "0 rep Listen.stat = SPEECH",
             "0 rep Result.grammar = ", "0 rep Result.tag = ", "0 rep Result = Hello there",
             "0 rep#1 Input.text = Hello there", "0 rep Listen.stat = LISTENING"}));
  EXPECT_FALSE(module_.Busy());
}

TEST_F(RecognizerTest, WordsTakeTimeAndArePartialResults) {
  Tell("set Grammar.load = greet hello [there] {HI}");
  Tell("set Grammar = greet");
  Tell("set Listen = START");
  Tell("set Input.wordtime = 250");
  Said();
  Tell("set Input.text = Hello there");
  EXPECT_TRUE(module_.Busy());
  UntilIdle();
  EXPECT_EQ(Said(), (Lines{"0 rep Listen.stat = SPEECH", "250 rep Result.partial = Hello",
                           "500 rep Result.partial = Hello there", "500 rep Result.grammar = greet",
                           "500 rep Result.tag = HI", "500 rep Result = Hello there",
                           "500 rep Listen.stat = LISTENING"}));
  EXPECT_FALSE(module_.Busy());
}

TEST_F(RecognizerTest, ASoundIsKeptAsLongAsItWasAndReportedBeforeTheResult) {
  support::TempDir folder;
  Tell("set Listen.keep = " + (folder / "missing"));
  EXPECT_EQ(std::exchange(errors_, {}),
            Lines{"BAD_VALUE '" + (folder / "missing") + "' is no folder"});
  Tell("set Listen.keep = " + folder.path());
  Tell("set Run = START");
  Said();
  Tell("set Input.sound = 1500");
  UntilIdle();
  const std::string first = folder / "utterance-1.wav";
  EXPECT_EQ(Said(), (Lines{"0 rep Listen.stat = SPEECH",
                           "1500 rep Result.sound = 1500 48044 WHOLE " + first,
                           "1500 rep NoMatch = ", "1500 rep Listen.stat = LISTENING"}));
  EXPECT_EQ(std::filesystem::file_size(first), 48044u);
  Tell("set Listen.keep = NONE");
  Tell("set Input.text = three words long");
  for (const std::string& line : Said()) EXPECT_EQ(line.find("sound"), std::string::npos) << line;
}

TEST_F(RecognizerTest, ATooLongUtteranceIsCutWithTheWordsSaidSoFar) {
  support::TempDir folder;
  Tell("set Listen.keep = " + folder.path());
  Tell("set Listen.longest = 600");
  Tell("set Input.wordtime = 250");
  Tell("set Run = START");
  Said();
  Tell("set Input.text = one two three");
  UntilIdle();
  EXPECT_EQ(Said()[3], "600 rep Result.sound = 600 19244 CUT " + (folder / "utterance-1.wav"));
  EXPECT_EQ(module_.slots().Value("Result"), "one two");
}

TEST_F(RecognizerTest, AnUtteranceCanBeEndedFromOutside) {
  Tell("set Listen.end = NOW");  // nothing is being said: nothing happens
  Tell("set Input.wordtime = 250");
  Tell("set Run = START");
  Said();
  Tell("set#1 Input.text = one two three");
  Tell("set#2 Input.text = next");
  clock_.RunUntil(vm::Time(300'000));
  Said();
  Tell("set#3 Listen.end = NOW");
  Tell("set#4 Listen.end = NOW");  // the next one has not begun
  const Lines said = Said();
  EXPECT_EQ(said[2], "300 rep Result = one");
  EXPECT_EQ(said[3], "300 rep#1 Input.text = one");
  EXPECT_EQ(said[5], "300 rep#3 Listen.end = NOW");
  UntilIdle();
  EXPECT_EQ(module_.slots().Value("Result"), "next");
}

TEST_F(RecognizerTest, OnlySoManySoundsAreKeptAndTheOldestGo) {
  support::TempDir folder;
  Tell("set Listen.keep = " + folder.path());
  Tell("set Run = START");
  for (std::size_t i = 0; i <= ear::SoundKeep::kMaxFiles; ++i) Tell("set Input.text = a");
  EXPECT_FALSE(std::filesystem::exists(folder / "utterance-1.wav"));
  EXPECT_TRUE(std::filesystem::exists(folder / "utterance-2.wav"));
  EXPECT_TRUE(std::filesystem::exists(folder / "utterance-257.wav"));
}

TEST_F(RecognizerTest, WhatFitsNoActiveGrammarIsNoMatch) {
  Tell("set Grammar.load = a one");
  Tell("set Grammar.load = b two {2} | one {other}");
  Tell("set Run = START");
  Tell("set Grammar = b a");
  Said();
  Tell("set Input.text = three");
  EXPECT_EQ(Said()[1], "0 rep NoMatch = three");
  Tell("set Input.text = one");
  EXPECT_EQ(Said()[2], "0 rep Result.tag = other") << "the first grammar named goes first";
  Tell("set Input.text =");
  EXPECT_EQ(Said()[1], "0 rep NoMatch = ");
  Tell("set Grammar = NONE");
  Tell("set Input.text = three");
  EXPECT_EQ(Said()[4], "0 rep Result = three");
}

TEST_F(RecognizerTest, XmlComesToThoseWhoAskAndIsEscaped) {
  Tell("prop Result.xml = AutoOutput");
  Tell("set Run = START");
  clock_.RunUntil(vm::Time(40'000));
  Said();
  Tell("set Input.text = a < b & \"c\"");
  EXPECT_EQ(
      Said()[3],
      "40 rep Result.xml = <result start=\"40\" end=\"40\"><candidate rank=\"1\" "
      "confidence=\"1\" grammar=\"\" tag=\"\">a &lt; b &amp; &quot;c&quot;</candidate></result>");
}

TEST_F(RecognizerTest, SilenceIsReportedOnce) {
  Tell("set Listen.timeout = 3000");
  Tell("set Run = START");
  UntilIdle();
  EXPECT_EQ(Said().back(), "3000 rep NoInput = 3000");
  EXPECT_EQ(clock_.pending(), 0u);
  Tell("set Input.text = hi");  // a result starts the wait anew
  Said();
  UntilIdle();
  EXPECT_EQ(Said(), Lines{"6000 rep NoInput = 3000"});
}

TEST_F(RecognizerTest, NothingIsHeardWhileNotListening) {
  Tell("set#1 Input.text = hello");
  EXPECT_EQ(Said(), Lines{"0 rep#1 Input.text.error = BUSY not listening; set Run = START first"});
}

TEST_F(RecognizerTest, StopDropsWhatIsBeingHeard) {
  Tell("set Run = START");
  Tell("set Input.wordtime = 100");
  Tell("set#1 Input.text = one two three");
  Tell("set#2 Input.text = four");
  clock_.RunUntil(vm::Time(150'000));
  Said();
  Tell("set Run = STOP");
  EXPECT_EQ(Said(), (Lines{"150 rep Run = STOP",
                           "150 rep#1 Input.text.error = STOPPED listening was stopped",
                           "150 rep#2 Input.text.error = STOPPED listening was stopped",
                           "150 rep Listen.stat = OFF"}));
  EXPECT_EQ(clock_.pending(), 0u);
}

TEST_F(RecognizerTest, FurtherTextsWaitTheirTurn) {
  Tell("set Run = START");
  Tell("set Input.wordtime = 100");
  for (std::size_t i = 0; i < kMaxQueuedInputs; ++i) Tell("set Input.text = w" + std::to_string(i));
  Said();
  Tell("set#9 Input.text = too many");
  EXPECT_NE(Said().at(0).find("rep#9 Input.text.error = LIMIT"), std::string::npos);
  UntilIdle();
  const Lines lines = Said();
  EXPECT_EQ(std::count_if(lines.begin(), lines.end(),
                          [](const auto& l) { return l.find(" rep Result = ") != l.npos; }),
            static_cast<long>(kMaxQueuedInputs));
  EXPECT_EQ(lines[lines.size() - 2], "6400 rep Result = w63");
}

TEST_F(RecognizerTest, AScriptSpeaksOnTime) {
  files_["talk"] = "200 yes\n1000 no way\n";
  Tell("set Run = START");
  Tell("set Input.wordtime = 50");
  Said();
  Tell("set#1 Input.script = talk");
  EXPECT_TRUE(module_.Busy());
  UntilIdle();
  const Lines lines = Said();
  EXPECT_EQ(lines[0], "0 rep#1 Input.script = talk");
  EXPECT_NE(std::find(lines.begin(), lines.end(), "250 rep Result = yes"), lines.end());
  EXPECT_NE(std::find(lines.begin(), lines.end(), "1100 rep Result = no way"), lines.end());
  EXPECT_FALSE(module_.Busy());
  Tell("inq Input.script");
  EXPECT_EQ(Said(), Lines{"1100 rep Input.script = STOP"});
}

TEST_F(RecognizerTest, AScriptCanBeStoppedAndItsUnheardLinesAreNamed) {
  files_["talk"] = "200 yes\n1000 no\n";
  Tell("set Input.script = talk");
  clock_.RunUntil(vm::Time(500'000));
  ASSERT_EQ(errors_.size(), 1u);
  EXPECT_EQ(errors_[0], "BUSY line 1: not listening; set Run = START first");
  Tell("set Input.script = STOP");
  EXPECT_EQ(clock_.pending(), 0u);
  EXPECT_FALSE(module_.Busy());
  Tell("set#1 Input.script = nowhere");
  EXPECT_NE(Said().back().find("rep#1 Input.script.error = UNAVAILABLE"), std::string::npos);
}

TEST_F(RecognizerTest, GrammarsAreLoadedListedAndDropped) {
  files_["g"] = "# colours\nred {R}\r\n\ngreen\n";
  Tell("set Grammar.file = colours g");
  Tell("set Grammar.load = yn yes | no");
  Tell("set Grammar = colours yn colours");
  EXPECT_EQ(Said(), Lines{"0 rep Grammar = colours yn"});
  Tell("inq Grammar.set");
  EXPECT_EQ(Said(), Lines{"0 rep Grammar.set = colours yn"});
  Tell("set Grammar.drop = colours");
  EXPECT_EQ(Said(), Lines{"0 rep Grammar = yn"});
  for (const char* bad :
       {"set#1 Grammar = colours", "set#1 Grammar.drop = colours", "set#1 Grammar.load = x",
        "set#1 Grammar.load = NONE a", "set#1 Grammar.load = x (a", "set#1 Grammar ="}) {
    Tell(bad);
    EXPECT_NE(Said().at(0).find(".error = "), std::string::npos) << bad;
  }
  Tell("inq Grammar");
  EXPECT_EQ(Said(), Lines{"0 rep Grammar = yn"});
}

TEST(SrmStubProgramTest, ADialogueOverAPipe) {
  support::Process program({std::string(GALATEA_BIN_DIR) + "/srm_stub"});
  EXPECT_EQ(program.ReadLine(), "rep Run = LIVE");
  program.Write("set Grammar.load = yn yes | no\nset Grammar = yn\nset Run = START\n");
  EXPECT_TRUE(program.Expect("rep Listen.stat = LISTENING"));
  program.WriteLine("set Input.wordtime = 20");
  program.WriteLine("set Input.text = Yes.");
  EXPECT_TRUE(program.Expect("rep Result.partial = Yes."));
  EXPECT_TRUE(program.Expect("rep Result = Yes."));
  program.CloseInput();
  EXPECT_EQ(program.Wait(), 0);
}

}  // namespace
}  // namespace srm_stub
