#include "fsm/head/landmarks.h"

#include <algorithm>
#include <cmath>

#include "embedded/landmarks.h"
#include "fsm/base/pi.h"
#include "fsm/head/ear_parts.h"

namespace fsm {

Landmarks NameLandmarks(const Cage& cage, const FineSkin& fine, std::span<const glm::vec3> rest,
                        const EyeAnatomy& eye, const Sided<EyeTransform>& eye_transforms,
                        const Features& features) {
  Landmarks landmarks;
  const auto pair = [&](const std::string& name, glm::vec3 p) {
    landmarks[name + "_left"] = p;
    landmarks[name + "_right"] = {-p.x, p.y, p.z};
  };
  const Table table("tables/landmarks.txt", embedded::landmarks());
  for (const TableRow& row : table.rows()) {
    const glm::vec3 p = rest[fine.of_cage[CagePoint(cage, row, row.Word(2))]];
    if (row.key() == "middle") {
      landmarks[row.Word(1)] = p;
    } else if (row.key() == "side") {
      pair(row.Word(1), p);
    } else {
      row.Refuse("middle or side expected");
    }
  }
  const float middle = eye.centre().x;
  for (const Side side : kSides) {
    const glm::vec3 mirror(SignOf(side), 1, 1);
    const auto put = [&](const char* name, glm::vec3 p) {
      landmarks[name + std::string(side == Side::kRight ? "_right" : "_left")] =
          eye_transforms[side].PointInFace(mirror * eye.centre(), mirror * p);
    };
    const auto on_lid = [&](float x, float y) {
      return glm::vec3(x, y, eye.LidAxisZ(x) + eye.LidRadius(x));
    };
    put("endocanthion", on_lid(eye.inner_x(), eye.UpperY(eye.inner_x())));
    put("exocanthion", on_lid(eye.outer_x(), eye.UpperY(eye.outer_x())));
    put("palpebrale_superius", on_lid(middle, eye.UpperY(middle) + eye_transforms[side].upper_mm));
    put("palpebrale_inferius", on_lid(middle, eye.LowerY(middle) + eye_transforms[side].lower_mm));
    put("pupil", eye.centre() + glm::vec3(0, 0, eye.radius()));
  }
  pair("tragion", {65.7f, 0, 0});
  for (const auto& [name, place] : EarLandmarks(features)) pair(name, place);
  return landmarks;
}

glm::vec2 SkinUv(glm::vec3 p) {
  const float turn = std::atan2(p.x, p.z) / kPi;  // -1..1, 0 at the front
  const float share = std::abs(turn);
  constexpr float kFront = 1.0f / 3;
  const float wide = share < kFront ? 0.6f * share / kFront : 0.6f + 0.6f * (share - kFront);
  return {0.5f + std::copysign(0.5f * wide, turn), std::clamp((p.y + 200) / 340, 0.0f, 1.0f)};
}

}  // namespace fsm
