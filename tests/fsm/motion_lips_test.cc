// The lips of speech: dominance curves, contacts, names of phonemes; and what a real head's mouth
// measures while it speaks.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "fsm/head/make_head.h"
#include "fsm/motion/face_motion.h"
#include "fsm/rig/head.h"
#include "tests/fsm/motion_support.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;

const MotionTables& Tables() {
  static const MotionTables tables = MotionTables::Load().value();
  return tables;
}
VisemeTrack Track28(const char* text) { return {List(text), Tables(), LipStyle{}}; }
const MouthPose& Shape(const char* name) {
  return FindViseme(Tables().set(VisemeSetId::k28).visemes, name)->pose;
}

TEST(DominanceTest, ALongVowelReachesAndHoldsItsShape) {
  const VisemeTrack track = Track28("pau 200 aa 300 pau 200");
  for (const double ms : {300.0, 350.0, 400.0}) {
    EXPECT_NEAR(track.At(ms).mouth[kJawY], Shape("aa").mouth[kJawY], 0.05) << ms;
  }
  EXPECT_NEAR(track.At(50).mouth[kJawY], 0, 0.05);
}

TEST(DominanceTest, EqualNeighboursHaveEqualSayWhereTheyMeet) {
  const VisemeTrack track = Track28("aa 200 eh 200");
  const double half = (Shape("aa").mouth[kJawY] + Shape("eh").mouth[kJawY]) / 2;
  EXPECT_NEAR(track.At(200).mouth[kJawY], half, 0.05);
}

TEST(DominanceTest, ShortSoundsAreUndershot) {
  const VisemeTrack slow = Track28("iy 150 aa 150 iy 150");
  const VisemeTrack quick = Track28("iy 30 aa 30 iy 30");
  EXPECT_NEAR(slow.At(225).mouth[kJawY], Shape("aa").mouth[kJawY], 0.3);
  EXPECT_LT(quick.At(45).mouth[kJawY], 0.8 * Shape("aa").mouth[kJawY]);
  EXPECT_GT(quick.At(45).mouth[kJawY], 1.3 * Shape("iy").mouth[kJawY]);
}

TEST(DominanceTest, RoundingIsAnticipatedFurtherThanOpening) {
  // Through the k, whose lips are its neighbours': uw rounds long before aa would open.
  const double way_uw = Shape("uw").mouth[kLowerOuterZ];
  const VisemeTrack round = Track28("iy 150 t 100 uw 150");
  EXPECT_GT(round.At(250 - 70).mouth[kLowerOuterZ], 0.15 * way_uw);
  const VisemeTrack open = Track28("iy 150 k 100 aa 150");
  const double from = open.At(250 - 70).mouth[kJawY];
  EXPECT_LT(from - Shape("k").mouth[kJawY], 0.1 * Shape("aa").mouth[kJawY]);
  EXPECT_GT(open.At(250 - 15).mouth[kJawY], from + 1);  // but it begins before its time
}

TEST(DominanceTest, TongueConsonantsTakeTheLipsOfTheirNeighbours) {
  const VisemeTrack wide = Track28("iy 120 k 60 iy 120");
  const VisemeTrack round = Track28("uw 120 k 60 uw 120");
  EXPECT_GT(wide.At(150).mouth[kCornerX], 1.5);
  EXPECT_LT(round.At(150).mouth[kCornerX], -2);
}

TEST(DominanceTest, AClosureIsCompleteFromThePhonemesStartForItsHold) {
  for (const int ms : {15, 25, 40, 60, 90, 150, 250}) {
    const vm::PhonemeList list = {{"aa", 90ms}, {"m", std::chrono::milliseconds(ms)}, {"aa", 90ms}};
    const VisemeTrack track(list, Tables(), LipStyle{});
    const double hold = std::min(kMinClosureMs, 0.85 * ms);
    for (double t = 90; t <= 90 + hold; t += 0.5) {
      ASSERT_FLOAT_EQ(track.At(t).seal, 1) << ms << " at " << t;
    }
    EXPECT_LT(track.At(90 - 30).seal, 0.7);  // and not long before
    EXPECT_LT(track.At(90 + std::max(ms, 40) + 20).seal, 0.01) << "gone after it";
  }
}

