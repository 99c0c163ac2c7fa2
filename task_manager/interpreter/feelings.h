#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"
#include "vm_protocol/xml/node.h"

namespace vxml {

/// A feeling shown by the face: the original's names, EmotionML's and BML's come down to this.
struct Feeling {
  std::string type = "NEUTRAL";  ///< HAPPY ANGRY DISGUSTED SAD SURPRISED FEARED NEUTRAL
  int pattern = 1;
  int strength = 100;    ///< per cent
  bool on_face = true;   ///< the face shows it
  bool in_voice = true;  ///< the voice follows it
};

/// What the face shows of a name (task_manager/tables/feelings.txt).
struct NamedFeeling {
  std::string kind{};  ///< category, appraisal, action-tendency
  std::string name{};  ///< in capitals
  std::string type{};
  int strength = 100;
};
/// Reads such a table. Errors: kSyntax "NAME:LINE: what is wrong".
vm::Result<std::vector<NamedFeeling>> ParseFeelings(std::string_view text, const std::string& name);
/// The built-in table's row for a name, capitals or not; null if it has none.
const NamedFeeling* FindFeeling(std::string_view kind, const std::string& name);

/// Reads <emotion type value pattern> or EmotionML: the strongest category, else the dimensions,
/// else the strongest appraisal or action tendency; expressed-through (EmotionML 1.0 section 2.2.2)
/// says whether it is for face and voice. None: a name no table knows; the caller takes NEUTRAL or
/// refuses.
std::optional<Feeling> ReadFeeling(const vm::xml::Node& emotion);
/// "to @FSM set FaceExp = HAPPY 1 50 0"
std::string FaceCommand(const Feeling& feeling);

}  // namespace vxml
