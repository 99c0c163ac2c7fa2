// Values, tags, words and marks, and what a client may choose.

#include "tests/ssm/voice_suite.h"

namespace ssm_test {
namespace {

class VoiceValuesTest : public VoiceSuite {};
INSTANTIATE_TEST_SUITE_P(Engines, VoiceValuesTest, AllEngines(), EngineName);

TEST_P(VoiceValuesTest, BadValuesAreRefusedAndChangeNothing) {
  Prepare();
  const struct {
    const char* line;
    const char* code;
  } cases[] = {{"set#1 Speak = SOON", "BAD_VALUE"},
               {"set#1 Speak = +-5", "BAD_VALUE"},
               {"set#1 Speak = @", "BAD_VALUE"},
               {"set#1 Speak = 25:61:00", "BAD_VALUE"},
               {"set#1 Speak = NOW please", "BAD_VALUE"},
               {"set#1 Speaker = nobody", "BAD_VALUE"},
               {"set#1 Speaker =", "BAD_VALUE"},
               {"set#1 Rate = 0", "BAD_VALUE"},
               {"set#1 Rate = nan", "BAD_VALUE"},
               {"set#1 Rate = fast", "BAD_VALUE"},
               {"set#1 Pitch = 3", "BAD_VALUE"},
               {"set#1 Volume = -1", "BAD_VALUE"},
               {"set#1 Speak.syncinterval = -1", "BAD_VALUE"},
               {"set#1 AutoPlay = MAYBE", "BAD_VALUE"},
               {"set#1 Alpha = 0.5", "UNAVAILABLE"},
               {"set#1 Postfilter = 0.3", "UNAVAILABLE"},
               {"set#1 ProsFile = x", "UNAVAILABLE"},
               {"set#1 SavePros = /nowhere/x", "UNAVAILABLE"},
               {"set#1 ParsedText = x", "UNAVAILABLE"},
               {"set#1 Log.chasen = YES", "UNAVAILABLE"},
               {"set#1 Err = /tmp/x", "UNAVAILABLE"},
               {"set#1 SaveWAV = /nowhere/x.wav", "UNAVAILABLE"},
               {"set#1 SaveRAW = /nowhere/x.raw", "UNAVAILABLE"},
               {"set#1 LoadWAV = /nowhere/x.wav", "UNAVAILABLE"},
               {"set#1 Record = /nowhere/x.wav", "UNAVAILABLE"},
               {"set#1 Log = /nowhere/x.log", "UNAVAILABLE"},
               {"set#1 Text.pho = a[10]", "ACCESS"},
               {"set#1 Speak.stat = IDLE", "ACCESS"},
               {"inq#1 Speak", "ACCESS"},
               {"inq#1 Text", "ACCESS"}};
  for (const auto& one : cases) {
    world_.Tell(one.line);
    const Lines lines = world_.Lines();
    ASSERT_EQ(lines.size(), 1u) << one.line;
    EXPECT_NE(lines[0].find(std::string(".error = ") + one.code + " "), std::string::npos)
        << one.line << " -> " << lines[0];
  }
  EXPECT_EQ(world_.Ask("Speak.stat"), "READY");
}

TEST_P(VoiceValuesTest, ATextWithNothingToSayIsAShortPause) {
  for (const char* text : {"", "   ", "\t", "<EMPH></EMPH>"}) {
    world_.Tell(std::string("set Text = ") + text);
    EXPECT_EQ(world_.Ask("Text.pho"), "pau[10]") << "'" << text << "'";
    EXPECT_EQ(world_.Ask("Text.dur"), "10");
    world_.Tell("set Speak = NOW");
    world_.UntilIdle();
    EXPECT_EQ(world_.Ask("Speak.stat"), "IDLE");
    EXPECT_EQ(world_.Ask("Speak.len"), "10");
  }
  for (const char* text : {"!!!", "...", "\xF0\x9F\x98\x80", "—"}) {
    world_.Tell(std::string("set Text = ") + text);
    EXPECT_EQ(world_.Ask("Speak.stat"), "READY") << text;
    EXPECT_TRUE(world_.Ask("Text.pho").starts_with("pau[")) << text;
  }
}

TEST_P(VoiceValuesTest, AnEmptyTextIsSaidToBeOneAndASilentOneIsNot) {
  const auto told = [this](const std::string& text) {
    world_.errors.clear();
    world_.Tell("set Text = " + text);
    return world_.errors;
  };
  const std::vector<std::string> empty = {"UNAVAILABLE the text is empty, there is nothing to say"};
  EXPECT_EQ(told(""), empty);
  EXPECT_EQ(told("   "), empty);
  EXPECT_EQ(told("<speak> </speak>"), empty);
  EXPECT_EQ(told("<SILENCE MSEC=\"50\"/>"), std::vector<std::string>{});
  EXPECT_EQ(told("yes"), std::vector<std::string>{});
}

TEST_P(VoiceValuesTest, EmojiAreNotSpokenAndNoError) {
  const auto phonemes = [this](const std::string& text) {
    world_.errors.clear();
    world_.Tell("set Text = " + text);
    EXPECT_EQ(world_.errors, std::vector<std::string>{}) << text;
    return world_.Ask("Text.pho");
  };
  const std::string plain = phonemes("I love it!");
  for (const char* text : {"I love it 😀!", "😀 I love it!", "I love it! 😀", "I love it❤️!",
                           "I love it!👩‍👩‍👧‍👦👍🏽",
                           "I ✨love it! 🇯🇵🏴󠁧󠁢󠁥󠁮󠁧󠁿", "I ❤ love it!"}) {
    EXPECT_EQ(phonemes(text), plain) << text;
  }
  for (const char* text : {"😀", "👍🏽 🇯🇵", "❤️"})
    EXPECT_EQ(phonemes(text), "pau[10]") << text;
  EXPECT_EQ(phonemes("no 1️⃣"), phonemes("no 1")) << "the figure of a keycap is spoken";
}

TEST_P(VoiceValuesTest, ATextOverTheLimitIsTooLong) {
  world_.Tell("set#1 Text = " + std::string(ssm::kMaxTextBytes + 1, 'a'));
  EXPECT_TRUE(world_.Lines().at(0).starts_with("rep#1 Text.error = TOO_LONG "));
  EXPECT_EQ(world_.Ask("Speak.stat"), "IDLE");
}

TEST_P(VoiceValuesTest, SilenceTagsTakeTheirTime) {
  const long plain = Prepare("One. Two.");
  const long longer = Prepare("<SILENCE MSEC=\"700\"/>One. Two.<SILENCE MSEC=\"300\"/>");
  EXPECT_EQ(longer, plain + 1000);
}

TEST_P(VoiceValuesTest, RateChangesTheDurationFromTheNextTextOn) {
  const double plain = static_cast<double>(Prepare());
  world_.Tell("set Rate = 2");
  EXPECT_EQ(world_.Lines(), Lines{"rep Rate = 2"});
  EXPECT_NEAR(static_cast<double>(Prepare()), plain / 2, plain * 0.1);
  world_.Tell("set Rate = 0.5");
  EXPECT_NEAR(static_cast<double>(Prepare()), plain * 2, plain * 0.2);
}

TEST_P(VoiceValuesTest, SpeakersOfTheOriginalAreAccepted) {
  EXPECT_EQ(world_.Ask("SpeakerSet"), "slt rms awb kal16 male01 female01 male02");
  for (const char* name : {"male01", "female01", "male02", "slt", "rms", "awb", "kal16"}) {
    world_.Tell(std::string("set Speaker = ") + name);
    EXPECT_EQ(world_.Lines(), Lines{std::string("rep Speaker = ") + name});
    EXPECT_GT(Prepare("Hello."), 100);
  }
}

TEST_P(VoiceValuesTest, SyncComesAtTheIntervalChosen) {
  const long dur = Prepare();
  world_.Tell("set Speak.syncinterval = 0");
  EXPECT_EQ(world_.Lines(), Lines{"rep Speak.syncinterval = 0"});
  world_.Tell("set Speak = NOW");
  world_.UntilIdle();
  EXPECT_EQ(world_.When("tell"), -1);
  world_.Tell("set Speak.syncinterval = 250");
  world_.Lines();
  world_.Tell("set Speak = NOW");
  world_.Pass(600);
  world_.Tell("set Speak.syncinterval = 400");  // in the middle
  world_.UntilIdle();
  Lines ticks;
  for (const std::string& line : world_.Lines()) {
    if (line.starts_with("tell")) ticks.push_back(line);
  }
  ASSERT_GE(dur, 1300);
  ASSERT_GE(ticks.size(), 4u);
  EXPECT_EQ(Lines(ticks.begin(), ticks.begin() + 4),
            (Lines{"tell Speak.sync = 250", "tell Speak.sync = 500", "tell Speak.sync = 800",
                   "tell Speak.sync = 1200"}));
}

TEST_P(VoiceValuesTest, AutoOutputCanBeSwitchedOffByTheSlot) {
  for (const char* slot : {"Speak.utt", "Text.text", "Speak.text", "Speak.pho", "Speak.dur"}) {
    world_.Tell(std::string("prop ") + slot + " = NoAutoOutput");
  }
  world_.Tell("prop Text = NoAutoOutput");  // as in the original, this silences nothing
  world_.Tell("set Text = Hello.");
  const std::string pho = world_.Ask("Text.pho"), dur = world_.Ask("Text.dur");
  EXPECT_EQ(world_.Lines(), (Lines{"rep Speak.stat = PROCESSING", "rep Text.pho = " + pho,
                                   "rep Text.dur = " + dur, "rep Speak.stat = READY"}));
}

TEST_P(VoiceValuesTest, WordsAndMarksComeToThoseWhoAsk) {
  world_.Tell("prop Speak.word = AutoOutput");
  world_.Tell("prop Speak.mark = AutoOutput");
  world_.Tell("set Text = Hello my <BOOKMARK MARK=\"here\"/>friend.");
  world_.Lines();
  world_.Tell("set Speak = NOW");
  world_.UntilIdle();
  Lines words, marks;
  for (const auto& said : world_.said) {
    if (said.line.starts_with("rep Speak.word = ")) {
      words.push_back(said.line);
      const auto blank = said.line.find(' ', 17);
      EXPECT_EQ(std::stod(said.line.substr(blank)), said.ms);
    }
    if (said.line.starts_with("rep Speak.mark = ")) marks.push_back(said.line);
  }
  ASSERT_EQ(words.size(), 3u);
  EXPECT_TRUE(words[2].ends_with(" friend") && words[2].starts_with("rep Speak.word = 3 "));
  ASSERT_EQ(marks.size(), 1u);
  EXPECT_TRUE(marks[0].starts_with("rep Speak.mark = here "));
}

TEST_P(VoiceValuesTest, SpokenWordsTellWhatTheListenerKnows) {
  Prepare("One two three four five six seven eight nine ten.");
  world_.Tell("prop Speak.word = AutoOutput");
  world_.Tell("set Speak = NOW");
  EXPECT_EQ(world_.Ask("Speak.spoken"), "");
  world_.Pass(1200);
  world_.Tell("set Speak = STOP");
  std::string begun;
  for (const Said& said : world_.said) {
    if (!said.line.starts_with("rep Speak.word = ")) continue;
    begun += (begun.empty() ? "" : " ") + said.line.substr(said.line.rfind(' ') + 1);
  }
  EXPECT_GE(std::count(begun.begin(), begun.end(), ' '), 2) << begun;
  EXPECT_EQ(world_.Ask("Speak.spoken"), begun);
}

TEST_P(VoiceValuesTest, AutoPlaySpeaksByItselfInTheOriginalsOrder) {
  world_.Tell("set AutoPlay = YES");
  world_.Tell("set AutoPlayDelay = 30");
  EXPECT_EQ(world_.Lines(), Lines{});
  world_.Tell("set Text = Hello.");
  const double dur = std::stod(world_.Ask("Text.dur"));
  EXPECT_EQ(world_.Ask("Speak.stat"), "SPEAKING");
  world_.UntilIdle();
  EXPECT_EQ(world_.When("rep Speak.stat = IDLE"), 30 + dur);
  const Lines lines = world_.Lines();
  ASSERT_GE(lines.size(), 12u);
  EXPECT_TRUE(lines[6].starts_with("rep Speak.dur"));
  EXPECT_EQ(lines[7], "rep Speak.stat = SPEAKING");
  EXPECT_EQ(lines[8], "rep Speak.stat = READY");
  EXPECT_EQ(std::count(lines.begin(), lines.end(), "rep Speak.stat = SPEAKING"), 1);
  EXPECT_EQ(lines.back(), "rep Speak.stat = IDLE");
}

TEST_P(VoiceValuesTest, TextCanBeAppendedTo) {
  world_.Tell("set Text = Hello");
  world_.Tell("set Text << there.");
  EXPECT_EQ(world_.Ask("Text.text"), "Hello there.");
}

}  // namespace
}  // namespace ssm_test
