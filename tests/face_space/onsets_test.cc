#include "face_space/timing/onsets.h"

#include <gtest/gtest.h>

#include <random>

#include "fsm/motion/base/easing.h"
#include "fsm/motion/inputs/motion_tables.h"

namespace facespace {
namespace {

const fsm::MotionTables& ShippedTables() {
  static const fsm::MotionTables tables = *fsm::MotionTables::Load();
  return tables;
}

struct Shown {
  double at_ms, onset_ms;
  ByRegion<double> lag_ms;
  double hold_ms = 600;
};

/// The strength of a part of the face that begins late and is as quick as the rest of the time
/// allows, as fsm's expressions are; it goes back within 500 ms.
double Strength(const Shown& shown, std::size_t region, double ms) {
  const double begins = shown.at_ms + shown.lag_ms[region];
  const double ends = shown.at_ms + shown.onset_ms + shown.hold_ms;
  return fsm::SmootherStep((ms - begins) / (shown.onset_ms - shown.lag_ms[region])) -
         fsm::SmootherStep((ms - ends) / 500);
}

/// Brows by unit 1, eyes by 7, the mouth by 12 and 25.
UnitTrack Film(const std::vector<Shown>& expressions, double rate, double noise = 0) {
  UnitTrack track{.name = "film", .ms = {}, .looks = {}};
  std::mt19937 random(7);
  std::normal_distribution<float> by_chance(0, 1);
  for (double ms = 0; ms < expressions.back().at_ms + 4000; ms += 1000 / rate) {
    ByRegion<double> parts{};
    for (const Shown& shown : expressions) {
      for (std::size_t region = 0; region < fsm::kRegions; ++region)
        parts[region] += Strength(shown, region, ms);
    }
    track.ms.push_back(ms);
    fsm::FaceLook& look = track.looks.emplace_back();
    for (fsm::UnitValues* side : {&look.au.left, &look.au.right}) {
      const auto set = [&](std::size_t unit, double strength) {
        (*side)[unit] = static_cast<float>(strength + noise * by_chance(random));
      };
      set(7, 0.6 * parts[0]);
      set(1, 0.8 * parts[1]);
      set(12, 0.9 * parts[2]);
      set(25, 0.5 * parts[2]);
    }
  }
  return track;
}

void ExpectOnset(const Onset& found, const Shown& shown, double lag_ms, double length_ms) {
  EXPECT_NEAR(found.begins_ms, shown.at_ms + std::ranges::min(shown.lag_ms), length_ms);
  EXPECT_NEAR(found.onset_ms, shown.onset_ms - std::ranges::min(shown.lag_ms), length_ms);
  for (std::size_t region = 0; region < fsm::kRegions; ++region) {
    ASSERT_TRUE(found.lag_ms[region]) << region;
    EXPECT_NEAR(*found.lag_ms[region], shown.lag_ms[region] - std::ranges::min(shown.lag_ms),
                lag_ms)
        << region;
  }
}

TEST(OnsetsTest, AHighSpeedFilmTellsOnsetAndLagsOfEachExpression) {
  const std::vector<Shown> shown{{1000, 556, {0, 9.2, 18.5}}, {4000, 228, {6, 0, 5.6}}};
  const auto onsets = FindOnsets(Film(shown, 250), ShippedTables().unit_list.regions);
  ASSERT_EQ(onsets.size(), 2u);
  ExpectOnset(onsets[0], shown[0], 0.2, 1);
  ExpectOnset(onsets[1], shown[1], 0.2, 1);
  EXPECT_NEAR(onsets[0].moved[0], 0.6, 0.01);
}

TEST(OnsetsTest, NoiseBlursLagsByAFewMilliseconds) {
  const Shown shown{1000, 556, {0, 40, 80}};
  const auto onsets = FindOnsets(Film({shown}, 250, 0.01), ShippedTables().unit_list.regions);
  ASSERT_EQ(onsets.size(), 1u);
  ExpectOnset(onsets[0], shown, 5, 12);
}

TEST(OnsetsTest, AnOrdinaryFilmTellsLagsFinerThanItsFrames) {
  const Shown shown{1013, 556, {0, 30, 60}};
  const auto onsets = FindOnsets(Film({shown}, 25), ShippedTables().unit_list.regions);
  ASSERT_EQ(onsets.size(), 1u);
  ExpectOnset(onsets[0], shown, 3, 10);
}

TEST(OnsetsTest, APartThatDoesNotMoveHasNoLag) {
  UnitTrack track = Film({{1000, 500, {0, 0, 0}}}, 100);
  for (fsm::FaceLook& look : track.looks) look.au.left[1] = look.au.right[1] = 0;
  const auto onsets = FindOnsets(track, ShippedTables().unit_list.regions);
  ASSERT_EQ(onsets.size(), 1u);
  EXPECT_FALSE(onsets[0].lag_ms[static_cast<std::size_t>(fsm::Region::kBrow)]);
  EXPECT_TRUE(onsets[0].lag_ms[static_cast<std::size_t>(fsm::Region::kMouth)]);
}

TEST(OnsetsTest, AFaceAtRestHasNoOnsets) {
  EXPECT_TRUE(
      FindOnsets(Film({{1e9, 500, {}}}, 0.00001), ShippedTables().unit_list.regions).empty());
  UnitTrack still = Film({{1000, 500, {}}}, 100);
  for (fsm::FaceLook& look : still.looks) look = {};
  EXPECT_TRUE(FindOnsets(still, ShippedTables().unit_list.regions).empty());
}

TEST(OnsetsTest, ALastExpressionThatStaysCounts) {
  UnitTrack track = Film({{1000, 500, {0, 10, 20}}}, 100);
  track.ms.resize(180);  // the film ends while it is held
  track.looks.resize(180);
  EXPECT_EQ(FindOnsets(track, ShippedTables().unit_list.regions).size(), 1u);
}

TEST(OnsetsTest, TheMedianLeavesOneOddExpressionOut) {
  Onset usual{.begins_ms = 0, .onset_ms = 500, .lag_ms = {0.0, 10.0, 20.0}, .moved = {1, 1, 1}};
  Onset odd{.begins_ms = 0, .onset_ms = 2000, .lag_ms = {300.0, 0.0, std::nullopt}, .moved = {}};
  const Onset median = MedianOnset({usual, odd, usual});
  EXPECT_EQ(median.onset_ms, 500);
  EXPECT_EQ(median.lag_ms, usual.lag_ms);
}

TEST(OnsetsTest, ATimingGoesIntoTheRowOfItsEmotionAloneAndFsmReadsTheTable) {
  const std::string table =
      "# comment\nposed HAPPY 556 0 9.2 18.5\nelicited HAPPY 724 0 23.3 26.1\n";
  const auto changed = WithTiming(
      table, "posed", "HAPPY",
      {.begins_ms = 0, .onset_ms = 480, .lag_ms = {0.0, std::nullopt, 33.0}, .moved = {}});
  ASSERT_TRUE(changed) << changed.error().text;
  EXPECT_EQ(*changed,
            "# comment\nposed    HAPPY     480 0.0 9.2 33.0\nelicited HAPPY 724 0 23.3 26.1\n");
  const auto missing = WithTiming(table, "posed", "SAD", {});
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().text, "the table emotions.txt has no row 'posed SAD'");
}

}  // namespace
}  // namespace facespace
