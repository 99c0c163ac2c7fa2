#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "face_track/model/seen_face.h"

namespace facetrack {

/// What a person's points did when the person showed one unit, on both sides alike.
struct ShownUnit {
  static constexpr float kLeastDose = 0.05F, kMostDose = 1.5F;
  int unit = 0;                  ///< of FACS
  float dose = 1;                ///< how strongly
  std::vector<glm::vec2> moved;  ///< kPoints, mm right and up from their rest, sizes as SeenFace's
};

/// Returns how the points of a usual face move with a unit of both sides, mm right and up.
std::vector<glm::vec2> UsualMotion(const SeenFace& face, int unit, float dose);

/// Returns the face of a person who has shown some units: these move as they were seen to, by less
/// at other doses, and differ less between heads; others stay as they are. A side
/// has what lies on it. REQUIRES: units of the face, each once, doses above 0.
SeenFace FaceOfPerson(SeenFace face, std::span<const ShownUnit> shown);

/// The table of a person's units: rows `shown UNIT DOSE X Y ...`, hundredths of a millimetre.
/// Errors of the reader: kBadValue "NAME:LINE: ..." for a unit that `face` does not have or that is
/// told twice, a dose out of 0.05 to 1.5, a point that moves by more than 100 mm.
std::string PrintShownUnits(std::span<const ShownUnit> shown);
vm::Result<std::vector<ShownUnit>> ParseShownUnits(const std::string& name, std::string_view text,
                                                   const SeenFace& face);

}  // namespace facetrack
