#include "face_fit/find/face/glasses.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/face_fit/grey_image.h"

namespace facefit {
namespace {

TEST(GlassesTest, ABarAcrossTheNoseIsSeenAndAFoldIsNot) {
  FoundFace face;
  face.points[133] = glm::vec3(136, 200, 0);  // inner corners, two pixels to the millimetre
  face.points[362] = glm::vec3(200, 200, 0);
  // A nose that grows darker downwards.
  const auto nose = [](glm::vec2 p) { return 170 - 0.15F * (p.y - 150); };
  const auto wears = [&](auto drawn) { return WearsGlasses(face, GreyImage(336, drawn)); };
  EXPECT_FALSE(wears(nose));
  EXPECT_TRUE(wears([&](glm::vec2 p) { return p.y > 196 && p.y < 204 ? 60 : nose(p); }));
  EXPECT_TRUE(wears([&](glm::vec2 p) { return p.y > 192 && p.y < 204 ? 230 : nose(p); }))
      << "of clear plastic";
  EXPECT_FALSE(wears([&](glm::vec2 p) { return p.y > 199.5F && p.y < 200.5F ? 120 : nose(p); }))
      << "a fold is thin";
  EXPECT_FALSE(wears([&](glm::vec2 p) { return p.y < 185 ? 50 : nose(p); }))
      << "brows that meet have forehead above them, but farther away";
  EXPECT_FALSE(wears([&](glm::vec2 p) {
    return p.y > 196 && p.y < 204 && p.x < 165 ? 60 : nose(p);
  })) << "it has to go across";
  EXPECT_FALSE(wears([&](glm::vec2 p) {
    return p.y > 196 && p.y < 202 && std::abs(p.x - 168) < 10.5F ? 60 : nose(p);
  })) << "a crease of the brow is deep but short";
}

}  // namespace
}  // namespace facefit
