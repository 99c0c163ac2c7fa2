#include "fsm/app/mask_slots.h"

#include <algorithm>

#include "fsm/base/random.h"
#include "vm_protocol/core/or_throw.h"

namespace fsm {
namespace {

/// The names that are among `known`, with commas between them.
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
  core_.DeclareReadOnly("MaskSet", names, "The faces there are, with commas between them.", true);
  core_.DeclareReadOnly("NowMask", first_, "The face worn now.", true);
  core_.Declare({.name = "Mask",
                 .grammar = "<text>",
                 .help = "Wears one of the faces of MaskSet.",
                 .action = [this](const vm::SetValue& value) -> vm::Result<void> {
                   // Names may hold blanks; at the end, as the original's clients send them, not.
                   const std::string name =
                       value.text.substr(0, value.text.find_last_not_of(' ') + 1);
                   if (auto worn = Wear(name); !worn) return worn;
                   core_.slots.Report("NowMask", name);
                   return {};
                 },
                 .initial = first_});
  vm::OrThrow(Wear(first_));
}

vm::Result<void> MaskSlots::Wear(const std::string& face) {
  if (auto worn = core_.wardrobe.Wear(face); !worn) return worn;
  core_.motion->expression.SetPerson(HashOf(face));
  return {};
}

void MaskSlots::Reset() {
  if (auto worn = Wear(first_); !worn) return core_.slots.ReportError("Mask", worn.error());
  core_.slots.Store("NowMask", first_);
}

}  // namespace fsm
