#include "agent_manager/macros/parallel.h"

#include <cmath>
#include <cstdlib>
#include <utility>

namespace am {

using vm::Errc;
using vm::Result;

namespace {

constexpr double kLongestSleepS = 60;

}  // namespace

Parallel::Parallel(vm::Scheduler& clock, Hub& hub) : clock_(clock), hub_(hub), slots_("PAR") {
  slots_.Declare({.name = "Init",
                  .grammar = "<number>",
                  .access = vm::Access::kWriteOnly,
                  .help = "Forgets all commands.",
                  .on_set = [this](const vm::SetValue& value) -> Result<std::string> {
                    commands_.clear();
                    clock_.Cancel(std::exchange(timer_, 0));
                    return value.text;
                  }});
  slots_.Declare({.name = "Cmd",
                  .grammar = "<text>",
                  .access = vm::Access::kWriteOnly,
                  .help = "Appends a command: sleep SECONDS, or a line, to @NAME set .... They are "
                          "carried out from the start of the next speech.",
                  .on_set = [this](const vm::SetValue& value) { return Append(value.text); }});
}

Parallel::~Parallel() { clock_.Cancel(timer_); }

void Parallel::Handle(const Envelope& envelope) {
  origin_ = envelope.origin;
  slots_.Handle(envelope.message, envelope.machine.empty() ? envelope.origin.peer : kHub);
}

Result<std::string> Parallel::Append(const std::string& text) {
  if (commands_.size() >= kMaxCommands)
    return vm::Fail(Errc::kLimit, "more than " + std::to_string(kMaxCommands) + " commands");
  Command command{.message = {}, .origin = origin_};
  if (text.starts_with("sleep ")) {
    char* end = nullptr;
    const double seconds = std::strtod(text.c_str() + 6, &end);
    if (*end != '\0' || !std::isfinite(seconds) || seconds < 0 || seconds > kLongestSleepS)
      return vm::Fail(Errc::kBadValue, "found '" + text + "', expected sleep SECONDS, 0 to 60");
    command.sleep = vm::Time(static_cast<vm::Time::rep>(seconds * 1e6));
  } else {
    auto message = vm::ParseMessage(text);
    if (!message) return std::unexpected(message.error());
    if (message->to.empty())
      return vm::Fail(Errc::kBadValue, "found '" + text + "', expected a line, to @NAME ...");
    message->from.clear();
    command.message = std::move(*message);
  }
  commands_.push_back(std::move(command));
  return text;
}

void Parallel::OnReport(const std::string& from, const vm::Message& message) {
  if (from == "SSM" && message.slot == "Speak.stat" && message.value == "SPEAKING" && timer_ == 0)
    Go();
}

void Parallel::Go() {
  while (!commands_.empty()) {
    const Command command = std::move(commands_.front());
    commands_.pop_front();
    if (command.message.to.empty()) {
      timer_ = clock_.After(command.sleep, [this] {
        timer_ = 0;
        Go();
      });
      return;
    }
    hub_.SayAs(command.origin, command.message);
  }
}

}  // namespace am
