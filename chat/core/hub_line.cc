#include "chat/core/hub_line.h"

#include <memory>
#include <utility>

namespace chat {

HubLine::HubLine(vm::Scheduler& clock, vm::SlotMachine& slots)
    : clock_(clock), slots_(slots), client_([this](std::string_view line) {
        if (auto message = vm::ParseMessage(line)) slots_.Say(std::move(*message));
      }) {}

HubLine::~HubLine() {
  for (const auto& [tag, timer] : timers_) clock_.Cancel(timer);
}

void HubLine::Ask(vm::Message message, vm::Time limit, OnAnswer on_answer) {
  const auto tag = std::make_shared<std::string>();
  *tag = client_.Request(std::move(message), [this, tag, on_answer = std::move(on_answer)](
                                                 vm::Result<std::string> answer) {
    if (const auto timer = timers_.find(*tag); timer != timers_.end()) {
      clock_.Cancel(timer->second);
      timers_.erase(timer);
    }
    on_answer(std::move(answer));
  });
  timers_[*tag] = clock_.After(limit, [this, tag, limit] {
    timers_.erase(*tag);
    client_.Abandon(*tag,
                    {vm::Errc::kTimeout, "no answer within " + vm::FormatMs(limit) + " ms", 0});
  });
}

void HubLine::Hear(const vm::Message& message) {
  if (!message.tag.empty()) client_.HandleLine(vm::FormatMessage(message));
}

}  // namespace chat
