#include "face_fit/find/head/point_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

namespace facefit {
namespace {

/// A face of 2 x 36 points and a head just like it that stands turned, in decimetres.
struct Faces {
  glm::mat3 turn = glm::mat3_cast(glm::angleAxis(glm::radians(12.0F), glm::vec3(0, 1, 0)));
  std::vector<fsm::PointPair> pairs;

  Faces() {
    for (int row = 0; row < 6; ++row) {
      for (int column = 0; column < 6; ++column) {
        const float y = -75 + 25 * static_cast<float>(row);
        const float x = 6 + 11 * static_cast<float>(column);
        for (const float side : {-1.0F, 1.0F}) {
          const glm::vec3 p(side * x, y, 90 - 0.012F * (x * x + 0.3F * y * y));
          pairs.push_back({p, 0.01F * (turn * p) + glm::vec3(1, 2, 3), fsm::FaceFeature::kNone});
        }
      }
    }
  }
  /// Brings the head into our frame, `off` too far to the side.
  fsm::Similarity Place(float off_deg = 0) const {
    const glm::mat3 more =
        glm::mat3_cast(glm::angleAxis(glm::radians(off_deg), glm::vec3(0, 1, 0)));
    fsm::Similarity place;
    place.rotation = more * glm::transpose(turn);
    place.scale = 100;
    place.translation = -100.0F * (place.rotation * glm::vec3(1, 2, 3));
    return place;
  }
};

TEST(PointPairsTest, PointsThatMissTheCheekAreLeftOutAndDoNotTurnTheHead) {
  Faces faces;
  const std::size_t all = faces.pairs.size();
  // The outermost of one side lie on an ear, four centimetres behind.
  int strays = 0;
  for (auto& pair : faces.pairs) {
    if (pair.from.x < 60 || pair.from.y < -30) continue;
    pair.to += 0.01F * (faces.turn * glm::vec3(3, 0, -40));
    ++strays;
  }
  ASSERT_EQ(strays, 4);
  faces.pairs = RejectOutliers(faces.pairs);
  EXPECT_EQ(faces.pairs.size(), all - 4);
  const auto place = fsm::FitSimilarity(faces.pairs);
  const glm::vec3 ahead = place.rotation * (faces.turn * glm::vec3(0, 0, 1));
  EXPECT_LT(std::abs(glm::degrees(std::atan2(ahead.x, ahead.z))), 0.05F);
}

TEST(PointPairsTest, AWideFaceKeepsAllItsPoints) {
  Faces faces;
  const std::size_t all = faces.pairs.size();
  for (auto& pair : faces.pairs) {
    pair.to = 0.01F * (faces.turn * (glm::vec3(1.1F, 0.94F, 1.05F) * pair.from));
  }
  faces.pairs = RejectOutliers(faces.pairs);
  EXPECT_EQ(faces.pairs.size(), all);
}

TEST(PointPairsTest, PointsAreBalancedAboutTheHeadsOwnMiddleWhereverOneThoughtItToBe) {
  Faces faces;
  const auto before = faces.pairs;
  // The sides of a head that is looked at from three degrees beside are no mirror images in x.
  faces.pairs = Symmetrise(faces.Place(3), faces.pairs);
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_LT(glm::distance(faces.pairs[i].to, before[i].to), 0.001F) << i;  // a tenth millimetre
  }
}

TEST(PointPairsTest, APointAndItsOppositeShareWhatOneOfThemIsOff) {
  Faces faces;
  const auto before = faces.pairs;
  faces.pairs[20].to += 0.01F * (faces.turn * glm::vec3(0, 3, 0));
  const std::size_t other = 21;
  ASSERT_EQ(faces.pairs[20].from.x, -faces.pairs[other].from.x);
  faces.pairs = Symmetrise(faces.Place(), faces.pairs);
  for (const std::size_t i : {std::size_t{20}, other}) {
    const glm::vec3 off =
        100.0F * (glm::transpose(faces.turn) * (faces.pairs[i].to - before[i].to));
    EXPECT_NEAR(off.y, 1.5F, 0.05F) << i;
  }
}

TEST(PointPairsTest, OppositesThatDisagreeByFarStayAsTheyAre) {
  Faces faces;
  faces.pairs[20].to += 0.01F * (faces.turn * glm::vec3(0, 0, -20));
  const auto before = faces.pairs;
  faces.pairs = Symmetrise(faces.Place(), faces.pairs);
  EXPECT_LT(glm::distance(faces.pairs[20].to, before[20].to), 0.001F);
  EXPECT_LT(glm::distance(faces.pairs[21].to, before[21].to), 0.001F);
}

}  // namespace
}  // namespace facefit
