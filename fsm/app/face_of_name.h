#pragma once

#include <memory>
#include <string>

#include "fsm/head/head.h"

namespace fsm {

/// A built-in head, or one out of the folder of faces (FacesFolder). Throws std::runtime_error or
/// std::invalid_argument with a sentence.
std::unique_ptr<Head> MakeHeadOfName(const std::string& face);

}  // namespace fsm