TEST(DominanceTest, NothingJumps) {
  std::mt19937 random(5);
  std::vector<std::string> names;
  for (const auto& [name, look] : Tables().set(VisemeSetId::k28).english) names.push_back(name);
  for (int run = 0; run < 50; ++run) {
    vm::PhonemeList list;
    for (int i = 0; i < 30; ++i) {
      list.push_back({names[random() % names.size()], std::chrono::milliseconds(random() % 200)});
    }
    const VisemeTrack track(list, Tables(), LipStyle{});
    MouthPose before = track.At(-200);
    for (double t = -200; t < track.length_ms() + 300; t += 1) {
      const MouthPose now = track.At(t);
      for (std::size_t p = 0; p < kMouthParameters; ++p) {
        ASSERT_TRUE(std::isfinite(now.mouth[p]));
        ASSERT_LT(std::abs(now.mouth[p] - before.mouth[p]), 1.6f) << p << " at " << t;
      }
      ASSERT_LT(std::abs(now.seal - before.seal), 0.2f) << "at " << t;
      before = now;
    }
    EXPECT_FLOAT_EQ(before.seal, 1);
    EXPECT_NEAR(before.mouth[kJawY], 0, 1e-3);
  }
}

TEST(DominanceTest, LipsMeetInPausesButNotInShortStops) {
  const VisemeTrack track = Track28("aa 100 pau 200 aa 100");
  EXPECT_FLOAT_EQ(track.At(200).seal, 1);
  const VisemeTrack stop(List("a 100 cl 70 a 100"), Tables(), LipStyle{});
  EXPECT_FLOAT_EQ(stop.At(135).seal, 0);
}

TEST(LipStyleTest, ScalesAreOfJawAndLipsAndLeaveClosuresClosed) {
  LipStyle shout;
  shout.jaw = 2;
  shout.lips = 0.5;
  const VisemeTrack plain = Track28("uw 300 m 100 aa 300");
  const VisemeTrack loud(List("uw 300 m 100 aa 300"), Tables(), shout);
  EXPECT_NEAR(loud.At(550).mouth[kJawY], 2 * plain.At(550).mouth[kJawY], 0.1);
  EXPECT_NEAR(loud.At(150).mouth[kCornerX], 0.5 * plain.At(150).mouth[kCornerX], 0.1);
  EXPECT_FLOAT_EQ(loud.At(320).seal, 1);
}

TEST(LipStyleTest, LinearModeGoesStraight) {
  LipStyle style;
  style.mode = LipMode::kLinear;
  const VisemeTrack track(List("aa 100 eh 100"), Tables(), style);
  EXPECT_NEAR(track.At(25).mouth[kJawY],
              0.75 * Shape("aa").mouth[kJawY] + 0.25 * Shape("eh").mouth[kJawY], 1e-4);
}

TEST(PhonemeNamesTest, TheListThatKnowsMostNamesTheLanguage) {
  const auto english = [](const char* text) {
    return VisemeFinder(List(text), Tables().set(VisemeSetId::k28), Tables().engines,
                        Language::kAuto, "")
               .language() == Language::kEnglish;
  };
  EXPECT_FALSE(english("pau 10 k 10 o 10 N 10 n 10 i 10 ch 10 i 10 w 10 a 10"));  // open_jtalk
  EXPECT_TRUE(english("pau 10 hh 10 ax 10 l 10 ow 10 pau 10"));                   // flite
  EXPECT_TRUE(english("SIL 10 HH 10 AH0 10 L 10 OW1 10 SIL 10"));                 // ARPAbet
  EXPECT_TRUE(english("_: 10 h 10 ə 10 l 10 oʊ 10"));                             // espeak-ng, IPA
  EXPECT_TRUE(english("_ 10 h 10 @ 10 l 10 oU 10 w 10 3: 10 l 10 d 10"));         // and its own
  EXPECT_FALSE(english("silB 10 k 10 o: 10 q 10 t 10 e 10 silE 10"));             // Julius
  EXPECT_FALSE(english("k 10 o̞ 10 ɴ 10 n 10 i 10 tɕ 10 i 10 w 10 ä 10"));
}

TEST(PhonemeNamesTest, EveryEnginesWordsMoveTheMouthAlike) {
  // "hello", by four engines.
  const double jaw = Track28("pau 100 hh 60 ax 80 l 60 ow 200 pau 100").At(270).mouth[kJawY];
  for (const char* text :
       {"SIL 100 HH 60 AH0 80 L 60 OW1 200 SIL 100", "_: 100 h 60 ə 80 l 60 oʊ 200 _: 100",
        "_ 100 h 60 @ 80 l 60 oU 200 _ 100"}) {
    EXPECT_NEAR(Track28(text).At(270).mouth[kJawY], jaw, 0.5) << text;
    EXPECT_TRUE(Track28(text).targets().unknown.empty()) << text;
  }
}

