// No part of the face goes through another: over every single unit, every pair of units and ten
// thousand random states of everything a state holds.

#include <gtest/gtest.h>

#include <string>

#include "tests/fsm/contact_probe.h"

namespace fsm {
namespace {

using testing::ContactProbe;
using testing::Contacts;
using testing::RandomState;
using testing::Vertices;
using testing::WithUnit;

constexpr float kDepth = 0.3F;  // millimetres that nobody sees

/// Of everything at random, in one state of ten thousand: 0.68 mm.
constexpr float kTeethAtRandom = 0.8F;

const ContactProbe& StateProbe() {
  static const ContactProbe probe;
  return probe;
}

/// True if the tongue, too, is outside everything. `teeth`: how far they may be in the lips.
bool ExpectApart(const FaceState& state, const std::string& what, float teeth = kDepth) {
  const Contacts c = StateProbe().Measure(state, Vertices(state));
  EXPECT_LE(c.lips, kDepth) << what;
  EXPECT_LE(c.lids, kDepth) << what;
  EXPECT_LE(c.ball_in_lids, kDepth) << what;
  EXPECT_LE(c.teeth_in_lips, teeth) << what;
  return c.tongue_in_lips <= kDepth && c.tongue_in_teeth <= kDepth;
}

bool IsUnit(std::size_t number) { return number != 3 && number != 40; }

TEST(HeadStatesTest, WhatMeetsIsFound) {
  EXPECT_GE(StateProbe().seam_pairs(), 15u);
  EXPECT_GE(StateProbe().rim_pairs(), 12u);
}

/// The first unit of the pairs of one test, so that they can run side by side.
class Pairs : public ::testing::TestWithParam<std::size_t> {};

TEST_P(Pairs, NothingGoesThroughAnythingWithAnyOtherUnit) {
  const std::size_t a = GetParam();
  if (!IsUnit(a)) return;
  for (std::size_t b = a; b < kActionUnits; ++b) {
    if (!IsUnit(b)) continue;
    FaceState state = WithUnit(a, 1);
    state.au.left[b] = state.au.right[b] = 1;
    const std::string both = "AU " + std::to_string(a) + " and " + std::to_string(b);
    EXPECT_TRUE(ExpectApart(state, both)) << both;
    // One of them on one side only.
    state.au.right[b] = a == b ? 0.0F : state.au.right[b];
    if (a != b) state.au.right[a] = 0;
    EXPECT_TRUE(ExpectApart(state, both + ", one of them left")) << both;
  }
}
INSTANTIATE_TEST_SUITE_P(HeadStatesTest, Pairs, ::testing::Range(std::size_t{1}, kActionUnits));

class RandomStates : public ::testing::TestWithParam<unsigned> {};

TEST_P(RandomStates, NothingGoesThroughAnythingInATenthOfTenThousand) {
  std::mt19937 random(GetParam());
  std::uniform_real_distribution<float> turn(-30, 30);
  std::uniform_real_distribution<float> part(0, 1);
  int touched = 0;
  for (int i = 0; i < 1000; ++i) {
    FaceState state = RandomState(random, 1);
    state.gaze.left = {-turn(random), turn(random)};
    state.gaze.right = {-turn(random), turn(random)};
    state.blink.left = part(random);
    state.blink.right = part(random);
    state.tongue = part(random);
    state.seal = part(random) < 0.3F ? part(random) : 0.0F;
    const std::string what =
        "state " + std::to_string(i) + " of seed " + std::to_string(GetParam());
    touched += ExpectApart(state, what, kTeethAtRandom) ? 0 : 1;
  }
  // Of the tongue only the places of its vertices are fitted to the way out, so where a random
  // mouth is very uneven a triangle of it cuts a corner.
  EXPECT_LE(touched, 35);
}
INSTANTIATE_TEST_SUITE_P(HeadStatesTest, RandomStates, ::testing::Range(1U, 11U));

class ClosedEyes : public ::testing::TestWithParam<int> {};

TEST_P(ClosedEyes, AreCoveredWhereverTheyLookAndWhateverElseActs) {
  const auto other = static_cast<std::size_t>(GetParam());
  for (const std::size_t closing :
       {std::size_t{0}, std::size_t{43}, std::size_t{45}, std::size_t{46}}) {
    for (const float up : {-30.0F, -15.0F, 0.0F, 15.0F, 30.0F}) {
      for (const float right : {-40.0F, -20.0F, 0.0F, 20.0F, 40.0F}) {
        FaceState state = WithUnit(other, 1);
        if (closing == 0) state.blink.left = state.blink.right = 1;
        if (closing != 0) state.au.left[closing] = state.au.right[closing] = 1;
        state.gaze.left = state.gaze.right = {-up, right};
        ASSERT_LE(StateProbe().Uncovered(state, Vertices(state)), 0.05F)
            << "AU " << other << " closed by " << closing << " looking up " << up << " right "
            << right;
      }
    }
  }
}
// Alone, and with what acts near the eyes.
INSTANTIATE_TEST_SUITE_P(HeadStatesTest, ClosedEyes,
                         ::testing::Values(0, 1, 2, 4, 5, 6, 7, 9, 12, 41, 42, 44));

}  // namespace
}  // namespace fsm
