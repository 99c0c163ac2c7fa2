// Maps of planes and of space, against truths that are known.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "hypermask/geometry/pinhole.h"

namespace hypermask {
namespace {

const Points kSquare{{0, 0}, {1, 0}, {1, 1}, {0, 1}};

TEST(PlaneMapTest, TheHomographyOfFourPointsHitsThem) {
  const Points to{{10, 20}, {110, 25}, {95, 130}, {5, 100}};
  const auto map = FitHomography(kSquare, to);
  ASSERT_TRUE(map);
  EXPECT_LT(RmsDistance(*map, kSquare, to), 1e-9);
}

TEST(PlaneMapTest, AHomographyIsFoundAgainFromManyPointsOfIt) {
  PlaneMap truth;
  truth << 1.2, -0.1, 30, 0.2, 0.9, -12, 3e-4, -2e-4, 1;
  Points from, to;
  for (int i = 0; i < 40; ++i) {
    from.emplace_back(17 * i % 320, 29 * i % 240);
    to.push_back(Apply(truth, from.back()));
  }
  const auto map = FitHomography(from, to);
  ASSERT_TRUE(map);
  EXPECT_LT((*map - truth).norm(), 1e-6);
}

TEST(PlaneMapTest, PointsThatDoNotFixAMapGiveNone) {
  const Points line{{0, 0}, {1, 1}, {2, 2}, {3, 3}};
  EXPECT_FALSE(FitHomography(line, kSquare));
  EXPECT_FALSE(FitAffine(line, kSquare));
  EXPECT_FALSE(FitHomography({{0, 0}, {1, 0}, {2, 0}, {0, 1}}, kSquare));
  EXPECT_FALSE(FitHomography({{0, 0}, {1, 0}, {1, 1}}, {{0, 0}, {1, 0}, {1, 1}}));
  EXPECT_FALSE(FitAffine({{0, 0}, {1, 0}}, {{0, 0}, {1, 0}}));
  const Points same(4, Point(3, 3));
  EXPECT_FALSE(FitHomography(same, kSquare));
}

// P C^T (C C^T)^-1 for C = rows (0 1 1 0), (0 0 1 1), (1 1 1 1), worked out by hand: the least
// squares plane of 0, 1, 3, 1 over the square is -0.25 + 1.5 x + 1.5 y.
TEST(PlaneMapTest, TheAffineMapIsThePapersLeastSquares) {
  const Points to{{0, 0}, {1, 0}, {3, 0}, {1, 0}};
  const auto map = FitAffine(kSquare, to);
  ASSERT_TRUE(map);
  EXPECT_NEAR((*map)(0, 0), 1.5, 1e-12);
  EXPECT_NEAR((*map)(0, 1), 1.5, 1e-12);
  EXPECT_NEAR((*map)(0, 2), -0.25, 1e-12);
  EXPECT_EQ((*map)(2, 0), 0);
  EXPECT_EQ((*map)(2, 2), 1);
}

TEST(PinholeTest, ThePoseOfAPlaneIsFoundInItsPicture) {
  const Pinhole camera = Pinhole::OfField(640, 480, 33);
  const Pose truth{(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY()) *
                    Eigen::AngleAxisd(-0.2, Eigen::Vector3d::UnitX()))
                       .toRotationMatrix(),
                   {120, -80, 1900}};
  // The sign and the size of a homography say nothing.
  const auto pose = PoseOfPlane(camera, -3.7 * PlaneToPicture(camera, truth));
  ASSERT_TRUE(pose);
  EXPECT_LT((pose->rotation - truth.rotation).norm(), 1e-9);
  EXPECT_LT((pose->position - truth.position).norm(), 1e-6);
}

TEST(PinholeTest, AFieldOf90DegreesHasAFocalLengthOfHalfItsHeight) {
  EXPECT_NEAR(Pinhole::OfField(640, 480, 90).focal, 240, 1e-9);
}

TEST(SpaceMapTest, AProjectorIsFoundFromPointsInSpaceAndNotFromAPlane) {
  const Pinhole projector = Pinhole::OfField(1280, 720, 26);
  std::vector<Eigen::Vector3d> in_space, in_plane;
  Points to, to_plane;
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d point(37 * i % 400 - 200, 53 * i % 300 - 150, 1700 + 71 * i % 700);
    in_space.push_back(point);
    to.push_back((projector.Matrix() * point).hnormalized());
    in_plane.emplace_back(point.x(), point.y(), 2000);
    to_plane.push_back((projector.Matrix() * in_plane.back()).hnormalized());
  }
  const auto map = FitSpaceMap(in_space, to);
  ASSERT_TRUE(map);
  const Eigen::Vector3d other(88, -33, 1234);
  EXPECT_LT((Apply(*map, other) - (projector.Matrix() * other).hnormalized()).norm(), 1e-6);
  EXPECT_FALSE(FitSpaceMap(in_plane, to_plane));
}

}  // namespace
}  // namespace hypermask
