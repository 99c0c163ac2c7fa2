#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vm_protocol/xml/node.h"

namespace vxml {

/// A feeling shown by the face: the original's names, EmotionML's and BML's come down to this.
struct Feeling {
  std::string type = "NEUTRAL";  ///< HAPPY ANGRY DISGUSTED SAD SURPRISED FEARED NEUTRAL
  int pattern = 1;
  int strength = 100;  ///< per cent
};

/// Reads <emotion type value pattern> or EmotionML (category, dimension). None: a name no table
/// knows; the caller takes NEUTRAL or refuses.
std::optional<Feeling> ReadFeeling(const vm::xml::Node& emotion);
/// "to @FSM set FaceExp = HAPPY 1 50 0"
std::string FaceCommand(const Feeling& feeling);

/// Lines for head, gaze, gazeShift, face, faceFacs, faceLexeme, faceShift (BML 1.0 core).
std::vector<std::string> BehaviourCommands(const vm::xml::Node& node);
bool IsBehaviour(const std::string& name);

}  // namespace vxml
