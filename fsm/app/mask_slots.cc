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

MaskSlots::MaskSlots(FsmCore& core, std::string first, const std::vector<std::string>& listed)
    : core_(core), first_(std::move(first)) {
  const std::vector<std::string> all = core_.wardrobe.Faces();
  if (first_.empty()) first_ = all.front();
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
                       .initial = first_,
                       .help = "The face worn now.",
                       .quoted = true});
  core_.slots.Declare(
      {.name = "Mask",
       .grammar = "<text>",
       .initial = first_,
       .help = "Wears one of the faces of MaskSet.",
       .on_set = core_.Command([this](const vm::SetValue& value) -> vm::Result<void> {
         // Names may contain blanks; those at the end, which clients of the original send, are
         // removed.
         const std::string name = value.text.substr(0, value.text.find_last_not_of(' ') + 1);
         if (auto worn = Wear(name); !worn) return worn;
         core_.slots.Report("NowMask", name);
         return {};
       })});
  vm::OrThrow(Wear(first_));
}

vm::Result<void> MaskSlots::Wear(const std::string& face) {
  if (auto worn = core_.wardrobe.Wear(face); !worn) return worn;
  worn_ = face;
  core_.motion->expression.SetPerson(HashOf(worn_));
  return {};
}

void MaskSlots::Reset() {
  if (auto worn = Wear(first_); !worn) {
    core_.slots.ReportError("Mask", worn.error());
    core_.motion->expression.SetPerson(HashOf(worn_));
    for (const char* slot : {"Mask", "NowMask"}) core_.slots.Store(slot, worn_);
  }
}

}  // namespace fsm
