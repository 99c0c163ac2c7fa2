#pragma once

#include <string>
#include <vector>

#include "task_manager/interpreter/feelings.h"
#include "vm_protocol/xml/node.h"

namespace vxml {

/// Lines for head, gaze, gazeShift, face, faceFacs, faceLexeme, faceShift (BML 1.0 core).
std::vector<std::string> BehaviourCommands(const vm::xml::Node& node);
bool IsBehaviour(const std::string& name);

}  // namespace vxml
