// Speakers: their files, stretches of sound, and who is met by five vowels.

#include "vdm/mouth/speaker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "vdm/mouth/speaker_learner.h"

namespace vdm {
namespace {

TEST(SpeakerTest, FilesAreReadAgainAndDamageIsToldWithItsLine) {
  const auto again = ParseSpeaker("s", FormatSpeaker({1.08F}));
  ASSERT_TRUE(again);
  EXPECT_FLOAT_EQ(again->warp, 1.08F);
  const auto error = [](const char* text) { return ParseSpeaker("s", text).error().text; };
  EXPECT_EQ(error("# c\nwarp 1.7\n"),
            "s:2: 'warp' found, one line 'warp NUMBER' with 0.5 to 1.5 expected");
  EXPECT_EQ(error(""), "s:1: the end found, 'warp NUMBER' expected");
  const auto vowels = [](const char* text) { return ReadVowels("v", text).error().text; };
  EXPECT_EQ(vowels("vowels aa\nwarps 1 0.9\n"),
            "v:2: '0.9' found, rising numbers from 0.5 to 1.5 expected");
  EXPECT_EQ(vowels("vowels aa\n"),
            "v:1: one line 'vowels CLASS...' and one 'warps NUMBER...' expected");
}

TEST(SpeakerTest, AStoreTouchesNothingButItsOwnFiles) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "vdm_store";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  SpeakerStore store(folder);
  for (const char* name : {"", ".", "..", "a/b", "../x", "a b", "a.b", "\xc3\xa4"}) {
    EXPECT_EQ(store.Keep(name, {1.1F}).error().code, vm::Errc::kBadValue) << name;
    EXPECT_EQ(store.Find(name).error().code, vm::Errc::kBadValue) << name;
  }
  EXPECT_EQ(store.Find("anna").error().code, vm::Errc::kUnavailable);
  ASSERT_TRUE(store.Keep("anna", {1.1F}));
  ASSERT_TRUE(store.Keep("anna", {1.2F}));
  EXPECT_FLOAT_EQ(SpeakerStore(folder).Find("anna")->warp, 1.2F);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
  std::filesystem::remove_all(folder);
  EXPECT_EQ(store.Keep("anna", {1.1F}).error().code, vm::Errc::kUnavailable);

  SpeakerStore without;
  ASSERT_TRUE(without.Keep("anna", {0.9F}));
  EXPECT_FLOAT_EQ(without.Find("anna")->warp, 0.9F);
}

TEST(SpeakerLearnerTest, StretchesOfSoundAreFound) {
  std::vector<float> levels(300, -70.0F);
  const auto loud = [&](std::size_t first, std::size_t end, float db) {
    std::fill(levels.begin() + static_cast<long>(first), levels.begin() + static_cast<long>(end),
              db);
  };
  loud(20, 60, -20);
  loud(65, 80, -22);    // a hole of 50 ms before it
  loud(120, 125, -20);  // a click
  loud(150, 190, -50);  // too quiet beside the others
  loud(200, 240, -30);
  const auto found = LoudStretches(levels);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].first, 20U);
  EXPECT_EQ(found[0].end, 80U);
  EXPECT_EQ(found[1].first, 200U);
  EXPECT_EQ(found[1].end, 240U);
  EXPECT_TRUE(LoudStretches({}).empty());
}

/// Buzzes of 110 Hz through the formants of a, i, u, e, o of a man (Peterson and Barney, JASA 24,
/// 1952) times `scale`, 400 ms each, with pauses.
std::vector<std::int16_t> Vowels(double scale, std::size_t count = 5) {
  constexpr double kFormants[5][3] = {
      {730, 1090, 2440}, {270, 2290, 3010}, {300, 870, 2240}, {530, 1840, 2480}, {570, 840, 2410}};
  std::vector<std::int16_t> sound(8000);
  for (std::size_t v = 0; v < count; ++v) {
    for (std::size_t i = 0; i < 6400; ++i) {
      const double t = static_cast<double>(i) / 16000;
      double x = 0;
      for (int k = 1; 110 * k < 7000; ++k) {
        double size = 0, falls = 1;
        for (const double formant : kFormants[v]) {
          size += falls / (1 + std::pow((110 * k - scale * formant) / 70, 2));
          falls *= 0.5;
        }
        x += size * std::sin(6.2831853 * 110 * k * t);
      }
      const double swell = std::min({1.0, t / 0.05, (0.4 - t) / 0.05});
      sound.push_back(static_cast<std::int16_t>(std::lround(3000 * swell * x)));
    }
    sound.resize(sound.size() + 6400);
  }
  return sound;
}

vm::Result<Speaker> Met(SpeakerLearner& learner, const std::vector<std::int16_t>& sound) {
  for (std::size_t at = 0; at < sound.size(); at += 320) {
    const auto piece = std::span(sound).subspan(at, std::min<std::size_t>(320, sound.size() - at));
    if (auto met = learner.Add(piece)) return *met;
  }
  return learner.Finish();
}

TEST(SpeakerLearnerTest, AShorterVocalTractIsToldFromALongerOne) {
  const MouthNet& net = ShippedNet(FeatureKind::kMel);
  SpeakerLearner learner(net, BuiltVowels()), other(net, BuiltVowels());
  const auto longer = Met(learner, Vowels(0.95)), shorter = Met(other, Vowels(1.15));
  ASSERT_TRUE(longer) << longer.error().text;
  ASSERT_TRUE(shorter) << shorter.error().text;
  EXPECT_GT(shorter->warp, longer->warp + 0.05F);
}

TEST(SpeakerLearnerTest, WhatAreNotTheseVowelsIsAnError) {
  const MouthNet& net = ShippedNet(FeatureKind::kMel);
  const auto error = [&](const std::vector<std::int16_t>& sound) {
    SpeakerLearner learner(net, BuiltVowels());
    const auto met = Met(learner, sound);
    return met ? std::string() : met.error().text;
  };
  EXPECT_TRUE(error(Vowels(1, 3)).starts_with("the sound ended after 3 stretches of it;"));
  EXPECT_TRUE(error(std::vector<std::int16_t>(16000 * 21)).starts_with("0 stretches of sound"));
  auto six = Vowels(1, 4);
  for (int n = 0; n < 2; ++n) {
    const auto more = Vowels(1, 1);
    six.insert(six.end(), more.begin(), more.end());
  }
  SpeakerLearner at_once(net, BuiltVowels());
  const auto met = at_once.Add(six);
  ASSERT_TRUE(met && !*met);
  EXPECT_TRUE(met->error().text.starts_with("6 stretches of sound found")) << met->error().text;
  std::vector<std::int16_t> hisses(8000);
  for (int n = 0; n < 5; ++n) {
    std::uint32_t state = 3;
    for (int i = 0; i < 6400; ++i) {
      state = state * 1664525U + 1013904223U;
      hisses.push_back(static_cast<std::int16_t>(static_cast<int>(state >> 19) - 4096));
    }
    hisses.resize(hisses.size() + 6400);
  }
  EXPECT_TRUE(error(hisses).starts_with("other sounds found;")) << error(hisses);
  MouthNet strange = net;
  strange.sounds.assign(net.sounds.size(), "x");
  SpeakerLearner learner(strange, BuiltVowels());
  EXPECT_TRUE(Met(learner, Vowels(1)).error().text.starts_with("the network does not know"));
}

}  // namespace
}  // namespace vdm
