#include "agent_manager/session/told_errors.h"

#include <algorithm>

#include "vm_protocol/core/message.h"

namespace am {

void ToldErrors::Told(std::string_view line) {
  if (!line.contains("rror = ")) return;
  const auto message = vm::ParseMessage(line);
  if (!message || message->command != vm::Command::kRep) return;
  if (message->slot != "Error" && !message->slot.ends_with(".error")) return;
  errors_.push_back("error: " + message->value + " (in: ");
  if (errors_.size() > kMost) errors_.pop_front();
}

bool ToldErrors::IsComplaint(std::string_view output) {
  return output.contains("error: ") && output.contains(" (in: ");
}

bool ToldErrors::Take(std::string_view output) {
  const auto told = std::ranges::find_if(
      errors_, [output](const std::string& error) { return output.contains(error); });
  if (told == errors_.end()) return false;
  errors_.erase(told);
  return true;
}

}  // namespace am
