#include "face_fit/image/resample.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/face_fit/disc_image.h"

namespace facefit {
namespace {

TEST(ResampleTest, BesideAHardEdgeColoursStayWithinTheirRange) {
  const fsm::Image image = Painted([](glm::vec2 p) { return glm::vec3(p.x < 80 ? 0 : 255); });
  for (float x = 77; x < 83; x += 0.1F) {
    const float seen = SharpColourAt(image, {x, 50.5F}).r;
    EXPECT_GE(seen, 0);
    EXPECT_LE(seen, 255);
  }
}

TEST(ResampleTest, ColoursGoThroughTheirPixelsAndContoursAreStraight) {
  const fsm::Image image = Painted([](glm::vec2 p) { return glm::vec3(100 + p.x / 2, p.y, 40); });
  EXPECT_LT(glm::distance(SharpColourAt(image, {70.5F, 30.5F}), ColourAt(image, {70.5F, 30.5F})),
            0.01F);
  // Of a slanted edge in steps of pixels the contour wavers less than between straight lines.
  const FloatImage steps = FieldOf([](glm::vec2 p) { return p.y > 60 + p.x / 4 ? 1.0F : 0.0F; });
  const auto waver = [&](auto&& value) {
    float most = 0;
    for (float x = 40; x < 120; x += 0.25F) {
      float y = 60 + x / 4 - 4;
      while (value(x, y) < 0.5F) y += 0.02F;
      most = std::max(most, std::abs(y - (60 + x / 4)));
    }
    return most;
  };
  const float plain = waver([&](float x, float y) { return steps.SampleAt(x, y); });
  const float smooth = waver([&](float x, float y) { return SmoothAt(steps, {x, y}); });
  EXPECT_LT(smooth, 0.8F * plain);
}

}  // namespace
}  // namespace facefit
