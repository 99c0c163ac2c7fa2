#include "fsm/render/face_landmarks.h"

#include <string>

namespace fsm {

std::optional<FaceLandmarks> FaceLandmarks::Find(const Head& head) {
  bool complete = true;
  const auto at = [&](const std::string& name) {
    const auto found = head.landmarks().find(name);
    complete = complete && found != head.landmarks().end();
    return complete ? found->second : glm::vec3(0);
  };
  const auto both = [&at](const std::string& name) {
    return Sided<glm::vec3>{at(name + "_right"), at(name + "_left")};
  };
  const FaceLandmarks landmarks{.nasion = at("nasion"),
                                .pronasale = at("pronasale"),
                                .subnasale = at("subnasale"),
                                .stomion = at("stomion"),
                                .gnathion = at("gnathion"),
                                .trichion = at("trichion"),
                                .cheilion = both("cheilion"),
                                .endocanthion = both("endocanthion"),
                                .exocanthion = both("exocanthion"),
                                .pupil = both("pupil"),
                                .alare = both("alare"),
                                .zygion = both("zygion")};
  return complete ? std::optional(landmarks) : std::nullopt;
}

}  // namespace fsm
