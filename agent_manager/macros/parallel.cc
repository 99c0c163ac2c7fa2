#include "agent_manager/macros/parallel.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>
#include <vector>

#include "agent_manager/routing/own_names.h"

namespace am {

using vm::Errc;
using vm::Result;

namespace {

constexpr double kLongestSleepS = 60;

}  // namespace

Parallel::Parallel(vm::Scheduler& clock, Hub& hub)
    : clock_(clock), hub_(hub), slots_(own_name::kParallel) {
  slots_.Declare({.name = "Init",
                  .grammar = "<number>",
                  .access = vm::Access::kWriteOnly,
                  .help = "Forgets all your commands.",
                  .on_set = [this](const vm::SetValue& value) -> Result<std::string> {
                    Clear(origin_.peer);
                    return value.text;
                  }});
  slots_.Declare({.name = "Cmd",
                  .grammar = "<text>",
                  .access = vm::Access::kWriteOnly,
                  .help = "Appends a command: sleep SECONDS, or a line, to @NAME set .... They are "
                          "carried out from the start of the next speech.",
                  .on_set = [this](const vm::SetValue& value) { return Append(value.text); }});
}

Parallel::~Parallel() {
  for (const auto& [peer, list] : lists_) clock_.Cancel(list.timer);
}

bool Parallel::Busy() const {
  return std::ranges::any_of(lists_, [](const auto& entry) { return entry.second.timer != 0; });
}

void Parallel::ForgetGone() {
  std::erase_if(lists_, [this](const auto& entry) {
    const bool gone = entry.first != kHub && hub_.directory().NameOf(entry.first).empty();
    if (gone) clock_.Cancel(entry.second.timer);
    return gone;
  });
}

void Parallel::Clear(PeerKey peer) {
  const auto list = lists_.find(peer);
  if (list == lists_.end()) return;
  clock_.Cancel(list->second.timer);
  lists_.erase(list);
}

void Parallel::Handle(const Envelope& envelope) {
  origin_ = envelope.origin;
  slots_.Handle(envelope.message, envelope.machine.empty() ? envelope.origin.peer : kHub);
}

Result<std::string> Parallel::Append(const std::string& text) {
  ForgetGone();
  const auto found = lists_.find(origin_.peer);
  const List* const list = found == lists_.end() ? nullptr : &found->second;
  if (list != nullptr &&
      (list->commands.size() >= kMaxCommands || list->bytes + text.size() > kMaxBytes))
    return vm::Fail(Errc::kLimit, "more than " + std::to_string(kMaxCommands) + " commands or " +
                                      std::to_string(kMaxBytes) + " bytes");
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
  List& mine = lists_[origin_.peer];
  mine.bytes += text.size();
  mine.commands.push_back(std::move(command));
  return text;
}

void Parallel::OnReport(const std::string& from, const vm::Message& message) {
  if (from != "SSM" || message.slot != "Speak.stat" || message.value != "SPEAKING") return;
  std::vector<PeerKey> ready;
  for (const auto& [peer, list] : lists_) {
    if (list.timer == 0) ready.push_back(peer);
  }
  for (const PeerKey peer : ready) Continue(peer);
}

void Parallel::Continue(PeerKey peer) {
  List& list = lists_.at(peer);
  list.timer = 0;
  while (!list.commands.empty()) {
    const Command command = std::move(list.commands.front());
    list.commands.pop_front();
    if (command.message.to.empty()) {
      list.timer = clock_.After(command.sleep, [this, peer] { Continue(peer); });
      return;
    }
    hub_.SayAs(command.origin, command.message);
  }
  lists_.erase(peer);
}

}  // namespace am
