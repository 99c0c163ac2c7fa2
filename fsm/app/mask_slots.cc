#include "fsm/app/mask_slots.h"

#include <algorithm>

#include "fsm/base/random.h"
#include "vm_protocol/core/or_throw.h"

namespace fsm {
namespace {

/// Joins the names that are in `known` with commas.
std::string Joined(const std::vector<std::string>& names, const std::vector<std::string>& known) {
  std::string text;
  for (const std::string& name : names) {
    if (std::ranges::find(known, name) != known.end()) text += (text.empty() ? "" : ",") + name;
  }
  return text;
}

}  // namespace

MaskSlots::MaskSlots(FsmCore& core, std::string initial, const std::vector<std::string>& listed)
    : core_(core), initial_(std::move(initial)) {
  const std::vector<std::string> all = core_.faces.Faces();
  if (initial_.empty()) initial_ = all.front();
  std::string names = Joined(listed, all);
  if (names.empty()) names = Joined(all, all);
  core_.slots.Declare({.name = "MaskSet",
                       .grammar = "<text>",
                       .access = vm::Access::kReadOnly,
                       .initial = names,
                       .help = "The faces there are, with commas between them.",
                       .quoted = true});
  core_.slots.Declare({.name = "NowMask",
                       .grammar = "<text>",
                       .access = vm::Access::kReadOnly,
                       .initial = initial_,
                       .help = "The face worn now.",
                       .quoted = true});
  core_.slots.Declare(
      {.name = "Mask",
       .grammar = "<text>",
       .initial = initial_,
       .help = "Wears one of the faces of MaskSet.",
       .on_set = core_.Command([this](const vm::SetValue& value) -> vm::Result<void> {
         // Names may contain blanks; those at the end, which clients of the original send, are
         // removed.
         const std::string name = value.text.substr(0, value.text.find_last_not_of(' ') + 1);
         if (auto selected = Select(name); !selected) return selected;
         core_.slots.Report("NowMask", name);
         return {};
       })});
  vm::OrThrow(Select(initial_));
}

vm::Result<void> MaskSlots::Select(const std::string& face) {
  if (auto selected = core_.faces.Select(face); !selected) return selected;
  current_ = face;
  core_.motion->expression.SetPerson(HashOf(current_));
  return {};
}

void MaskSlots::RestoreInitial() {
  if (auto selected = Select(initial_); !selected) {
    core_.slots.ReportError("Mask", selected.error());
    core_.motion->expression.SetPerson(HashOf(current_));
    for (const char* slot : {"Mask", "NowMask"}) core_.slots.Store(slot, current_);
  }
}

}  // namespace fsm
