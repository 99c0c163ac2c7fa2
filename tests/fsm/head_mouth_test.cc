#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/fsm/head_fixture.h"

namespace fsm {
namespace {

using testing::GenericHead;
using testing::RandomState;
using testing::SeamPairs;
using testing::Vertices;
using testing::WithUnit;

// Upper and lower vertex of the lips' seam nearest to the median: the two lip vertices that share a
// place at rest.
std::pair<std::size_t, std::size_t> MiddleSeam() {
  const HeadSurface& topology = GenericHead().surface();
  const HeadVertices rest = Vertices({});
  FaceState open;
  open.mouth[kJawY] = 10;
  const HeadVertices opened = Vertices(open);
  std::vector<std::size_t> lips;
  for (const HeadSurface::Part& part : topology.parts) {
    if (part.material != Material::kLip) continue;
    for (std::uint32_t k = 0; k < part.index_count; ++k) {
      const std::size_t i = topology.indices[part.first_index + k];
      if (std::abs(rest.position[i].x) < 0.01f) lips.push_back(i);
    }
  }
  for (const std::size_t upper : lips) {
    for (const std::size_t lower : lips) {
      if (rest.position[upper] == rest.position[lower] &&
          opened.position[upper].y > opened.position[lower].y + 1) {
        return {upper, lower};
      }
    }
  }
  ADD_FAILURE() << "no seam found";
  return {0, 0};
}

// Rows of the mouth shape table for the vowels: jaw in degrees, gap, corner x, protrusion z in mm,
// with the lips' own part of the gap added to what the jaw gives.
FaceState Vowel(float jaw, float lips, float corner, float forward) {
  FaceState state;
  state.mouth[kJawY] = jaw;
  state.mouth[kUpperInnerY] = lips / 2;
  state.mouth[kLowerInnerY] = -lips / 2;
  state.mouth[kCornerX] = corner;
  for (const std::size_t z : {1u, 3u, 5u, 7u}) state.mouth[z] = forward;
  return state;
}

TEST(HeadMouthTest, IsClosedAtRest) {
  const MouthMeasure m = GenericHead().MeasureMouth({});
  EXPECT_EQ(m.gap_mm, 0);
  EXPECT_NEAR(m.width_mm, 50.4, 0.5);
  EXPECT_EQ(m.jaw_degrees, 0);
}

TEST(HeadMouthTest, MeasureAgreesWithTheVertices) {
  const auto [upper, lower] = MiddleSeam();
  std::mt19937 random(3);
  for (int i = 0; i < 60; ++i) {
    FaceState state = RandomState(random, 1.5f);
    state.seal = i % 3 == 0 ? 0.5f : 0;
    const HeadVertices v = Vertices(state);
    const float gap = v.position[upper].y - v.position[lower].y;
    ASSERT_NEAR(GenericHead().MeasureMouth(state).gap_mm, gap, 1e-3) << i;
  }
}

TEST(HeadMouthTest, SealedLipsTouchWhateverElseActs) {
  const auto [upper, lower] = MiddleSeam();
  std::mt19937 random(11);
  for (int i = 0; i < 200; ++i) {
    FaceState state = RandomState(random, 2);
    state.seal = 1;
    const HeadVertices v = Vertices(state);
    ASSERT_LE(glm::length(v.position[upper] - v.position[lower]), 0.05f) << i;
    ASSERT_LE(GenericHead().MeasureMouth(state).gap_mm, 0.05f) << i;
  }
  EXPECT_LE(GenericHead()
                .MeasureMouth([] {
                  FaceState state = WithUnit(8, 1);
                  state.mouth[kJawY] = 8;
                  return state;
                }())
                .gap_mm,
            0.05f)
      << "AU 8 brings the lips together over an open jaw";
}

TEST(HeadMouthTest, LipsNeverCross) {
  // Every pair of lip vertices that share a place at rest, in any state: the one that opens upwards
  // stays above the other.
  const auto pairs = SeamPairs();
  EXPECT_GE(pairs.size(), 15u);
  std::mt19937 random(5);
  for (int i = 0; i < 200; ++i) {
    const HeadVertices v = Vertices(RandomState(random, 2));
    for (const auto& [a, b] : pairs) {
      ASSERT_GE(v.position[a].y - v.position[b].y, -0.01f) << "state " << i;
    }
  }
}

TEST(HeadMouthTest, VowelsOpenInTheOrderOfJapanese) {
  const auto gap = [](const FaceState& s) { return GenericHead().MeasureMouth(s).gap_mm; };
  const float a = gap(Vowel(9, 1.5f, 0, 0));
  const float e = gap(Vowel(5.5f, 1, 2.5f, 0));
  const float o = gap(Vowel(5, 1, -5, 5));
  const float i = gap(Vowel(2, 2, 3.5f, -1));
  const float u = gap(Vowel(1.5f, 0.8f, -3, 2));
  EXPECT_GT(a, e);
  EXPECT_GT(e, o);
  EXPECT_GT(o, i);
  EXPECT_GT(i, u);
  EXPECT_NEAR(a, 14, 1.5);
  EXPECT_NEAR(u, 3, 1);
}

TEST(HeadMouthTest, CornersMoveAsAsked) {
  const auto width = [](float corners) {
    FaceState state;
    state.mouth[kCornerX] = corners;
    return GenericHead().MeasureMouth(state).width_mm;
  };
  EXPECT_NEAR(width(3), width(0) + 6, 0.1);
  EXPECT_NEAR(width(-5), width(0) - 10, 0.1);
}

TEST(HeadMouthTest, OneDegreeOfJawOpensAboutOneAndAHalfMillimetres) {
  FaceState state;
  state.mouth[kJawY] = 4;
  EXPECT_NEAR(GenericHead().MeasureMouth(state).gap_mm / 4, 1.4, 0.15);
}

}  // namespace
}  // namespace fsm
