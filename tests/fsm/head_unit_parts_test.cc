// Action units that move lids, jaw, inner lips or tongue, which no point of the skin's front shows:
// sizes measured on a scanned head (ICT-FaceKit), within a quarter or a millimetre.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "fsm/head/anatomy.h"
#include "tests/fsm/contact_probe.h"
#include "tests/fsm/head_fixture.h"

namespace fsm {
namespace {

using testing::ContactProbe;
using testing::GenericHead;
using testing::MotionAt;
using testing::Vertices;
using testing::WithUnit;

const ContactProbe& Probe() {
  static const ContactProbe probe;
  return probe;
}

void ExpectMeasured(float found, float measured, const std::string& what) {
  EXPECT_NEAR(found, measured, std::max(1.0F, 0.25F * std::abs(measured))) << what;
}

struct LidMotion {
  glm::vec3 upper, lower;
};

/// How the middle of the rims moves from rest; x outward.
LidMotion MidLids(const FaceState& state, Side side = Side::kLeft) {
  const HeadVertices rest = Vertices({});
  const float middle = GenericHead().EyeCentre(side).x;
  const auto& rims = Probe().rims(side);
  const auto nearest = std::ranges::min_element(
      rims, {}, [&](const auto& pair) { return std::abs(rest.position[pair.first].x - middle); });
  EXPECT_NE(nearest, rims.end());
  const HeadVertices moved = Vertices(state);
  const glm::vec3 mirror(SignOf(side), 1, 1);
  return {mirror * (moved.position[nearest->first] - rest.position[nearest->first]),
          mirror * (moved.position[nearest->second] - rest.position[nearest->second])};
}

glm::vec3 FarthestTongue(const FaceState& state) {
  const HeadVertices v = Vertices(state);
  const HeadSurface& topology = GenericHead().surface();
  glm::vec3 tip(0, 0, -1e9F);
  for (const HeadSurface::Part& part : topology.parts) {
    if (part.material != Material::kTongue) continue;
    for (std::uint32_t k = 0; k < part.index_count; ++k) {
      const glm::vec3 p = v.position[topology.indices[part.first_index + k]];
      if (p.z > tip.z) tip = p;
    }
  }
  return tip;
}

TEST(HeadUnitPartsTest, TheUpperLidIsRaised) {
  const glm::vec3 upper = MidLids(WithUnit(5, 1)).upper;
  ExpectMeasured(upper.y, 3.0F, "AU 5 up");
  ExpectMeasured(upper.z, -0.8F, "AU 5 back, on the ball");
}

TEST(HeadUnitPartsTest, TightenedLidsComeTogetherWithoutClosing) {
  for (const std::size_t unit : {7u, 44u}) {
    const LidMotion lids = MidLids(WithUnit(unit, 1));
    ExpectMeasured(lids.lower.y, 2.1F, "AU " + std::to_string(unit) + " lower lid up");
    ExpectMeasured(lids.upper.y, unit == 7 ? -1.0F : -1.8F, "AU " + std::to_string(unit));
  }
  // A squint also lowers the brow a little; a tightened lid does not.
  EXPECT_LT(MotionAt(16, 44, WithUnit(44, 1)).y, -0.7F);
  EXPECT_NEAR(MotionAt(16, 44, WithUnit(7, 1)).y, 0, 0.1F);
}

TEST(HeadUnitPartsTest, ClosingLidsMeetLow) {
  for (const std::size_t unit : {43u, 45u, 46u}) {
    const LidMotion lids = MidLids(WithUnit(unit, 1));
    const std::string name = "AU " + std::to_string(unit);
    ExpectMeasured(lids.upper.y, -7.6F, name + " upper lid down");
    // Most of the way is the upper lid's.
    EXPECT_LT(lids.lower.y, -0.3F * lids.upper.y) << name;
  }
}

TEST(HeadUnitPartsTest, ShutLidsMeetOnASoftCurveThatSags) {
  const EyeAnatomy& eye = EyeAnatomy::BuiltIn();
  const auto height = [&eye](float along) {
    const float x = glm::mix(eye.inner_x(), eye.outer_x(), along);
    return eye.LidPoint(x, eye.MeetAngle(x), eye.LidRadius(x)).y;
  };
  EXPECT_NEAR(0.5F * (eye.UpperY(eye.inner_x()) + eye.UpperY(eye.outer_x())) - height(0.5F), 3.4F,
              0.1F);
  for (const float along : {0.2F, 0.3F, 0.4F, 0.5F, 0.6F, 0.7F, 0.8F}) {
    const float bend = height(along - 0.1F) - 2 * height(along) + height(along + 0.1F);
    EXPECT_NEAR(bend, 8 * 3.4F * 0.01F, 0.05F) << "flat or bent at " << along;
  }
}

TEST(HeadUnitPartsTest, ADroopAndASlitAreThatPartOfClosing) {
  const float closed = MidLids(WithUnit(43, 1)).upper.y;
  EXPECT_NEAR(MidLids(WithUnit(41, 1)).upper.y / closed, 0.35F, 0.25F * 0.35F);
  EXPECT_NEAR(MidLids(WithUnit(42, 1)).upper.y / closed, 0.8F, 0.25F * 0.8F);
}

TEST(HeadUnitPartsTest, AWinkIsOfOneEye) {
  FaceState wink;
  wink.au.left[46] = 1;
  EXPECT_LT(MidLids(wink, Side::kLeft).upper.y, -5);
  EXPECT_EQ(MidLids(wink, Side::kRight).upper, glm::vec3(0));
}

TEST(HeadUnitPartsTest, ARaisedLowerLidGoesUpBesideTheMiddleToo) {
  const glm::vec3 middle = GenericHead().Landmark("palpebrale_inferius_left");
  const glm::vec3 corner = GenericHead().Landmark("exocanthion_left");
  const glm::vec2 beside = glm::mix(glm::vec2(middle), glm::vec2(corner), glm::vec2(0.55F, 0.3F));
  const FaceState squint = WithUnit(7, 1);
  const float up = MotionAt(middle.x, middle.y, squint).y;
  ASSERT_GT(up, 0.8F);
  EXPECT_GT(MotionAt(beside.x, beside.y, squint).y, 0.8F * up);
}

TEST(HeadUnitPartsTest, LipsPartWithoutTheJaw) {
  const MouthMeasure parted = GenericHead().MeasureMouth(WithUnit(25, 1));
  EXPECT_GE(parted.gap_mm, 2);
  EXPECT_LE(parted.gap_mm, 4.5F);
  EXPECT_EQ(parted.jaw_degrees, 0);
}

TEST(HeadUnitPartsTest, TheJawDropsTwelveDegrees) {
  EXPECT_NEAR(GenericHead().MeasureMouth(WithUnit(26, 1)).jaw_degrees, 12, 1);
  EXPECT_NEAR(GenericHead().MeasureMouth(WithUnit(26, 0.5F)).jaw_degrees, 6, 0.5);
}

// After ICT-FaceKit's jawOpen: parts of the way that the middle of the lower lip goes.
TEST(HeadUnitPartsTest, ADroppedJawArchesTheUpperLipRoundToTheCorners) {
  const HeadVertices rest = Vertices({});
  const HeadVertices v = Vertices(WithUnit(26, 1));
  const auto& middle = Probe().seam()[Probe().seam_pairs() / 2];
  const auto way = [&](std::uint32_t i) { return rest.position[i].y - v.position[i].y; };
  const float whole = way(middle.second);
  ASSERT_GT(whole, 10);
  int beside = 0;
  for (const auto& [upper, lower] : Probe().seam()) {
    const float x = std::abs(rest.position[upper].x);
    if (x < 11 && x > 9) {
      EXPECT_NEAR(way(upper) / whole, 0.10F, 0.04F) << x;
      EXPECT_NEAR(way(lower) / whole, 0.88F, 0.06F) << x;
      ++beside;
    }
    if (x < 20.5F && x > 19) {
      EXPECT_NEAR(way(upper) / whole, 0.25F, 0.05F) << "on its way to the corner";
    }
  }
  EXPECT_EQ(beside, 2);
  for (const float side : {-1.0F, 1.0F}) {
    EXPECT_NEAR(-MotionAt(25 * side, -41.7F, WithUnit(26, 1)).y / whole, 0.43F, 0.06F);
  }
}

TEST(HeadUnitPartsTest, TheJawMovesSidewaysAndTakesTheLipsAlong) {
  FaceState state;
  state.au.left[30] = 1;
  ExpectMeasured(MotionAt(0, -76, state).x, 8.6F, "chin");
  ExpectMeasured(MotionAt(25, -41.7F, state).x, 5, "left corner");
  ExpectMeasured(MotionAt(-25, -41.7F, state).x, 5, "right corner");
  ExpectMeasured(MotionAt(0, -37, state).x, 1.6F, "upper lip");
}

TEST(HeadUnitPartsTest, ABittenLipGoesBackAndUpToTheUpperTeeth) {
  const HeadVertices rest = Vertices({});
  const HeadVertices v = Vertices(WithUnit(32, 1));
  const auto& edge = Probe().upper_edge();
  const float tooth_y = v.position[edge[edge.size() / 2]].y;
  const auto& [upper, lower] = Probe().seam()[Probe().seam_pairs() / 2];
  const glm::vec3 moved = v.position[lower] - rest.position[lower];
  EXPECT_LT(moved.z, -2.5F);
  EXPECT_NEAR(v.position[lower].y, tooth_y, 2.0F);
  EXPECT_GE(v.position[upper].y, v.position[lower].y);
}

TEST(HeadUnitPartsTest, BlownCheeksBulgeAndLetTheAirOut) {
  const FaceState blow = WithUnit(33, 1);
  const glm::vec3 cheek = MotionAt(36, -40, blow);
  EXPECT_GT(cheek.x, 3);
  EXPECT_GT(cheek.z, 2);
  EXPECT_GT(MotionAt(0, -37, blow).z, 2) << "lips are blown forward";
  EXPECT_GT(GenericHead().MeasureMouth(blow).gap_mm, 0.5F);
  EXPECT_EQ(GenericHead().MeasureMouth(WithUnit(34, 1)).gap_mm, 0) << "a puff keeps it in";
}

TEST(HeadUnitPartsTest, TheTongueBulgesOneCheekLocally) {
  FaceState state;
  state.au.left[36] = 1;
  ExpectMeasured(glm::length(MotionAt(34, -45, state)), 5, "bump");
  EXPECT_GT(MotionAt(34, -45, state).x, 2);
  EXPECT_LT(glm::length(MotionAt(-34, -45, state)), 0.05F);
  EXPECT_LT(glm::length(MotionAt(34, -20, state)), 0.5F) << "a bump, no puff";
}

TEST(HeadUnitPartsTest, InAnOpenMouthTheTongueLiesBehindTheLowerTeeth) {
  for (const FaceState& state : {WithUnit(26, 1), WithUnit(27, 1), WithUnit(25, 1)}) {
    const HeadVertices v = Vertices(state);
    const auto& edge = Probe().lower_edge();
    const glm::vec3 tooth = v.position[edge[edge.size() / 2]];
    EXPECT_LT(FarthestTongue(state).z, tooth.z - 0.5F);
    EXPECT_LT(FarthestTongue(state).y, tooth.y) << "its tip is low";
  }
}

TEST(HeadUnitPartsTest, TheTongueShowsPastTheTeethAndWipesTheLip) {
  const HeadVertices rest = Vertices({});
  const auto& edge = Probe().upper_edge();
  const float teeth = rest.position[edge[edge.size() / 2]].z;
  EXPECT_LT(FarthestTongue({}).z, teeth);
  EXPECT_GT(FarthestTongue(WithUnit(19, 1)).z, teeth + 8);
  // It wipes over the lower lip and in front of the teeth, less far out than when shown.
  const FaceState wipe = WithUnit(37, 1);
  const glm::vec3 wiping = FarthestTongue(wipe);
  const float lip_y = Vertices(wipe).position[Probe().seam()[Probe().seam_pairs() / 2].second].y;
  EXPECT_GT(wiping.z, teeth + 3);
  EXPECT_LT(wiping.z, FarthestTongue(WithUnit(19, 1)).z);
  EXPECT_NEAR(wiping.y, lip_y, 6);
}

}  // namespace
}  // namespace fsm
