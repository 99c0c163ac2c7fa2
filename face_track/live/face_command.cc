#include "face_track/live/face_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace facetrack {
namespace {

constexpr float kStep = 0.01F;  // smaller changes nobody sees

/// A pair of codes of fsm/motion/tables/action_unit_names.txt, for an angle and its opposite.
struct Code {
  const char *more, *less;
  float degrees;  ///< of either at full strength
};
constexpr Code kHeadDown{"54", "53", 20}, kHeadRight{"51", "52", 30}, kHeadTilted{"55", "56", 15},
    kEyesDown{"64", "63", 25}, kEyesRight{"61", "62", 30};

void Put(std::map<std::string, float>& wanted, const Code& code, float degrees) {
  wanted[code.more] = std::max(degrees / code.degrees, 0.0F);
  wanted[code.less] = std::max(-degrees / code.degrees, 0.0F);
}

}  // namespace

std::string FaceCommand::Next(const FaceLine& line, bool mirrored, double ms) {
  const float side = mirrored ? -1 : 1;
  std::map<std::string, float> wanted;
  for (std::size_t c = 0; c < face_.channels.size(); ++c) {
    Channel name = face_.channels[c];
    if (name.kind != Channel::Kind::kUnit) continue;
    if (mirrored && !name.side.empty()) name.side = name.side == "L" ? "R" : "L";
    wanted[name.Name()] = line.units[c];
  }
  Put(wanted, kHeadDown, line.head[fsm::kDown]);
  Put(wanted, kHeadRight, side * line.head[fsm::kToRight]);
  Put(wanted, kHeadTilted, side * line.head[fsm::kTilted]);
  Put(wanted, kEyesDown, 0.5F * (line.gaze[0][fsm::kDown] + line.gaze[1][fsm::kDown]));
  Put(wanted, kEyesRight,
      side * 0.5F * (line.gaze[0][fsm::kToRight] + line.gaze[1][fsm::kToRight]));
  return Say(wanted, ms);
}

std::string FaceCommand::Rest(double ms) {
  std::map<std::string, float> wanted;
  for (const auto& [name, strength] : said_) wanted[name] = 0;
  return Say(wanted, ms);
}

std::string FaceCommand::Say(const std::map<std::string, float>& wanted, double ms) {
  constexpr float kMost = 2;  // that AU takes
  std::string text;
  for (const auto& [name, value] : wanted) {
    const float strength = std::round(std::clamp(value, 0.0F, kMost) / kStep) * kStep;
    float& said = said_[name];
    if (std::abs(strength - said) < 0.5F * kStep) continue;
    said = strength;
    text += fmt::format("{} {:.2f} ", name, strength);
  }
  return text.empty() ? text : text + fmt::format("{:.0f}", ms);
}

}  // namespace facetrack
