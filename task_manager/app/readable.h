#pragma once

#include <string>

namespace vxml {

/// A transcript line for people: what is said, logged and ended; "" for the rest.
std::string Readable(const std::string& json_line);

}  // namespace vxml
