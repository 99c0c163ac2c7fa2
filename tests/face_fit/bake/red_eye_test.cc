#include "face_fit/bake/red_eye.h"

#include <gtest/gtest.h>

namespace facefit {
namespace {

TEST(RedEyeTest, WhatAFlashThrowsBackIsDarkenedAndIrisesStay) {
  const RedEye eye({215, 190, 155}), warm({210, 140, 80});
  for (const glm::vec3 flash : {glm::vec3(225, 90, 90), {190, 60, 70}, {240, 130, 120}}) {
    const glm::vec3 pupil = eye.Without(flash, eye.Likelihood(flash));
    EXPECT_LT(pupil.r, 80) << flash.r;
    EXPECT_NEAR(pupil.r, pupil.g, 12) << flash.r;
  }
  // Brown in daylight and in weak warm light, amber, blue, a dark pupil, a white reflection.
  for (const glm::vec3 iris : {glm::vec3(110, 70, 40),
                               {70, 45, 35},
                               {150, 100, 45},
                               {90, 120, 160},
                               {25, 18, 16},
                               {250, 245, 240}}) {
    EXPECT_LT(eye.Likelihood(iris), 0.05F) << iris.r;
  }
  EXPECT_LT(warm.Likelihood({90, 45, 15}), 0.05F);
  // Where red has run over the edge it is taken away, too, but nothing else beside it.
  EXPECT_LT(eye.Without({110, 70, 65}, 1).r, 60);
  EXPECT_EQ(eye.Without({200, 195, 185}, 1), glm::vec3(200, 195, 185));
}

}  // namespace
}  // namespace facefit
