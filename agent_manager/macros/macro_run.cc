#include "agent_manager/macros/macro_run.h"

#include <algorithm>
#include <utility>

namespace am {

using vm::Errc;
using vm::Error;

namespace {

/// A run has the lesser of its starter's and its definer's rights, or the definer's (as_definer).
Origin OriginOf(const Macro& macro, Origin starter) {
  starter.role = macro.as_definer ? macro.definer : std::max(starter.role, macro.definer);
  ++starter.depth;
  return starter;
}

}  // namespace

MacroRun::MacroRun(MacroServices& services, std::shared_ptr<const Macro> macro, Successor start,
                   std::function<void()> on_end)
    : services_(services),
      state_{.macro = macro, .origin = OriginOf(*macro, start.origin)},
      variables_(std::move(start.variables)),
      reply_(std::move(start.reply)),
      on_end_(std::move(on_end)) {
  for (const auto& [name, value] : services_.kept) variables_.try_emplace(name, value);
}

void MacroRun::Begin() { Enter(Phase::kSteps); }

void MacroRun::Enter(Phase phase) {
  phase_ = phase;
  const Macro& macro = *state_.macro;
  const auto& steps = phase == Phase::kSteps      ? macro.steps
                      : phase == Phase::kStopping ? macro.on_stop
                                                  : macro.finally;
  if (sequence_) variables_ = sequence_->variables();
  sequence_.reset();
  sequence_ =
      std::make_shared<Sequence>(services_, state_, steps, variables_, phase != Phase::kSteps,
                                 [this](const std::optional<Error>& error) { OnPhaseEnd(error); });
  sequence_->Start();
}

void MacroRun::OnPhaseEnd(const std::optional<Error>& error) {
  if (phase_ == Phase::kSteps && error) return Fail(*error);
  if (phase_ != Phase::kFinally) return Enter(Phase::kFinally);
  variables_ = sequence_->variables();
  services_.hub.Post(on_end_, state_.origin.peer);
}

void MacroRun::Fail(const Error& error) {
  if (phase_ != Phase::kSteps) return;  // already ending
  error_ = error;
  Enter(Phase::kStopping);
}

void MacroRun::Abandon(const vm::Error& error) {
  reply_.Fail(error);
  for (const vm::Reply& reply : stop_replies_) reply.Fail(error);
  if (successor_) successor_->reply.Fail(error);
}

bool MacroRun::IsAwaitedBy(PeerKey peer) const {
  return (!reply_.done() && state_.origin.peer == peer) ||
         (successor_ && successor_->origin.peer == peer);
}

void MacroRun::Stop(const vm::Reply& reply) {
  stop_replies_.push_back(reply);
  Fail({Errc::kStopped, "stopped on request", 0});
}

void MacroRun::ReplaceBy(Successor successor) {
  const std::string& name = state_.macro->name;
  if (successor_)
    successor_->reply.Fail(
        {Errc::kStopped, "a newer " + name + " took its place before it began", 0});
  successor_.emplace(std::move(successor));
  Fail({Errc::kStopped, "a new " + name + " took its place", 0});
}

void MacroRun::OnReport(const std::string& from, const std::string& slot, const std::string& value,
                        bool told) {
  for (const MirrorStep* const mirror : state_.mirrors) {
    if (mirror->from == from && std::ranges::find(mirror->slots, slot) != mirror->slots.end() &&
        services_.slots.Has(slot))
      services_.slots.Report(slot, value);
  }
  const auto sequence = sequence_;  // kept alive: a report may end it
  if (sequence) sequence->OnReport(from, slot, value, told);
}

void MacroRun::OnGone(const std::string& module, const std::string& reason) {
  if (!state_.involved.contains(module)) return;
  Fail({Errc::kUnavailable, "@" + module + " has gone in the middle of it (" + reason + ")", 0});
}

std::optional<MacroRun::Successor> MacroRun::Finish() {
  sequence_.reset();
  for (const vm::Reply& reply : stop_replies_) reply.Ok(state_.macro->stops_on);
  if (!error_) {
    reply_.Ok(variables_["value"]);
  } else {
    Error error = *error_;
    if (error.code == Errc::kStopped) {
      error.text += state_.macro->stop_text
                        .Expand([this](const std::string& name) {
                          return services_.slots.Has(name) ? services_.slots.Value(name) : "";
                        })
                        .value_or("");
    }
    reply_.Fail(error);
  }
  return std::move(successor_);
}

}  // namespace am
