// The light of a photo, read from the skin of a face in it.

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "fsm/head/face_light.h"

namespace fsm {
namespace {

constexpr glm::vec3 kSkin(0.8f, 0.6f, 0.5f);

/// A ball of skin that is lit from above and from the right.
std::vector<FaceLight::Patch> LitBall() {
  std::vector<FaceLight::Patch> ball;
  for (int y = -8; y <= 8; ++y) {
    for (int x = -8; x <= 8; ++x) {
      const glm::vec3 n = glm::normalize(glm::vec3(x, y, 10));
      ball.push_back({n, kSkin * std::sqrt(0.5f + 0.35f * n.y - 0.2f * n.x)});
    }
  }
  return ball;
}

void ExpectItsLight(const FaceLight& light, float tolerance) {
  const auto should = [](glm::vec3 n) {
    return ScreenBrightness(kSkin) * std::sqrt(0.5f + 0.35f * n.y - 0.2f * n.x);
  };
  for (const glm::vec3 n :
       {glm::vec3(0, 0, 1), {0, 0.6f, 0.8f}, {0, -0.6f, 0.8f}, {0.6f, 0, 0.8f}}) {
    EXPECT_NEAR(light.On(n), should(n), tolerance) << n.x << " " << n.y;
  }
}

TEST(FaceLightTest, ItIsFoundFromHowBrightSkinIsThatFacesEveryWay) {
  ExpectItsLight(FaceLight(LitBall()), 0.01f);
}

TEST(FaceLightTest, ABeardDoesNotMakeItComeFromAbove) {
  auto ball = LitBall();
  for (auto& patch : ball) {
    if (patch.normal.y < -0.35f && std::abs(patch.normal.x) < 0.35f) patch.screen = glm::vec3(0.1f);
  }
  ExpectItsLight(FaceLight(ball), 0.04f);
}

TEST(FaceLightTest, WithoutSkinOrInTheDarkItHasALeast) {
  EXPECT_GT(FaceLight({}).On({0, 0, 1}), 0.09f);
  auto ball = LitBall();
  for (auto& patch : ball) patch.screen = glm::vec3(0);
  const float dark = FaceLight(ball).On({0, 1, 0});
  EXPECT_GE(dark, 0.09f);
  EXPECT_LT(dark, 0.11f);
}

}  // namespace
}  // namespace fsm
