#include "fsm/app/fsm_core.h"

namespace fsm {
namespace {

/// Clamps the numbers of a value to the slot's limits.
void Clamp(vm::SetValue& value, int least, int most) {
  value.text.clear();
  for (auto& item : value.items) {
    if (item.number < least || item.number > most) {
      const int nearest = item.number < least ? least : most;
      item.number = nearest;
      item.text = std::to_string(nearest);
    }
    value.text += (value.text.empty() ? "" : " ") + item.text;
  }
}

}  // namespace

vm::Result<void> FsmCore::DrawAt(vm::Time t) {
  const FaceView::StateHistory history{t, [this](vm::Time at) { return motion->StateAt(at); }};
  return view.Draw(motion->StateAt(t), scene, simulates ? &history : nullptr);
}

void FsmCore::Declare(Declaration slot) {
  if (slot.readable) initial_values.emplace_back(slot.name, slot.initial);
  slots.Declare(
      {.name = slot.name,
       .grammar = slot.grammar,
       .access = slot.readable ? vm::Access::kReadWrite : vm::Access::kWriteOnly,
       .initial = slot.initial,
       .help = slot.help,
       .on_set = [this, action = std::move(slot.action), least = slot.least, most = slot.most,
                  told = slot.told](vm::SetValue value) -> vm::Result<std::string> {
         if (least < most) Clamp(value, least, most);
         if (auto done = action(value); !done) return std::unexpected(done.error());
         changed();
         return told != nullptr ? told(value) : value.text;
       },
       .quoted = slot.quoted});
}

void FsmCore::DeclareReadOnly(std::string name, std::string initial, std::string help,
                              bool quoted) {
  slots.Declare({.name = std::move(name),
                 .grammar = "<text>",
                 .access = vm::Access::kReadOnly,
                 .initial = std::move(initial),
                 .help = std::move(help),
                 .quoted = quoted});
}

void FsmCore::ForgetSlotsSinceStart() {
  for (std::size_t i = declared_at_start; i < initial_values.size(); ++i) {
    slots.Remove(initial_values[i].first);
  }
  initial_values.resize(declared_at_start);
}

}  // namespace fsm
