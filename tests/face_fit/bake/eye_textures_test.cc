#include "face_fit/bake/eye_textures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "face_fit/image/resample.h"
#include "fsm/head/make_head.h"
#include "tests/face_fit/grey_image.h"

namespace facefit {
namespace {

TEST(EyeTexturesTest, ShowTheWholeIrisAndTheWhiteWithoutIt) {
  // The built-in head as it would be seen by a camera of four pixels to the millimetre, whose eyes
  // look at it and are half hidden by their upper lids.
  auto head = fsm::MakeHead("galatea");
  fsm::HeadVertices rest;
  head->Evaluate({}, rest);
  PerPoint<MeshPoint> places;
  FoundFace face;
  FaceFit fit;
  std::vector<glm::vec2> centres;
  for (const fsm::Side side : fsm::kSides) {
    const glm::vec3 ball = head->EyeCentre(side);
    const glm::vec2 centre(500 + 4 * ball.x, 300 - 4 * ball.y);
    centres.push_back(centre);
    fit.irises.eyes[side] = {.circle = {.centre_px = centre, .radius_px = 24, .contrast = 0.4F},
                             .seen = true};
    for (std::size_t i = 0; i < 16; ++i) {
      const auto point = point::kEyeOutline[side][i];
      const float part = static_cast<float>(i <= 8 ? i : 16 - i) / 4 - 1;  // outer -1, inner 1
      const float x = (-13.0F * fsm::SignOf(side)) * part;
      const float open = i % 8 == 0 ? 0.0F : i < 8 ? 3.0F : -6.0F;
      face.points[point] = glm::vec3(centre + 4.0F * glm::vec2(x, -open), 0);
      // The nearest vertex of the skin stands for the place on the mesh.
      float nearest = 1e9F;
      for (std::uint32_t v = 0; v < rest.position.size(); ++v) {
        const glm::vec3 off = rest.position[v] - ball;
        const float far = glm::distance(glm::vec2(off), {x, open}) + (off.z < 4 ? 100.0F : 0.0F);
        if (far >= nearest) continue;
        nearest = far;
        places[point].corner = {v, v, v};
      }
    }
  }
  const ObservedHead base = ObservedHead::Exact(std::move(head), "galatea", places);
  fit.head.base = &base;
  const fsm::Image photo = GreyImage(1000, [&](glm::vec2 p) {
    for (const glm::vec2 centre : centres) {
      const glm::vec2 off = p - centre;
      if (std::abs(off.x) > 60 || off.y < -12 || off.y > 24) continue;
      return glm::length(off) < 24 ? 40 : 220;
    }
    return 130;
  });
  fsm::Image image{.width = 1024, .height = 512, .rgba = {}};
  image.rgba.assign(std::size_t{4} * 1024 * 512, 255);
  const auto both = PaintEyes(face, fit, {}, photo, image);
  ASSERT_TRUE(both);
  for (const fsm::EyePicture& eye : both->InOrder()) {
    const auto shown = [&](const glm::vec4& square, glm::vec2 part) {
      const glm::vec2 at = glm::mix(glm::vec2(square.x, square.y), {square.z, square.w}, part);
      return ColourAt(image, at * glm::vec2(1024, 512)).g;
    };
    EXPECT_NEAR(shown(eye.iris, {0.5F, 0.5F}), 40, 3);
    EXPECT_NEAR(shown(eye.iris, {0.5F, 0.15F}), 40, 12) << "what the lid hides is completed";
    EXPECT_NEAR(shown(eye.iris, {0.02F, 0.6F}), 220, 12) << "beside it is the white";
    EXPECT_NEAR(shown(eye.ball, {0.5F, 0.5F}), 220, 12) << "no iris is left in the white";
    EXPECT_NEAR(shown(eye.ball, {0.2F, 0.55F}), 220, 12);
  }
  // Nothing of the face is painted there.
  const auto& uv = base.surface().uv;
  for (std::size_t v = 0; v < uv.size(); ++v) {
    if (base.rest().position[v].y < -90 || base.rest().position[v].z < 0) continue;
    EXPECT_GT(uv[v].y, 0.14F);
  }
  // Hair before one eye: the other stands in for it, but not if that is hardly open.
  fsm::Image hidden = photo;
  for (int y = 200; y < 400; ++y) {
    const auto row = hidden.rgba.begin() + 4 * (y * 1000 + 500);
    std::fill(row, row + 4 * 500, std::uint8_t{130});
  }
  fit.irises.eyes.left.seen = false;
  const auto one_hidden = PaintEyes(face, fit, {}, hidden, image);
  ASSERT_TRUE(one_hidden);
  const auto& [right, left] = *one_hidden;
  for (const glm::vec2 part : {glm::vec2(0.5F, 0.5F), {0.02F, 0.6F}, {0.2F, 0.8F}}) {
    const auto at = [&](const glm::vec4& square, glm::vec2 p) {
      return ColourAt(image, glm::mix(glm::vec2(square.x, square.y), {square.z, square.w}, p) *
                                 glm::vec2(1024, 512))
          .g;
    };
    EXPECT_NEAR(at(left.iris, part), at(right.iris, {1 - part.x, part.y}), 2) << part.x;
    EXPECT_NEAR(at(left.ball, part), at(right.ball, {1 - part.x, part.y}), 2) << part.x;
  }
  fit.irises.eyes.right.circle.contrast = 0.08F;
  EXPECT_FALSE(PaintEyes(face, fit, {}, hidden, image))
      << "eyes that are not seen clearly are drawn";
}

}  // namespace
}  // namespace facefit
