#include "agent_manager/macros/sequence.h"

#include <algorithm>

#include "agent_manager/routing/own_names.h"
#include "vm_protocol/core/phonemes.h"

namespace am {

using std::chrono::milliseconds;
using vm::Errc;
using vm::Error;
using vm::Message;
using vm::Result;

namespace {

/// Added to the common start time: lets the mouth move first, and allows for a busy computer.
constexpr vm::Time kStartMargin = milliseconds(60);

}  // namespace

std::size_t Sequence::BytesOf(const Variables& variables) {
  std::size_t bytes = 0;
  for (const auto& [name, value] : variables) bytes += name.size() + value.size();
  return bytes;
}

Sequence::Sequence(MacroServices& services, RunState& run, std::shared_ptr<const Steps> steps,
                   Variables variables, bool lenient, OnEnd on_end)
    : services_(services),
      run_(run),
      steps_(std::move(steps)),
      variables_(std::move(variables)),
      lenient_(lenient),
      on_end_(std::move(on_end)),
      origin_(run.origin) {
  run_.variable_bytes += BytesOf(variables_);
}

Sequence::~Sequence() {
  services_.clock.Cancel(timer_);
  run_.variable_bytes -= BytesOf(variables_);
}

bool Sequence::Blocked() const {
  return ended_ || waiting_ || asking_ || timer_ != 0 || open_branches_ > 0;
}

void Sequence::Advance() {
  while (!Blocked()) {
    if (steps_ == nullptr || next_ >= steps_->size()) return End(std::nullopt);
    const MacroStep& step = (*steps_)[next_++];
    if (Holds(step)) {
      std::visit([this](const auto& action) { Do(action); }, step.action);
    } else if (step.otherwise != nullptr) {
      Branch({step.otherwise});
    }
  }
}

void Sequence::End(std::optional<Error> error) {
  if (std::exchange(ended_, true)) return;
  services_.clock.Cancel(std::exchange(timer_, 0));
  branches_.clear();
  services_.hub.Post(
      [weak = weak_from_this(), error = std::move(error)] {
        if (const auto self = weak.lock()) self->on_end_(error);
      },
      origin_.peer);
}

void Sequence::Fail(Error error) {
  if (!lenient_) End(std::move(error));
}

void Sequence::After(vm::Time delay, void (Sequence::*then)()) {
  timer_ = services_.clock.After(delay, [weak = weak_from_this(), then] {
    const auto self = weak.lock();
    if (!self) return;
    self->timer_ = 0;
    (self.get()->*then)();
  });
}

std::string Sequence::Value(const std::string& name) const {
  const auto found = variables_.find(name);
  if (found != variables_.end()) return found->second;
  return services_.slots.Has(name) ? services_.slots.Value(name) : "";
}

std::optional<std::string> Sequence::Expanded(const Template& text) {
  auto expanded = text.Expand([this](const std::string& name) { return Value(name); });
  if (expanded) return std::move(*expanded);
  Fail(expanded.error());
  return std::nullopt;
}

bool Sequence::Let(const std::string& name, std::string value) {
  const auto [entry, is_new] = variables_.try_emplace(name);
  std::string& variable = entry->second;
  run_.variable_bytes += (is_new ? name.size() : 0) + value.size();
  run_.variable_bytes -= variable.size();
  variable = std::move(value);
  if (run_.variable_bytes <= kMaxVariableBytes) return true;
  Fail({Errc::kLimit,
        "the variables of one run hold more than " + std::to_string(kMaxVariableBytes) + " bytes",
        0});
  return false;
}

bool Sequence::Holds(const MacroStep& step) const {
  if (!step.if_present.empty() && !services_.hub.directory().IsPresent(step.if_present))
    return false;
  if (!step.if_modern.empty() && !services_.hub.directory().IsModern(step.if_modern)) return false;
  if (!step.when.empty() && Value(step.when).empty()) return false;
  const auto is = [this](const auto& entry) { return Value(entry.first) == entry.second; };
  return std::ranges::all_of(step.when_is, is) && std::ranges::none_of(step.unless_is, is);
}

void Sequence::Say(const MessageTemplate& said, const Template::Lookup& lookup, OnAnswer done) {
  if (const auto checked = services_.hub.CheckCaused(origin_, kMaxSaid); !checked)
    return End(checked.error());
  auto message = said.Expand(lookup);
  if (!message) return Fail(message.error());
  for (const std::string& name : message->to) run_.involved.insert(name);
  services_.hub.Ask(own_name::kMacros, std::move(*message), std::move(done), origin_);
}

void Sequence::Do(const SendStep& step) {
  Say(
      step.message, [this](const std::string& name) { return Value(name); }, IgnoreAnswer);
}

void Sequence::Do(const RequestStep& step) {
  const unsigned number = ++asked_;
  const Message& asked = step.message.message();
  const std::string where = "@" + asked.to.front() + " " + asked.slot;
  asking_ = number;
  const auto answered = [weak = weak_from_this(), number,
                         where](const Result<std::string>& answer) {
    if (const auto self = weak.lock()) self->Answered(number, where, answer);
  };
  timer_ = services_.clock.After(step.limit, [answered, limit = step.limit] {
    answered(vm::Fail(Errc::kTimeout, "no answer within " + std::to_string(limit.count()) + " ms"));
  });
  auto message = step.message.Expand([this](const std::string& name) { return Value(name); });
  if (!message) return Answered(number, where, std::unexpected(message.error()));
  for (const std::string& name : message->to) run_.involved.insert(name);
  services_.hub.Ask(own_name::kMacros, std::move(*message), answered, origin_);
}

void Sequence::Answered(unsigned number, const std::string& where,
                        const Result<std::string>& answer) {
  if (ended_ || asking_ != number) return;
  asking_.reset();
  services_.clock.Cancel(std::exchange(timer_, 0));
  if (!answer) Fail({answer.error().code, where + ": " + answer.error().text, 0});
  services_.hub.Post(
      [weak = weak_from_this()] {
        if (const auto self = weak.lock()) self->Advance();
      },
      origin_.peer);
}

bool Sequence::Meets(const WaitStep& step, const Heard& heard) {
  if (heard.from != step.from || heard.slot != step.slot) return false;
  if (!step.fails_on.empty() && heard.value == step.fails_on) {
    Fail({Errc::kUnavailable, "@" + step.from + " reports " + step.slot + " = " + heard.value, 0});
    return true;
  }
  if (!step.value.empty() && heard.value != step.value) return false;
  if (!step.into.empty()) Let(step.into, heard.value);
  return true;
}

void Sequence::Do(const WaitStep& step) {
  if (step.last) {
    const auto last = services_.last.find({step.from, step.slot});
    if (last != services_.last.end() && last->second == step.value) return;
  }
  for (const Heard& heard : heard_) {
    if (Meets(step, heard)) return;
  }
  vm::Time limit = step.limit;
  if (!step.limit_from.empty()) {
    if (const auto phonemes = vm::ParsePhonemes(Value(step.limit_from)))
      limit += vm::TotalDuration(*phonemes);
  }
  waiting_ = {&step, limit};
  After(limit, &Sequence::WaitedTooLong);
}

void Sequence::WaitedTooLong() {
  const Waiting waited = *std::exchange(waiting_, std::nullopt);
  const WaitStep& step = *waited.step;
  Fail({Errc::kTimeout,
        "@" + step.from + " did not report " + step.slot +
            (step.value.empty() ? "" : " = " + step.value) + " within " +
            vm::FormatMs(waited.limit) + " ms",
        0});
  Advance();
}

void Sequence::Hear(Heard heard) {
  heard_bytes_ += heard.value.size() + heard.slot.size() + heard.from.size();
  heard_.push_back(std::move(heard));
  while (heard_bytes_ > kMaxHeardBytes) {
    const Heard& oldest = heard_.front();
    heard_bytes_ -= oldest.value.size() + oldest.slot.size() + oldest.from.size();
    heard_.pop_front();
  }
}

void Sequence::ForgetHeard() {
  heard_.clear();
  heard_bytes_ = 0;
}

void Sequence::OnReport(const std::string& from, const std::string& slot, const std::string& value,
                        bool told) {
  if (ended_) return;
  for (const FollowStep* const follower : followers_) {
    if (follower->from != from || follower->tell != slot) continue;
    const Message& sent = follower->send.message();
    if (!services_.hub.directory().IsPresent(sent.to.front())) continue;
    const auto lookup = [&](const std::string& name) {
      return name == "told" ? value : Value(name);
    };
    Say(follower->send, lookup, IgnoreAnswer);
    if (ended_) return;
  }
  for (const auto& branch : branches_) branch->OnReport(from, slot, value, told);
  const Heard heard{from, slot, value};
  if (!told) Hear(heard);
  if (ended_ || !waiting_ || !Meets(*waiting_->step, heard)) return;
  waiting_.reset();
  services_.clock.Cancel(std::exchange(timer_, 0));
  Advance();
}

void Sequence::Do(const ReportStep& step) {
  const auto value = Expanded(step.value);
  if (value && services_.slots.Has(step.slot)) services_.slots.Report(step.slot, *value);
}

void Sequence::Do(const StoreStep& step) {
  for (const auto& [slot, value] : step.slots) {
    if (services_.slots.Has(slot)) services_.slots.Store(slot, value);
  }
}

void Sequence::Do(const PauseStep& step) {
  if (step.length > milliseconds(0)) origin_.depth = 0;  // a pause breaks a chain of messages
  After(step.length, &Sequence::Advance);
}

void Sequence::Do(const LetStep& step) {
  const auto value = Expanded(step.value);
  if (!value || !Let(step.name, *value) || !step.keep) return;
  if (BytesOf(services_.kept) + step.name.size() + value->size() > kMaxVariableBytes)
    return Fail({Errc::kLimit,
                 "kept variables hold more than " + std::to_string(kMaxVariableBytes) + " bytes",
                 0});
  services_.kept[step.name] = *value;
}

void Sequence::Do(const StartStep& step) {
  vm::Time slowest{0};
  for (const std::string& name : step.of) {
    if (!services_.lockstep)
      slowest = std::max(slowest, services_.hub.clocks().ClockOf(name).delay);
  }
  Let(step.name, vm::FormatMs(services_.clock.Now() + slowest + kStartMargin));
}

void Sequence::Do(const NeedStep& step) {
  if (!services_.hub.directory().IsPresent(step.module))
    Fail({Errc::kUnavailable,
          (step.called.empty() ? "" : step.called + " ") + "@" + step.module + " is not there", 0});
}

void Sequence::Do(const RemoveStep& step) {
  const auto file = Expanded(step.file);
  if (!file) return;
  const AccessControl& access = services_.hub.access();
  auto allowed = access.CheckPermission(run_.macro->definer, Permission::kRemove, "remove files");
  if (allowed) allowed = access.CheckFile(run_.origin.role, *file, "");
  if (!allowed) return Fail(allowed.error());
  services_.remove_file(*file);
}

void Sequence::Do(const BranchesStep& step) { Branch(step.branches); }

void Sequence::Branch(const std::vector<std::shared_ptr<const Steps>>& branches) {
  if (branches.size() > kMaxBranches ||
      run_.variable_bytes + branches.size() * BytesOf(variables_) > kMaxVariableBytes)
    return Fail({Errc::kLimit, "too many branches with too much to remember", 0});
  branches_.clear();
  open_branches_ = branches.size();
  for (std::size_t i = 0; i < branches.size(); ++i) {
    auto branch = std::make_shared<Sequence>(
        services_, run_, branches[i], variables_, lenient_,
        [this, i](const std::optional<Error>& error) { OnBranchEnd(i, error); });
    branch->heard_ = heard_;
    branch->heard_bytes_ = heard_bytes_;
    branch->origin_ = origin_;
    branches_.push_back(std::move(branch));
  }
  // All branches exist before the first starts, since it may end at once.
  const auto started = branches_;
  for (const auto& branch : started) branch->Start();
}

void Sequence::OnBranchEnd(std::size_t index, const std::optional<Error>& error) {
  if (ended_ || index >= branches_.size()) return;
  if (error) {
    Fail(*error);
    if (ended_) return;
  }
  // Later steps see the variables of the branches; where two differ, the last one to end counts.
  const Variables set = branches_[index]->variables();
  for (const auto& [name, value] : set) {
    if (!Let(name, value)) return;
  }
  if (--open_branches_ > 0) return;
  branches_.clear();
  Advance();
}

}  // namespace am
