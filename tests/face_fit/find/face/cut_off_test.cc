#include "face_fit/find/face/cut_off.h"

#include <gtest/gtest.h>

namespace facefit {
namespace {

/// A face in a photo of 200 pixels, its features from 60 to 140 and its outline from 20 to 180.
FoundFace SomeFace() {
  FoundFace face;
  face.points.fill(glm::vec3(100, 120, 0));
  const auto put = [&face](PointIndex i, float x, float y) { face.points[i] = {x, y, 0}; };
  for (const fsm::Side side : fsm::kSides) {
    for (const PointIndex i : point::kEyeOutline[side]) put(i, 100 + 30 * fsm::SignOf(side), 70);
  }
  put(point::kEyeOuterRight, 55, 70);
  put(point::kEyeOuterLeft, 145, 70);
  put(point::kMouthRight, 80, 120);
  put(point::kMouthLeft, 120, 120);
  put(point::kForehead, 100, 20);
  put(point::kChin, 100, 180);
  put(point::kCheekRight, 30, 90);
  put(point::kCheekLeft, 170, 90);
  return face;
}

/// The part of a face that a photo of that size from (left, top) shows.
FoundFace Shifted(FoundFace face, float left, float top) {
  for (glm::vec3& p : face.points) p -= glm::vec3(left, top, 0);
  return face;
}

fsm::Image Photo(int width, int height) { return {.width = width, .height = height, .rgba = {}}; }

TEST(CutOffTest, AWholeHeadHasNothingCutOff) {
  EXPECT_EQ(NamesOf(FindCutOffParts(SomeFace(), Photo(200, 200))), "");
  EXPECT_TRUE(CheckFeaturesShown(SomeFace(), Photo(200, 200)));
}

TEST(CutOffTest, WhatLiesBeyondTheEdgesIsNamed) {
  // An ear reaches some pixels farther aside than the cheek before it.
  const CutOffParts cut = FindCutOffParts(Shifted(SomeFace(), 25, 25), Photo(170, 150));
  EXPECT_TRUE(cut.forehead && cut.chin && cut.ears.right);
  EXPECT_FALSE(cut.ears.left);
  EXPECT_EQ(NamesOf(cut), "the forehead, the right ear, the chin");
}

TEST(CutOffTest, AFaceWhoseCornersCoincideIsRefused) {
  FoundFace no_width = SomeFace(), no_mouth = SomeFace();
  no_width.points[point::kEyeOuterLeft] = no_width.points[point::kEyeOuterRight];
  no_mouth.points[point::kMouthLeft] = no_mouth.points[point::kMouthRight];
  for (const FoundFace& face : {no_width, no_mouth}) {
    const auto shown = CheckFeaturesShown(face, Photo(200, 200));
    ASSERT_FALSE(shown);
    EXPECT_TRUE(shown.error().text.ends_with("lie in one place")) << shown.error().text;
  }
}

TEST(CutOffTest, AFaceWithoutAnEyeOrTheMouthIsRefused) {
  const auto no_eye = CheckFeaturesShown(Shifted(SomeFace(), 60, 0), Photo(140, 200));
  ASSERT_FALSE(no_eye);
  EXPECT_EQ(no_eye.error().code, vm::Errc::kBadValue);
  EXPECT_TRUE(no_eye.error().text.starts_with("the photo cuts off the right eye; "))
      << no_eye.error().text;
  const auto no_mouth = CheckFeaturesShown(SomeFace(), Photo(200, 110));
  ASSERT_FALSE(no_mouth);
  EXPECT_TRUE(no_mouth.error().text.starts_with("the photo cuts off the nose, the mouth; "));
}

}  // namespace
}  // namespace facefit