TEST(PhonemeNamesTest, EndingsAreTakenOffAndUnknownNamesAreListed) {
  EXPECT_TRUE(Track28("iː 100 ˈ 0 a 100 uːː 100 ə 10 ɹ 10").targets().unknown ==
              std::vector<std::string>{"ˈ"});
  const VisemeTrack track = Track28("aa 100 xyz 300 b 50 xyz 10 ?! 10");
  EXPECT_EQ(track.targets().unknown, (std::vector<std::string>{"xyz", "?!"}));
  EXPECT_FLOAT_EQ(track.At(250).seal, 1);  // closed, as the original
}

TEST(PhonemeNamesTest, ALanguageOrAnEngineCanBeInsistedOn) {
  const auto english = [](const char* text, Language language, const char* engine) {
    return VisemeFinder(List(text), Tables().set(VisemeSetId::k28), Tables().engines, language,
                        engine)
               .language() == Language::kEnglish;
  };
  EXPECT_TRUE(english("k 10 t 10", Language::kEnglish, ""));
  // a of espeak-ng's English is the vowel of "cat".
  EXPECT_TRUE(english("k 10 a 10 t 10", Language::kAuto, "ESPEAK"));
}

TEST(PhonemeNamesTest, AnEngineWhoseNameIsWithinAnothersIsListed) {
  const auto japanese = Language::kJapanese, english = Language::kEnglish;
  EXPECT_EQ(
      EngineList(
          {{"JTALK", japanese, {}, {}}, {"FLITE", english, {}, {}}, {"JTALK", english, {}, {}}}),
      "FLITE OPEN_JTALK JTALK");
}

TEST(PhonemeTablesTest, BothSetsKnowTheSamePhonemes) {
  for (const auto& [name, look] : Tables().set(VisemeSetId::k28).english) {
    EXPECT_TRUE(Tables().set(VisemeSetId::k14).english.contains(name)) << name;
  }
  for (const auto& [name, look] : Tables().set(VisemeSetId::k28).japanese) {
    EXPECT_TRUE(Tables().set(VisemeSetId::k14).japanese.contains(name)) << name;
  }
}

TEST(PhonemeTablesTest, JapaneseConsonantsAreSixtyPerCentOfTheEnglishShape) {
  for (const char* name : {"t", "n", "k", "s", "sh", "w", "m"}) {
    const PhonemeVisemes& shapes = Tables().set(VisemeSetId::k28).japanese.at(name);
    EXPECT_DOUBLE_EQ(shapes.phases[0].strength, 0.6) << name;
    EXPECT_EQ(shapes.phases[0].viseme,
              Tables().set(VisemeSetId::k28).english.at(name).phases[0].viseme)
        << name;
  }
  EXPECT_DOUBLE_EQ(Tables().set(VisemeSetId::k28).japanese.at("U").phases[0].strength, 0.6);
  EXPECT_EQ(Tables().set(VisemeSetId::k28).japanese.at("h").phases[0].viseme,
            PhonemeVisemes::kNext);
}

// ---- on the head

const Head& TheHead() {
  static const auto head = MakeHead("galatea");
  return *head;
}

struct Utterance {
  vm::PhonemeList list;
  std::string text;
};

/// A random utterance in which contacts are frequent, `speed` times as fast as speech.
Utterance RandomUtterance(std::mt19937& random, double speed) {
  static const char* contacts[] = {"p", "b", "m", "f", "v"};
  std::vector<std::string> names;
  for (const auto& [name, look] : Tables().set(VisemeSetId::k28).english) names.push_back(name);
  Utterance out;
  for (int i = 0; i < 14; ++i) {
    const bool contact = random() % 3 == 0;
    const std::string name = contact ? contacts[random() % 5] : names[random() % names.size()];
    const double ms = 40 + static_cast<double>(random() % 120);
    out.list.push_back({name, std::chrono::milliseconds(std::lround(ms / speed))});
  }
  out.text = vm::FormatPhonemesPlain(out.list);
  return out;
}

/// Millimetres at the middle of the mouth, from the edge of the upper teeth.
struct LipsAtTeeth {
  float upper_above = 0, lower_below = 0;
};

LipsAtTeeth AtTeeth(const FaceState& state) {
  HeadVertices now;
  TheHead().Evaluate(state, now);
  const MouthVertices& mouth = TheHead().mouth();
  const auto [upper, lower] = mouth.Middle();
  const float edge = now.position[mouth.incisors->upper].y;
  return {now.position[upper].y - edge, edge - now.position[lower].y};
}

