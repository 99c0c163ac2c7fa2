// The head's motion out of recordings, and the analyses on shapes that are known.

#include "face_space/eigen/head_motion.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numeric>

#include "face_space/eigen/eigen_units.h"

namespace facespace {
namespace {

constexpr Eigen::Index kMarkers = 30;

Eigen::Matrix3Xd SomeFace() {
  Eigen::Matrix3Xd face(3, kMarkers);
  for (Eigen::Index m = 0; m < kMarkers; ++m) {
    const auto k = static_cast<double>(m);
    face.col(m) << 60 * std::sin(1.7 * k), 80 * std::cos(2.3 * k), 20 * std::sin(0.9 * k + 1);
  }
  return face;
}

/// 20 markers stay; each of the others goes its own way and back by `shape` in a second, meanwhile
/// the head turns.
Recording Moving(const std::string& name, double size, int axis) {
  Recording recording{.name = name, .markers = {}, .ms = {}, .places = {}};
  for (Eigen::Index m = 0; m < kMarkers; ++m) recording.markers.push_back("m" + std::to_string(m));
  recording.places.resize(3 * kMarkers, 150);
  for (Eigen::Index t = 0; t < 150; ++t) {
    const double ms = 10.0 * static_cast<double>(t);
    recording.ms.push_back(ms);
    Eigen::Matrix3Xd face = SomeFace();
    const double wave = std::sin(3.14159265 * std::clamp((ms - 250) / 1000, 0.0, 1.0));
    for (Eigen::Index m = 20; m < kMarkers; ++m)
      face(axis, m) += size * wave * (m % 2 == 0 ? 1 : 0.5);
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(0.3 * std::sin(ms / 400), Eigen::Vector3d(1, 2, 0.5).normalized())
            .toRotationMatrix();
    face = (turn * face).colwise() + Eigen::Vector3d(ms / 50, -3, 7);
    recording.places.col(t) = face.reshaped();
  }
  return recording;
}

TEST(HeadMotionTest, ATurnAndAShiftAreFoundAgain) {
  const Eigen::Matrix3Xd face = SomeFace();
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -1, 2).normalized()).toRotationMatrix();
  const Eigen::Vector3d shift(5, -20, 3);
  std::vector<Eigen::Index> all(kMarkers);
  std::iota(all.begin(), all.end(), 0);
  const RigidMove move = FitRigid(face, (turn * face).colwise() + shift, all);
  EXPECT_LT((move.turn - turn).norm(), 1e-9);
  EXPECT_LT((move.shift - shift).norm(), 1e-9);
}

TEST(HeadMotionTest, AMirroredFaceIsNotTakenForATurn) {
  Eigen::Matrix3Xd mirrored = SomeFace();
  mirrored.row(0) *= -1;
  std::vector<Eigen::Index> all(kMarkers);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_NEAR(FitRigid(SomeFace(), mirrored, all).turn.determinant(), 1, 1e-9);
}

TEST(HeadMotionTest, WhatIsLeftIsTheFaceAlone) {
  const auto still = RemoveHeadMotion({Moving("a", 8, 1)}, {});
  ASSERT_TRUE(still) << still.error().text;
  for (const Eigen::Index m : still->rest.still)
    EXPECT_LT(m, 20) << "those that move are not still";
  const Eigen::MatrixXd& moves = still->faces[0].moves;
  EXPECT_LT(moves.topRows(60).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_NEAR(moves.row(3 * 20 + 1).maxCoeff(), 8, 0.02);
  EXPECT_NEAR(moves.row(3 * 21 + 1).maxCoeff(), 4, 0.02);
}

TEST(HeadMotionTest, MarkersCanBeNamedStill) {
  const auto still = RemoveHeadMotion({Moving("a", 8, 1)}, {.still = {"m0", "m1", "m2", "m3"}});
  ASSERT_TRUE(still) << still.error().text;
  EXPECT_EQ(still->rest.still.size(), 4U);
  const auto unknown = RemoveHeadMotion({Moving("a", 8, 1)}, {.still = {"m0", "m1", "nose"}});
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().text.find("'nose'"), std::string::npos);
}

TEST(HeadMotionTest, AFaceThatDoesNotMoveIsRefused) {
  const auto still = RemoveHeadMotion({Moving("a", 0, 1)}, {});
  ASSERT_FALSE(still);
  EXPECT_NE(still.error().text.find("nothing moves"), std::string::npos);
}

TEST(HeadMotionTest, MarkersOnALineAreRefused) {
  Recording line = Moving("a", 8, 1);
  for (Eigen::Index m = 0; m < kMarkers; ++m) {
    line.places.middleRows<3>(3 * m).colwise() = Eigen::Vector3d(0, static_cast<double>(m), 0);
  }
  EXPECT_FALSE(RemoveHeadMotion({line}, {}));
}

TEST(EigenUnitsTest, TwoMovementsAreTwoFaceVectorsThatHoldAllVariance) {
  const auto still = RemoveHeadMotion({Moving("a", 8, 1), Moving("b", 5, 2)}, {});
  ASSERT_TRUE(still);
  const auto units = FindEigenUnits(*still, {.share = 0.999}, {.share = 0.999});
  ASSERT_TRUE(units) << units.error().text;
  ASSERT_EQ(units->face.count(), 2);
  EXPECT_NEAR(units->face.Share(0), 64.0 / (64 + 25), 0.01);
  EXPECT_NEAR(units->face.Share(0) + units->face.Share(1), 1, 1e-4);
  EXPECT_LT(units->by_face.worst, 0.05);
  EXPECT_EQ(units->performances.size(), 2U);
  EXPECT_EQ(units->motion.count(), 2) << "each goes its own way in time";
  EXPECT_LT(units->by_motion.worst, 0.05);
  const double dot = units->face.vectors.col(0).dot(units->face.vectors.col(1));
  EXPECT_NEAR(dot, 0, 1e-9) << "face vectors are orthogonal";
}

TEST(EigenUnitsTest, UnitsThatAreNeverApartCannotBeToldApart) {
  const auto still = RemoveHeadMotion({Moving("a", 8, 1), Moving("b", 5, 2)}, {});
  const auto units = FindEigenUnits(*still, {}, {});
  ASSERT_TRUE(units);
  const auto apart = TakeApart(*units, {{{"up", 1}}, {{"out", 1}}});
  ASSERT_TRUE(apart) << apart.error().text;
  EXPECT_NEAR((*apart)[0].moves[3 * 20 + 1], 8, 0.3);
  EXPECT_NEAR((*apart)[1].moves[3 * 21 + 2], 2.5, 0.2);
  const auto together = TakeApart(*units, {{{"up", 1}, {"out", 1}}, {{"up", 1}, {"out", 1}}});
  ASSERT_FALSE(together);
  EXPECT_NE(together.error().text.find("cannot be told apart"), std::string::npos);
}

}  // namespace
}  // namespace facespace
