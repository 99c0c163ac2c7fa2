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
  if (!frame.head.eyes.found()) return;
  const auto eyes = frame.head.eyes.Measure(frame.vertices);
  const HeadSurface& surface = *frame.head.surface;
  // On a grey photo the sclera is grey, and so is the caruncle beside it.
  const glm::vec3 white = surface.eyes.right.white_colour;
  const bool grey = std::abs(white.r - white.g) + std::abs(white.g - white.b) < 0.02f * white.g;
  const bool pictured = frame.head.base_colour() && surface.portrait.eyes;
  program_.Use();
  SetEyeballs(frame.view, eyes, surface.eyes);
  program_.Set("flesh_red", grey ? 0.0f : 1.0f);
  program_.Set("beside_photo", frame.head.base_colour() != nullptr);
  program_.Set("lamp_brightness", frame.lamp_brightness);
  program_.Set("pictured", pictured);
  program_.Set("base_colour", TextureUnit::kBaseColour);
  if (pictured) SetPictures(frame, eyes);
}

void EyeMaterial::SetEyeballs(const FrameCamera& view, const Sided<MeasuredEye>& eyes,
                              const Sided<EyeGeometry>& geometry) const {
  const glm::mat3 rotation(view.figure_to_world);
  const float scale = glm::length(rotation[0]);
  std::array<glm::vec4, 2> balls, lid_heights{};
  std::array<glm::vec3, 2> gazes, iris_colours, white_colours;
  for (const Side side : kSides) {
    const MeasuredEye& eye = eyes[side];
    const auto i = static_cast<std::size_t>(side);
    const auto to_world = [&view](const glm::vec3& p) {
      return glm::vec3(view.figure_to_world * glm::vec4(p, 1.0f));
    };
    balls[i] = glm::vec4(to_world(eye.centre), eye.radius * scale);
    gazes[i] = rotation * eye.gaze / scale;
    iris_colours[i] = geometry[side].iris_colour;
    white_colours[i] = geometry[side].white_colour;
    const glm::vec3 front = eye.centre + eye.gaze * eye.radius;
    lid_heights[i].x = to_world({front.x, eye.upper_lid_y, front.z}).y;
    lid_heights[i].y = to_world({front.x, eye.lower_lid_y, front.z}).y;
  }
  const MeasuredEye& first = eyes.right;  // both have the same size
  const float plane = std::sqrt(
      std::max(first.radius * first.radius - first.iris_radius * first.iris_radius, 1.0f));
  program_.Set("ball", balls);
  program_.Set("gaze", gazes);
  program_.Set("lid_heights", lid_heights);
  program_.Set("iris_radius", first.iris_radius * scale);
  program_.Set("pupil_share", geometry.right.pupil_radius / geometry.right.iris_radius);
  program_.Set("iris_depth", plane * scale);
  program_.Set("iris_colour", iris_colours);
  program_.Set("white_colour", white_colours);
  program_.Set("figure_scale", scale);
}

void EyeMaterial::SetPictures(const MaterialFrame& frame, const Sided<MeasuredEye>& eyes) const {
  const Sided<EyePicture>& pictures = *frame.head.surface->portrait.eyes;
  std::array<glm::vec4, 2> iris_rect, ball_rect, lid_heights;
  for (const Side side : kSides) {
    const auto i = static_cast<std::size_t>(side);
    const MeasuredEye& rest = frame.head.resting_eyes[side];
    const MeasuredEye& eye = eyes[side];
    iris_rect[i] = pictures[side].iris;
    ball_rect[i] = pictures[side].ball;
    lid_heights[i] = {rest.upper_lid_y - rest.centre.y, rest.lower_lid_y - rest.centre.y,
                      eye.upper_lid_y - eye.centre.y, kBallSpan * eye.radius};
  }
  program_.Set("iris_span", kIrisSpan);
  program_.Set("photo_iris_rect", iris_rect);
  program_.Set("photo_ball_rect", ball_rect);
  program_.Set("photo_lid_heights", lid_heights);
  program_.Set("world_to_head", glm::inverse(frame.rest_to_world));
}

}  // namespace fsm
