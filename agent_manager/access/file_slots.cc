#include "agent_manager/access/file_slots.h"

#include <algorithm>
#include <memory>

#include "agent_manager/access/pattern.h"
#include "embedded/file_slots.h"
#include "vm_protocol/core/blanks.h"

namespace am {
namespace {

/// Calls `take` for each part between separators, without blanks around it.
template <typename Take>
void ForEachPart(std::string_view text, char separator, const Take& take) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(separator), text.size());
    if (const auto part = vm::Trimmed(text.substr(0, end)); !part.empty()) take(part);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

}  // namespace

FileSlots::FileSlots() {
  ForEachPart(embedded::file_slots(), '\n', [this](std::string_view line) {
    if (!line.starts_with('#')) Add(line);
  });
}

FileSlots::FileSlots(std::string_view declared) : FileSlots() {
  ForEachPart(declared, ';', [this](std::string_view entry) { Add(entry); });
}

void FileSlots::Add(std::string_view entry) {
  const std::size_t blank = std::min(entry.find_first_of(vm::kBlanks), entry.size());
  const std::string name(entry.substr(0, blank));
  if (grammars_.size() >= kMaxSlots) {
    all_ = true;
    return;
  }
  auto grammar = vm::ValueGrammar::Parse(vm::Trimmed(entry.substr(blank)));
  grammars_.insert_or_assign(name, grammar ? std::move(*grammar) : vm::ValueGrammar("<file>"));
}

std::vector<std::string> FileSlots::FilesIn(const std::string& slot,
                                            const std::string& value) const {
  if (all_) return {value};
  const auto grammar = grammars_.find(slot);
  if (grammar == grammars_.end()) return {};
  const auto items = grammar->second.Match(value);
  if (!items) return {value};
  std::vector<std::string> files;
  for (const auto& item : *items) {
    files.insert(files.end(), item.files.begin(), item.files.end());
  }
  return files;
}

}  // namespace am
