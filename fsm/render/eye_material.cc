#include "fsm/render/eye_material.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "embedded/eye_fragment.h"
#include "embedded/eye_vertex.h"

namespace fsm {

EyeMaterial::EyeMaterial(const GlFunctions& gl, const Appearance& appearance)
    : program_(
          CompileLit(gl, appearance, "eye", {embedded::eye_vertex()}, embedded::eye_fragment())) {}

void EyeMaterial::Begin(const MaterialFrame& frame) const {
  if (!frame.head.eyes().found()) return;
  const auto eyes = frame.head.eyes().Measure(frame.vertices);
  const HeadTopology& topology = frame.head.topology();
  const EyeGeometry& look = topology.eyes.right;  // sizes and colours, which both eyes share
  // The white of a grey photo is grey, and so is the flesh beside it.
  const glm::vec3 white = look.white_colour;
  const bool grey = std::abs(white.r - white.g) + std::abs(white.g - white.b) < 0.02F * white.g;
  const bool pictured = frame.head.photo() && topology.portrait.eyes;
  program_.Use();
  SetEyeballs(frame.view, eyes, look);
  program_.Set("flesh_red", grey ? 0.0F : 1.0F);
  program_.Set("photo_brightness", frame.head.photo() ? frame.photo_brightness : 0.0F);
  program_.Set("iris_span", pictured ? kIrisSpan : 0.0F);
  program_.Set("photo", 1);
  if (pictured) SetPictures(frame, eyes);
}

void EyeMaterial::SetEyeballs(const View& view, const Sided<EyeFrame>& eyes,
                              const EyeGeometry& look) const {
  const glm::mat3 turn(view.figure_to_world);
  const float scale = glm::length(turn[0]);
  std::array<glm::vec4, 2> balls, lids{};
  std::array<glm::vec3, 2> gazes;
  for (const Side side : kSides) {
    const EyeFrame& eye = eyes[side];
    const auto i = static_cast<std::size_t>(side);
    const auto to_world = [&view](const glm::vec3& p) {
      return glm::vec3(view.figure_to_world * glm::vec4(p, 1.0F));
    };
    balls[i] = glm::vec4(to_world(eye.centre), eye.radius * scale);
    gazes[i] = turn * eye.gaze / scale;
    const glm::vec3 front = eye.centre + eye.gaze * eye.radius;
    lids[i].x = to_world({front.x, eye.upper_lid_y, front.z}).y;
    lids[i].y = to_world({front.x, eye.lower_lid_y, front.z}).y;
  }
  const EyeFrame& first = eyes.right;  // both are as large
  const float plane = std::sqrt(
      std::max(first.radius * first.radius - first.iris_radius * first.iris_radius, 1.0F));
  program_.Set("ball", balls);
  program_.Set("gaze", gazes);
  program_.Set("lids", lids);
  program_.Set("iris", glm::vec4(first.iris_radius * scale, look.pupil_radius / look.iris_radius,
                                 plane * scale, 0.0F));
  program_.Set("iris_color", look.iris_colour);
  program_.Set("white_color", look.white_colour);
  program_.Set("figure_scale", scale);
}

void EyeMaterial::SetPictures(const MaterialFrame& frame, const Sided<EyeFrame>& eyes) const {
  const Sided<EyePicture>& pictures = *frame.head.topology().portrait.eyes;
  std::array<glm::vec4, 2> irises, balls, open;
  for (const Side side : kSides) {
    const auto i = static_cast<std::size_t>(side);
    const EyeFrame& rest = frame.head.resting_eyes()[side];
    const EyeFrame& eye = eyes[side];
    irises[i] = pictures[side].iris;
    balls[i] = pictures[side].ball;
    open[i] = {rest.upper_lid_y - rest.centre.y, rest.lower_lid_y - rest.centre.y,
               eye.upper_lid_y - eye.centre.y, kBallSpan * eye.radius};
  }
  program_.Set("irises", irises);
  program_.Set("balls", balls);
  program_.Set("open", open);
  program_.Set("world_to_head", glm::inverse(frame.rest_to_world));
}

}  // namespace fsm
