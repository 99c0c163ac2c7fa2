#pragma once

#include <string>
#include <vector>

#include "vm_protocol/xml/node.h"

namespace vxml {

/// A <choice> of a menu or an <option> of a field.
struct Choice {
  const vm::xml::Node* node = nullptr;
  std::string phrase;  ///< its text, without what belongs to its grammar
  std::string keys;    ///< its own, or 1 to 9 in order where the menu says dtmf="true"; "" for none
};

/// In document order.
std::vector<Choice> ChoicesOf(const vm::xml::Node& menu_or_field);

}  // namespace vxml
