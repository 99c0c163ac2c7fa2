// Every slot, and any order of commands.

#include <algorithm>
#include <random>

#include "tests/ssm/voice_suite.h"

namespace ssm_test {
namespace {

class VoiceSlotsTest : public VoiceSuite {};
INSTANTIATE_TEST_SUITE_P(Engines, VoiceSlotsTest, AllEngines(), EngineName);

TEST_P(VoiceSlotsTest, ExitIsReportedAndAskedFor) {
  world_.Tell("set Run = EXIT");
  EXPECT_EQ(world_.Lines(), Lines{"rep Run = EXIT"});
  EXPECT_TRUE(world_.module->ExitRequested());
}

TEST_P(VoiceSlotsTest, EverySlotExplainsItself) {
  std::string names = world_.Ask("Slots");
  for (const char* original : {"Run",
                               "ModuleVersion",
                               "ProtocolVersion",
                               "SpeakerSet",
                               "Speaker",
                               "Alpha",
                               "Postfilter",
                               "Text",
                               "Text.text",
                               "Text.pho",
                               "Text.dur",
                               "Speak",
                               "Speak.text",
                               "Speak.pho",
                               "Speak.dur",
                               "Speak.utt",
                               "Speak.len",
                               "Speak.stat",
                               "Speak.syncinterval",
                               "SaveRAW",
                               "Save",
                               "SaveWAV",
                               "LoadRAW",
                               "SpeechFile",
                               "LoadWAV",
                               "SavePros",
                               "LoadPros",
                               "ProsFile",
                               "ParsedText",
                               "AutoPlay",
                               "AutoPlayDelay",
                               "Log",
                               "Log.conf",
                               "Log.text",
                               "Log.arrangedText",
                               "Log.chasen",
                               "Log.tag",
                               "Log.phoneme",
                               "Log.mora",
                               "Log.morph",
                               "Log.aphrase",
                               "Log.breath",
                               "Log.sentence",
                               "Err"}) {
    EXPECT_TRUE(world_.module->slots().Has(original)) << original;
    world_.Tell(std::string("inq ") + original + ".help");
    const Lines lines = world_.Lines();
    ASSERT_EQ(lines.size(), 1u) << original;
  }
}

TEST_P(VoiceSlotsTest, AnyOrderOfCommandsEndsIdleWithEveryRequestAnsweredOnce) {
  const char* commands[] = {"Text = Hello there.",
                            "Text = a",
                            "Speak = NOW",
                            "Speak = +70",
                            "Speak = STOP",
                            "Speak = @200",
                            "Rate = 1.5",
                            "Speaker = awb",
                            "AutoPlay = YES",
                            "AutoPlay = NO",
                            "Speak.syncinterval = 90",
                            "Text ="};
  std::mt19937 random(7);
  for (int round = 0; round < 30; ++round) {
    VoiceWorld world(GetParam().make());
    for (int i = 0; i < 40; ++i) {
      world.Tell("set#t" + std::to_string(i) + " " + commands[random() % std::size(commands)]);
      world.Pass(static_cast<double>(random() % 4) * 40);
    }
    world.UntilIdle();
    EXPECT_FALSE(world.module->Busy());
    const std::string stat = world.Ask("Speak.stat");
    EXPECT_TRUE(stat == "IDLE" || stat == "READY") << stat;
    std::size_t speaking = 0, idle = 0;
    for (int i = 0; i < 40; ++i) {
      const std::string tag = "rep#t" + std::to_string(i) + " ";
      EXPECT_EQ(std::count_if(world.said.begin(), world.said.end(),
                              [&](const Said& said) { return said.line.starts_with(tag); }),
                1);
    }
    for (const Said& said : world.said) {
      speaking += said.line == "rep Speak.stat = SPEAKING";
      idle += said.line == "rep Speak.stat = IDLE";
    }
    EXPECT_GE(idle, speaking);
  }
}

}  // namespace
}  // namespace ssm_test
