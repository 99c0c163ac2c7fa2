#include "face_fit/bake/openings.h"

#include <gtest/gtest.h>

#include "tests/face_fit/straight_mouth.h"

namespace facefit {
namespace {

TEST(PhotoOpeningsTest, TeethBetweenOpenLipsAreNoSkinAndTheLipsBesideThemOnlyInPart) {
  FoundFace face = StraightMouth();
  for (const std::size_t i : point::kLowerInnerLip) face.points[i].y += 12;
  const PhotoOpenings open(face, 2);
  EXPECT_EQ(open.SkinShare({100, 106}), 0);
  EXPECT_EQ(open.SkinShare({100, 99}), 0) << "the blurred edge";
  const float part = open.SkinShare({100, 97.6F});
  EXPECT_GT(part, 0.1F);
  EXPECT_LT(part, 0.9F);
  EXPECT_EQ(open.SkinShare({100, 90}), 1);
  EXPECT_EQ(open.SkinShare({20, 20}), 1);
  EXPECT_EQ(PhotoOpenings(StraightMouth(), 2).SkinShare({100, 100}), 1)
      << "closed lips are all skin";
}

}  // namespace
}  // namespace facefit
