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
  const auto contrast = [&](auto drawn) { return BridgeContrast(face, GreyImage(336, drawn)); };
  EXPECT_LT(contrast(nose), 0.03F);
  EXPECT_GT(contrast([&](glm::vec2 p) { return p.y > 196 && p.y < 204 ? 60 : nose(p); }),
            kGlassesContrast);
  EXPECT_GT(contrast([&](glm::vec2 p) { return p.y > 192 && p.y < 204 ? 230 : nose(p); }),
            kGlassesContrast)
      << "of clear plastic";
  EXPECT_LT(contrast([&](glm::vec2 p) { return p.y > 199.5F && p.y < 200.5F ? 120 : nose(p); }),
            kGlassesContrast)
      << "a fold is thin";
  EXPECT_LT(contrast([&](glm::vec2 p) { return p.y < 185 ? 50 : nose(p); }), kGlassesContrast)
      << "brows that meet have forehead above them, but farther away";
  EXPECT_LT(
      contrast([&](glm::vec2 p) { return p.y > 196 && p.y < 204 && p.x < 165 ? 60 : nose(p); }),
      kGlassesContrast)
      << "it has to go across";
  EXPECT_LT(contrast([&](glm::vec2 p) {
              return p.y > 196 && p.y < 202 && std::abs(p.x - 168) < 10.5F ? 60 : nose(p);
            }),
            kGlassesContrast)
      << "a crease of the brow is deep but short";
}

}  // namespace
}  // namespace facefit
