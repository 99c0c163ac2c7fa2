#include "face_fit/find/figure/figure_finder.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/face_fit/disc_image.h"

namespace facefit {
namespace {

TEST(FigureTest, WhatOnlyOneSideOfAHeadShowsIsDoubtedAndRatherThereIfItLooksAlike) {
  FoundFace face;
  face.points[10] = glm::vec3(kDiscSide / 2, 40, 0);
  face.points[152] = glm::vec3(kDiscSide / 2, 140, 0);
  // The network missed an ear on the left, and on the right saw hair that the left has none of.
  const auto ear = [](glm::vec2 p) { return std::abs(p.y - 90) < 10; };
  const fsm::Image photo = Painted([&](glm::vec2 p) {
    const float off = std::abs(p.x - kDiscSide / 2);
    if (off > 50) return kSky;
    return ear(p) || off < 30 ? glm::vec3(220, 170, 140) : p.x < kDiscSide / 2 ? kSky : kHair;
  });
  FloatImage person(kDiscSide, kDiscSide);
  const auto at = [&person](int x, int y) -> float& { return person(x, y); };
  for (int y = 0; y < kDiscSide; ++y) {
    for (int x = kDiscSide / 2 - 30; x < kDiscSide / 2 + 50; ++x) at(x, y) = 1;
  }
  person = SymmetriseHead(face, photo, person);
  EXPECT_GT(at(kDiscSide / 2 - 40, 90), 0.75F) << "the ear";
  EXPECT_NEAR(at(kDiscSide / 2 - 40, 60), 0.5F, 0.1F) << "no hair";
  EXPECT_EQ(at(kDiscSide / 2 - 60, 90), 0) << "neither side";
  EXPECT_EQ(at(kDiscSide / 2 - 40, 150), 0) << "clothes need not be alike";
  EXPECT_EQ(at(kDiscSide / 2 + 40, 60), 1);
}

}  // namespace
}  // namespace facefit
