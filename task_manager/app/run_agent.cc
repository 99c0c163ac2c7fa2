#include <stdexcept>

#include "task_manager/app/options.h"

namespace vxml {
int RunAgent(const Options&) { throw std::runtime_error("--platform agent is not there yet"); }
}  // namespace vxml
