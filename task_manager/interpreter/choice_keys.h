#pragma once

#include <map>
#include <string>

#include "task_manager/xml/node.h"

namespace vxml {

/// The keys of a menu's choices: their own, or 1 to 9 in order where the menu says so.
std::map<const xml::Node*, std::string> ChoiceKeys(const xml::Node& menu);

}  // namespace vxml
