#include "face_track/model/shown_units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "fsm/base/smooth_step.h"
#include "fsm/base/table_reader.h"

namespace facetrack {
namespace {

/// How much of what heads differ in is left once a person has shown a unit (docs/tracking.md).
constexpr float kStillVaries = 0.6F;
/// What a person does beyond what is usual comes later than the unit: with this power of how far
/// the unit goes.
constexpr float kLater = 1.5F;
constexpr float kMiddle = 8;        // mm aside from the middle of the face where both sides move
constexpr float kHundredths = 100;  // numbers of the table are hundredths of a millimetre
constexpr float kMostMoved = 100;

bool Shows(const Channel& channel, int unit) {
  return channel.kind == Channel::Kind::kUnit && channel.unit == unit;
}

float Size(const Points& motion) {
  float squares = 0;
  for (const glm::vec3& p : motion) squares += glm::dot(glm::vec2(p), glm::vec2(p));
  return std::sqrt(squares);
}

/// How much of what a point did belongs to a channel; the person's left is at the viewer's right.
float Share(const Channel& channel, float x) {
  if (channel.side.empty()) return 1;
  const float left = fsm::SmoothStep(-kMiddle, kMiddle, x);
  return channel.side == "L" ? left : 1 - left;
}

std::vector<ShownUnit> Read(const fsm::Table& table, const SeenFace& face) {
  std::vector<ShownUnit> shown;
  for (const fsm::TableRow& row : table.rows()) {
    if (row.key() != "shown") row.Refuse("expected 'shown'");
    ShownUnit unit{.unit = row.Integer(1),
                   .dose = row.Within(2, ShownUnit::kLeastDose, ShownUnit::kMostDose),
                   .moved = {}};
    const auto is_it = [&](const auto& other) { return other.unit == unit.unit; };
    if (std::ranges::none_of(face.channels, [&](const Channel& c) { return Shows(c, unit.unit); }))
      row.Refuse(fmt::format("unit {} is none that is followed", unit.unit));
    if (std::ranges::any_of(shown, is_it)) row.Refuse(fmt::format("{} is told twice", unit.unit));
    const std::vector<float> numbers = row.Numbers(3);
    if (numbers.size() != 2 * kPoints)
      row.Refuse(fmt::format("{} numbers found, {} expected", numbers.size(), 2 * kPoints));
    for (std::size_t i = 0; i < kPoints; ++i) {
      unit.moved.push_back(glm::vec2(numbers[2 * i], numbers[2 * i + 1]) / kHundredths);
      if (!(glm::length(unit.moved.back()) <= kMostMoved))
        row.Refuse(fmt::format("point {} moves by more than {} mm", i, kMostMoved));
    }
    shown.push_back(std::move(unit));
  }
  return shown;
}

}  // namespace

std::vector<glm::vec2> UsualMotion(const SeenFace& face, int unit, float dose) {
  std::vector<glm::vec2> moved(kPoints, glm::vec2(0));
  for (const Channel& channel : face.channels) {
    if (!Shows(channel, unit)) continue;
    for (std::size_t i = 0; i < kPoints; ++i) moved[i] += glm::vec2(channel.At(i, dose));
  }
  return moved;
}

SeenFace FaceOfPerson(SeenFace face, std::span<const ShownUnit> shown) {
  for (const ShownUnit& seen : shown) {
    std::vector<glm::vec2> beyond = UsualMotion(face, seen.unit, seen.dose);
    for (std::size_t i = 0; i < kPoints; ++i) beyond[i] = seen.moved[i] - beyond[i];
    for (Channel& channel : face.channels) {
      if (!Shows(channel, seen.unit)) continue;
      Points usual;
      for (std::size_t i = 0; i < kPoints; ++i) usual.push_back(channel.At(i, seen.dose));
      const float size = Size(usual);
      for (Points& motion : channel.motion) {
        const float part = std::pow(Size(motion) / size, kLater);
        for (std::size_t i = 0; i < kPoints; ++i)
          motion[i] += glm::vec3(part * Share(channel, face.rest[i].x) * beyond[i], 0);
      }
      for (float& v : channel.varies) v *= kStillVaries;
    }
  }
  return face;
}

std::string PrintShownUnits(std::span<const ShownUnit> shown) {
  std::string text =
      "# How one person's face moves; face_track --learn-units makes this file "
      "(docs/tracking.md).\n"
      "# shown UNIT DOSE X Y ...   what its 470 points did as it showed a unit of FACS on both\n"
      "# sides: hundredths of a millimetre to the viewer's right and up, on a head whose outer\n"
      "# corners of the eyes lie 90 mm apart\n";
  for (const ShownUnit& unit : shown) {
    text += fmt::format("shown {} {:g}", unit.unit, unit.dose);
    for (const glm::vec2 p : unit.moved)
      text += fmt::format(" {} {}", std::lround(p.x * kHundredths), std::lround(p.y * kHundredths));
    text += '\n';
  }
  return text;
}

vm::Result<std::vector<ShownUnit>> ParseShownUnits(const std::string& name, std::string_view text,
                                                   const SeenFace& face) {
  return fsm::ReadTable(name, text, [&face](const fsm::Table& table) { return Read(table, face); });
}

}  // namespace facetrack
