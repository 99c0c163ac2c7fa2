#pragma once

#include <map>
#include <string>

#include "vm_protocol/xml/node.h"

namespace vxml {

/// The keys of a menu's choices: their own, or 1 to 9 in order where the menu says so.
std::map<const vm::xml::Node*, std::string> ChoiceKeys(const vm::xml::Node& menu);

}  // namespace vxml
