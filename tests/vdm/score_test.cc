// What is counted of a mouth beside another.

#include "vdm/train/score.h"

#include <gtest/gtest.h>

namespace vdm {
namespace {

vm::PhonemeList List(const char* text) { return vm::ParsePhonemes(text).value(); }

TEST(ScoreTest, TheSameMouthIsPerfectAndItsDoubleIsAsLike) {
  std::vector<double> truth, twice;
  for (int i = 0; i < 100; ++i) {
    truth.push_back(i % 10);
    twice.push_back(2 * truth.back());
  }
  Score same, scaled, turned;
  same.Add(truth, truth, 10, {});
  EXPECT_NEAR(same.correlation(), 1, 1e-9);
  EXPECT_NEAR(same.rms_mm(), 0, 1e-6);
  EXPECT_NEAR(same.size(), 1, 1e-9);
  scaled.Add(twice, truth, 10, {});
  EXPECT_NEAR(scaled.correlation(), 1, 1e-9);
  EXPECT_NEAR(scaled.size(), 2, 1e-9);
  EXPECT_NEAR(scaled.rms_mm(), 5.339, 0.001);  // root of the mean of the squares of 0 .. 9
  for (double& x : twice) x = -x;
  turned.Add(twice, truth, 10, {});
  EXPECT_NEAR(turned.correlation(), -1, 1e-9);
}

TEST(ScoreTest, ClosuresAreSeenWhereTheMouthIsShutInThem) {
  const auto phonemes = List("a 100 b 50 a 100 m 50 a 100");
  std::vector<double> truth(40, 6), ours(40, 6);
  for (const int closed : {11, 12, 26, 27}) truth[static_cast<std::size_t>(closed)] = 0;
  ours[11] = 0.5;
  Score score;
  score.Add(ours, truth, 10, phonemes);
  EXPECT_EQ(score.closures(), 2U);
  EXPECT_DOUBLE_EQ(score.closures_seen(), 0.5);
  EXPECT_EQ(score.shut_by_mistake(), 0);
}

TEST(ScoreTest, AShutMouthIsAMistakeOnlyWellWithinAnOpenOne) {
  std::vector<double> truth(40, 6), ours(40, 6);
  ours[20] = ours[39] = 0;  // the last is at the edge
  Score score;
  score.Add(ours, truth, 10, {});
  EXPECT_NEAR(score.shut_by_mistake(), 1 / 34.0, 1e-9);
}

}  // namespace
}  // namespace vdm