void ExpectContacts(FaceMotion& motion, const Utterance& said, const std::string& how) {
  motion.speech.Start(5s, said.list, 6s);
  vm::Time at = 6s - 40ms;  // the lead
  for (const vm::Phoneme& phoneme : said.list) {
    const bool closes = phoneme.name == "p" || phoneme.name == "b" || phoneme.name == "m";
    const bool bites = phoneme.name == "f" || phoneme.name == "v";
    if (closes || bites) {
      float least = 100;
      for (vm::Time t = at; t < at + phoneme.duration; t += 4ms) {
        const FaceState state = motion.StateAt(t);
        least = std::min(
            least, closes ? TheHead().MeasureMouth(state).gap_mm : AtTeeth(state).lower_below);
      }
      ASSERT_LT(least, closes ? 0.1f : 1.0f)
          << phoneme.name << " at " << (at - 6s + 40ms).count() / 1000 << " ms, " << how << ": "
          << said.text;
    }
    at += phoneme.duration;
  }
  motion.speech.Stop(at + 1s);
}

TEST(LipsOnTheHeadTest, ClosuresCloseAndLipsReachTheTeethInAnyEmotionAtAnySpeed) {
  std::mt19937 random(11);
  for (const auto& [name, expression] : Tables().expressions) {
    for (int pattern = 1; pattern <= static_cast<int>(expression.patterns.size()); ++pattern) {
      for (const double strength : {0.5, 1.0, 1.5, 2.0}) {
        const double speed = 1 + 0.5 * static_cast<double>(random() % 3);
        FaceMotion motion(Tables(), 1);
        auto settings = motion.settings();
        settings.lips.mode =
            std::array{LipMode::kDominance, LipMode::kDominance, LipMode::kSinusoid}[random() % 3];
        settings.lips.jaw = 0.4 + 0.4 * static_cast<double>(random() % 4);
        settings.lips.lips = settings.lips.jaw;
        settings.mouth_scale = 30 + 10 * static_cast<double>(random() % 5);
        motion.Apply(0ms, settings);
        ASSERT_TRUE(motion.expression.Show(0ms, name, pattern, strength, 0ms));
        ExpectContacts(motion, RandomUtterance(random, speed),
                       name + " " + std::to_string(pattern) + " x" + std::to_string(strength) +
                           ", speed " + std::to_string(speed));
        if (HasFatalFailure()) return;
      }
    }
  }
}

TEST(LipsOnTheHeadTest, EveryContactIsMadeAtDoubleSpeedInEachEmotionAtFullStrength) {
  for (const char* emotion : {"HAPPY", "ANGRY", "DISGUSTED", "SAD", "SURPRISED", "FEARED"}) {
    for (const char* vowel : {"aa", "ae", "iy", "uw", "ow"}) {
      FaceMotion motion(Tables(), 1);
      ASSERT_TRUE(motion.expression.Show(0ms, emotion, 1, 1.0, 0ms));
      // Half of 120 ms for a vowel and of 70 for a consonant.
      Utterance said;
      for (const char* contact : {"p", "f", "b", "v", "m"}) {
        said.list.push_back({vowel, 60ms});
        said.list.push_back({contact, 35ms});
      }
      said.list.push_back({vowel, 60ms});
      said.text = vm::FormatPhonemesPlain(said.list);
      ExpectContacts(motion, said, emotion);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(LipsOnTheHeadTest, AnFShowsTheUpperTeethOnTheLowerLip) {
  FaceMotion motion(Tables(), 1);
  motion.speech.Start(0ms, List("pau 200 aa 200 f 120 aa 200 pau 200"), 1s);
  const LipsAtTeeth lips = AtTeeth(motion.StateAt(1s - 40ms + 460ms));
  EXPECT_GT(lips.upper_above + lips.lower_below, 1.5) << "mm of the teeth are seen";
  EXPECT_LT(lips.lower_below, 0.5);
}

TEST(LipsOnTheHeadTest, OpenVowelsAreOpenAndRoundOnesNarrow) {
  FaceMotion motion(Tables(), 1);
  motion.speech.Start(0ms, List("pau 200 aa 200 b 100 uw 200 b 100 iy 200 pau 200"), 1s);
  const auto at = [&](int ms) {
    return TheHead().MeasureMouth(motion.StateAt(1s - 40ms + std::chrono::milliseconds(ms)));
  };
  EXPECT_GT(at(300).gap_mm, 7);
  EXPECT_LT(at(600).gap_mm, 4);
  EXPECT_LT(at(600).width_mm, at(0).width_mm - 4);
  EXPECT_GT(at(900).width_mm, at(0).width_mm + 3);
  EXPECT_LT(at(420).gap_mm, 0.1);
}

}  // namespace
}  // namespace fsm
