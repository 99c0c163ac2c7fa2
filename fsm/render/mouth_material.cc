#include "fsm/render/mouth_material.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "embedded/mouth_vertex.h"
#include "embedded/surface_common.h"
#include "embedded/surface_fragment.h"

namespace fsm {

MouthMaterial::MouthMaterial(const GlFunctions& gl, const Appearance& appearance)
    : appearance_(appearance),
      program_(CompileLit(
          gl, appearance, "mouth", {embedded::surface_common(), embedded::mouth_vertex()},
          embedded::surface_fragment(),
          ShaderConstant("kRelief", true) + ShaderConstant("kColumns", MouthFinder::kColumns))) {}

float MouthMaterial::gap_mm() const {
  constexpr std::size_t kMiddle = MouthFinder::kColumns / 2;
  if (!opening_) return 0;
  return opening_->lips[kMiddle].y - opening_->lips[kMiddle + MouthFinder::kColumns].y;
}

float MouthMaterial::jaw_drop_mm() const {
  constexpr float kOverlap = 1.3f;  // at rest the lower incisors stand behind the upper ones
  return opening_ ? std::max(opening_->teeth.x - opening_->teeth.y + kOverlap, 0.0f) : 0;
}

void MouthMaterial::Begin(const MaterialFrame& frame) {
  opening_ = frame.head.mouth.Measure(frame.vertices);
  if (!opening_) return;
  const glm::mat3 rotation(frame.view.figure_to_world);
  const glm::mat3 to_world =
      rotation / glm::length(rotation[0]) * glm::transpose(glm::mat3(opening_->to_mouth));
  const bool photo = frame.head.base_colour() != nullptr;
  const glm::vec3 key =
      glm::mix(glm::transpose(to_world) * frame.lamps.directions[0], appearance_.mouth_key_from,
               photo ? appearance_.photo_mouth_ahead : appearance_.mouth_key_ahead);
  program_.Use();
  program_.Set("to_mouth", opening_->to_mouth);
  program_.Set("mouth_to_world", to_world);
  program_.Set("lips", opening_->lips);
  program_.Set("mouth_edges", glm::vec4(opening_->corners, opening_->teeth));
  program_.Set("front_gain", photo ? appearance_.photo_mouth_front : appearance_.mouth_front);
  program_.Set("deep_gain", photo ? appearance_.photo_mouth_deep : appearance_.mouth_deep);
  program_.Set("mouth_key", glm::normalize(key));
}

}  // namespace fsm
