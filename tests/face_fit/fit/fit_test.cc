#include "face_fit/fit/fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "fsm/base/table_reader.h"
#include "fsm/head/make_head.h"
#include "tests/face_fit/grey_image.h"
#include "tests/face_fit/network_fixture.h"

namespace facefit {
namespace {

using FitTest = NetworkTest;

CameraPose SomePose() {
  CameraPose pose;
  pose.focal_px = 1500;
  pose.centre_px = {400, 380};
  pose.rotation_rad = {0.05F, -0.1F, 0.07F};
  return pose;
}

/// What the network saw of a head, as if it were a photo.
FoundFace DetectedOf(const PerPoint<MeshPoint>& on_head, const std::vector<glm::vec3>& vertices) {
  FoundFace face;
  const CameraPose pose = SomePose();
  for (PointIndex i = 0; i < kNetworkPoints; ++i) {
    const glm::vec3 q = pose.ToCamera(on_head[i].On(vertices));
    face.points[i] = glm::vec3(pose.Project(q), q.z * pose.PixelsPerMm());
  }
  return face;
}

/// The head as a network would see it whose depth is true.
ObservedHead Exact(const ObservedHead& base) {
  return ObservedHead::Exact(fsm::MakeSymmetricHead("galatea"), base.name(), base.mesh_points());
}

TEST_F(FitTest, TheBuiltInHeadFittedToItselfHardlyMoves) {
  const ObservedHead& base = Galatea();
  const FoundFace face = DetectedOf(base.mesh_points(), base.rest().position);
  const ObservedHead exact = Exact(base);
  const FaceFit fit = FitFace(exact, face, EvenGreyImage(800));
  EXPECT_LT(glm::distance(fit.head.pose.rotation_rad, SomePose().rotation_rad), 0.01F);
  EXPECT_NEAR(fit.head.pose.focal_px, SomePose().focal_px, 10);
  ASSERT_EQ(fit.head.warp_points.size(), fit.constraints.size());
  for (std::size_t i = 0; i < fit.constraints.size(); ++i) {
    // The line between the lips is laid along the mouth without regard to the turn of the head.
    const float most_mm = fit.constraints[i].point ? 1 : 2.2F;
    EXPECT_LT(glm::length(fit.head.warp_points[i].displacement), most_mm);
  }
}

TEST_F(FitTest, ASmileIsTakenBackByTheUnitsOfOnesOwnTable) {
  const ObservedHead& base = Galatea();
  // Corners that rise steeply without going outward.
  const fsm::UnitTable own(fsm::Table("own.txt",
                                      "field 12 25 -42 22 25 both 0 11 0\n"
                                      "field 25 7 -38 20 11 above 0 1.4 0.2\n"
                                      "field 25 7 -45 24 16 below 0 -8 0\n"));
  ObservedHead built_in = Exact(base), moved = Exact(base);
  moved.UseUnits(own);
  Expression smiling;
  smiling.smile = 0.9F;
  smiling.lips_part = 0.9F;
  fsm::HeadVertices vertices;
  moved.head().Evaluate(smiling.State(), vertices);
  const FoundFace face = DetectedOf(base.mesh_points(), vertices.position);
  const auto most = [](const FaceFit& fit) {
    float far = 0;
    for (const auto& point : fit.head.warp_points)
      far = std::max(far, glm::length(point.displacement));
    return far;
  };
  const FaceFit fit = FitFace(moved, face, EvenGreyImage(800));
  EXPECT_NEAR(fit.head.expression.smile, smiling.smile, 0.1F);
  EXPECT_LT(most(fit), 2);
  EXPECT_GT(most(FitFace(built_in, face, EvenGreyImage(800))), 4) << "else this would say nothing";
  // The head as worn in the photo smiles by the same table.
  const std::size_t corner = 291;
  EXPECT_LT(
      glm::distance(fit.head.PositionOf(corner), base.mesh_points()[corner].On(vertices.position)),
      2);
}

}  // namespace
}  // namespace facefit
