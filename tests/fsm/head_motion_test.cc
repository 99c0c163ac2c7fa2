#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "fsm/head/make_head.h"
#include "tests/fsm/head_fixture.h"

namespace fsm {
namespace {

using testing::GenericHead;
using testing::MotionAt;
using testing::RandomState;
using testing::Vertices;
using testing::WithUnit;

bool AllFinite(const HeadVertices& v) {
  for (std::size_t i = 0; i < v.position.size(); ++i) {
    const glm::vec3 s = v.position[i] + v.normal[i];
    if (!std::isfinite(s.x) || !std::isfinite(s.y) || !std::isfinite(s.z)) return false;
  }
  return true;
}

TEST(HeadMotionTest, EveryUnitAtDoubleStrengthStaysFiniteAndNear) {
  const HeadVertices rest = Vertices({});
  for (std::size_t unit = 1; unit < kActionUnits; ++unit) {
    if (unit == 3 || unit == 40) continue;
    FaceState state = WithUnit(unit, 2);
    if (unit == 30) state.au.right[unit] = 0;  // both sides of the sideways jaw cancel out
    if (unit == 8) state.mouth[kJawY] = 5;     // lips can only meet when they are apart
    const HeadVertices moved = Vertices(state);
    ASSERT_TRUE(AllFinite(moved)) << "AU " << unit;
    float most = 0;
    for (std::size_t i = 0; i < rest.position.size(); ++i) {
      most = std::max(most, glm::length(moved.position[i] - rest.position[i]));
    }
    EXPECT_GT(most, 0.8f) << "AU " << unit << " moves nothing";
    EXPECT_LT(most, 70.0f) << "AU " << unit;
  }
}

TEST(HeadMotionTest, WildAndBrokenStatesGiveFiniteVertices) {
  std::mt19937 random(7);
  for (int i = 0; i < 40; ++i) ASSERT_TRUE(AllFinite(Vertices(RandomState(random, 2))));
  FaceState broken;
  broken.au.left.fill(std::nanf(""));
  broken.au.right.fill(-3);
  broken.mouth.fill(std::numeric_limits<float>::infinity());
  broken.gaze.left[kDown] = 1e30f;
  broken.head_rotation = {std::nanf(""), 1e9f, -1e9f};
  broken.blink.left = std::nanf("");
  EXPECT_TRUE(AllFinite(Vertices(broken)));
}

TEST(HeadMotionTest, LeftAndRightUnitsAreMirrorImages) {
  for (const std::size_t unit : {1u, 2u, 4u, 6u, 9u, 10u, 12u, 15u, 20u, 43u}) {
    FaceState left, right;
    left.au.left[unit] = right.au.right[unit] = 1;
    for (const auto& [x, y] :
         {std::pair{25.0f, -43.0f}, {34.0f, 46.0f}, {31.0f, 28.0f}, {12.0f, -35.0f}}) {
      const glm::vec3 l = MotionAt(x, y, left);
      const glm::vec3 r = MotionAt(-x, y, right);
      EXPECT_NEAR(l.x, -r.x, 0.02) << "AU " << unit << " at " << x;
      EXPECT_NEAR(l.y, r.y, 0.02) << "AU " << unit << " at " << x;
      EXPECT_NEAR(l.z, r.z, 0.02) << "AU " << unit << " at " << x;
    }
    // The other side's cheek, brow and lids stay as they are.
    EXPECT_LT(glm::length(MotionAt(-34, 46, left)), 0.05f) << "AU " << unit;
    EXPECT_LT(glm::length(MotionAt(-34, -8, left)), 0.05f) << "AU " << unit;
  }
}

// Directions of the units the six emotions are made of, at the landmark each is known by.
struct Direction {
  std::size_t unit;
  float x, y;
  glm::vec3 least;  // signs and least sizes in mm; 0 = not judged
};

class UnitDirection : public ::testing::TestWithParam<Direction> {};

TEST_P(UnitDirection, MovesItsLandmarkTheRightWay) {
  const Direction d = GetParam();
  const glm::vec3 m = MotionAt(d.x, d.y, WithUnit(d.unit, 1));
  for (int k = 0; k < 3; ++k) {
    if (d.least[k] > 0) {
      EXPECT_GE(m[k], d.least[k]) << "AU " << d.unit << " axis " << k;
    } else if (d.least[k] < 0) {
      EXPECT_LE(m[k], d.least[k]) << "AU " << d.unit << " axis " << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    HeadMotionTest, UnitDirection,
    ::testing::Values(Direction{1, 13, 46, {0, 4, 0}},             // inner brow up
                      Direction{2, 42, 47, {0.5f, 5, -1.5f}},      // outer brow up and back
                      Direction{4, 13, 43, {-1.2f, -1.8f, 0.8f}},  // brows down and together
                      Direction{6, 34, -2, {0, 3, 1}},             // cheek up
                      Direction{9, 11, 6, {0, 3, 0}},              // nose side up
                      Direction{10, 12, -35, {0, 3, 0}},           // upper lip up
                      Direction{11, 28, -22, {1, 1.5f, 0}},
                      Direction{12, 25, -43, {4, 4, -3}},  // corner out, up and back
                      Direction{14, 26, -43, {0, 1, -3}},
                      Direction{15, 25, -43, {0.8f, -4, -1}},  // corner down
                      Direction{16, 10, -50, {0, -2.5f, 0}},
                      Direction{17, 8, -70, {0, 3.5f, 1.5f}},  // chin up and forward
                      Direction{20, 25, -43, {4.5f, -1.5f, -3}}, Direction{26, 0, -72, {0, -12, 0}},
                      Direction{27, 0, -76, {0, -24, 0}}),
    [](const auto& test) { return "Unit" + std::to_string(test.param.unit); });

TEST(HeadMotionTest, JawTurnsAboutItsHinge) {
  // The chin makes the same angle about the hinge (y -4, z -3) as asked for.
  FaceState state;
  state.mouth[kJawY] = 15;
  const std::size_t chin = testing::SkinAt(0, -73);
  const glm::vec3 a = Vertices({}).position[chin];
  const glm::vec3 b = Vertices(state).position[chin];
  const float before = std::atan2(a.y + 4, a.z + 3);
  const float after = std::atan2(b.y + 4, b.z + 3);
  EXPECT_NEAR((before - after) * 57.29578f, 15, 0.3);
  EXPECT_NEAR(std::hypot(a.y + 4, a.z + 3), std::hypot(b.y + 4, b.z + 3), 0.3);
  EXPECT_NEAR(GenericHead().MeasureMouth(state).jaw_degrees, 15, 0.01);
  EXPECT_NEAR(GenericHead().MeasureMouth(WithUnit(27, 1)).jaw_degrees, 25.3, 0.01);
}

std::vector<glm::vec3> PointsOf(Material material, const HeadVertices& v) {
  std::vector<glm::vec3> points;
  const HeadSurface& topology = GenericHead().surface();
  for (const HeadSurface::Part& part : topology.parts) {
    if (part.material != material) continue;
    for (std::uint32_t k = 0; k < part.index_count; ++k) {
      points.push_back(v.position[topology.indices[part.first_index + k]]);
    }
  }
  return points;
}

TEST(HeadMotionTest, ClosedLidsCoverTheEye) {
  for (const auto& [gaze_up, gaze_right] :
       {std::pair{0.0f, 0.0f}, {20.0f, 0.0f}, {-20.0f, 20.0f}}) {
    FaceState blink;
    blink.blink.left = blink.blink.right = 1;
    blink.gaze.left = blink.gaze.right = {-gaze_up, gaze_right};
    blink.au.left[5] = blink.au.right[5] = 1;
    const HeadVertices v = Vertices(blink);
    const HeadSurface& topology = GenericHead().surface();
    // Rays towards the viewer from points of the iris and the front of the white must hit skin.
    std::vector<glm::vec3> eye = PointsOf(Material::kIris, v);
    for (const glm::vec3 p : PointsOf(Material::kSclera, v)) {
      if (p.z > 70) eye.push_back(p);
    }
    for (std::size_t n = 0; n < eye.size(); n += 23) {
      bool covered = false;
      for (const HeadSurface::Part& part : topology.parts) {
        if (part.material != Material::kSkin) continue;
        for (std::uint32_t k = 0; k < part.index_count && !covered; k += 3) {
          const std::uint32_t* i = &topology.indices[part.first_index + k];
          const glm::vec3 a = v.position[i[0]], b = v.position[i[1]], c = v.position[i[2]];
          const glm::vec3 p = eye[n];
          const float area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
          if (area <= 1e-6f) continue;
          const float wa = ((b.x - p.x) * (c.y - p.y) - (b.y - p.y) * (c.x - p.x)) / area;
          const float wb = ((c.x - p.x) * (a.y - p.y) - (c.y - p.y) * (a.x - p.x)) / area;
          const float wc = 1 - wa - wb;
          if (wa < -1e-3f || wb < -1e-3f || wc < -1e-3f) continue;
          covered = wa * a.z + wb * b.z + wc * c.z > p.z;
        }
      }
      ASSERT_TRUE(covered) << "gaze " << gaze_up << " eye point " << eye[n].x << " " << eye[n].y;
    }
  }
}

TEST(HeadMotionTest, UnitsCloseTheLidsAsABlinkDoes) {
  FaceState blink;
  blink.blink.left = blink.blink.right = 1;
  EXPECT_EQ(Vertices(blink).position, Vertices(WithUnit(43, 1)).position);
  EXPECT_EQ(Vertices(blink).position, Vertices(WithUnit(45, 1)).position);
}

TEST(HeadMotionTest, LidsFollowTheGaze) {
  FaceState down, up;
  down.gaze.left[kDown] = down.gaze.right[kDown] = 20;
  up.gaze.left[kDown] = up.gaze.right[kDown] = -20;
  EXPECT_LT(MotionAt(31, 28.6f, down).y, -3);
  EXPECT_GT(MotionAt(31, 28.6f, up).y, 1);
  EXPECT_GT(MotionAt(31, 28.6f, WithUnit(5, 1)).y, 1.5);
}

TEST(HeadMotionTest, EyesLookWhereTheyAreTold) {
  FaceState state;
  state.gaze.left = state.gaze.right = {-10, 20};
  const auto mean = [](const std::vector<glm::vec3>& points) {
    glm::vec3 sum(0);
    for (const glm::vec3 p : points) sum += p;
    return sum / static_cast<float>(points.size());
  };
  const glm::vec3 m = mean(PointsOf(Material::kPupil, Vertices(state))) -
                      mean(PointsOf(Material::kPupil, Vertices({})));
  EXPECT_GT(m.x, 3);  // to the viewer's right
  EXPECT_GT(m.y, 1.5);
}

TEST(HeadMotionTest, HeadTurnsAndTheShouldersStay) {
  FaceState nod, turn, tilt;
  nod.head_rotation[0] = 20;
  turn.head_rotation[1] = 30;
  tilt.head_rotation[2] = 20;
  EXPECT_LT(MotionAt(0, -9, nod).y, -20);  // the nose goes down
  EXPECT_GT(MotionAt(0, -9, turn).x, 40);  // to the viewer's right
  EXPECT_GT(MotionAt(0, 60, tilt).x, 25);
  const HeadVertices rest = Vertices({});
  const HeadVertices turned = Vertices(turn);
  for (std::size_t i = 0; i < rest.position.size(); ++i) {
    if (rest.position[i].y > -190) continue;
    ASSERT_LT(glm::length(turned.position[i] - rest.position[i]), 0.01f);
  }
}

TEST(HeadMotionTest, TheNeckCarriesTheHeadForwardAndTheShouldersStay) {
  FaceState forward, back;
  forward.head_forward_mm = 30;
  back.head_forward_mm = -20;
  EXPECT_NEAR(MotionAt(0, -9, forward).z, 30, 0.5F);
  EXPECT_NEAR(MotionAt(0, -9, back).z, -20, 0.5F);
  EXPECT_NEAR(MotionAt(0, -9, forward).y, 0, 0.1F);
  const HeadVertices rest = Vertices({});
  const HeadVertices moved = Vertices(forward);
  for (std::size_t i = 0; i < rest.position.size(); ++i) {
    if (rest.position[i].y > -190) continue;
    ASSERT_LT(glm::length(moved.position[i] - rest.position[i]), 0.01f);
  }
}

TEST(HeadMotionTest, AsymmetryIsShownAsMuchAsTheStateAsks) {
  const auto head = MakeHead("galatea");
  HeadVertices v;
  const auto unlike = [&](float asymmetry) {
    FaceState smile = WithUnit(12, 1);
    smile.asymmetry = asymmetry;
    return std::abs(head->MeasureMouth(smile).width_mm - head->MeasureMouth({}).width_mm) +
           (head->Evaluate(smile, v), v.creases[3].right - v.creases[3].left);
  };
  const float none = unlike(0);
  EXPECT_NE(unlike(1), none);
  EXPECT_NEAR(unlike(2) - none, 2 * (unlike(1) - none), 0.05F);
  FaceState alike = WithUnit(12, 0.8F);
  alike.asymmetry = 0;
  head->Evaluate(alike, v);
  EXPECT_FLOAT_EQ(v.creases[3].right, v.creases[3].left);
}

}  // namespace
}  // namespace fsm
