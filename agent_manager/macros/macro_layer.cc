#include "agent_manager/macros/macro_layer.h"

#include <algorithm>
#include <vector>

#include "agent_manager/routing/own_names.h"

namespace am {

using vm::Command;
using vm::Errc;
using vm::Message;
using vm::Reply;
using vm::Result;

namespace {

constexpr std::size_t kMaxWords = 64;  // words of a value that become variables

}  // namespace

MacroLayer::MacroLayer(vm::Scheduler& clock, Hub& hub, ReadFile read_file,
                       std::function<void(const std::string& path)> remove_file)
    : hub_(hub),
      read_file_(std::move(read_file)),
      slots_(own_name::kMacros),
      services_{
          .clock = clock, .hub = hub, .slots = slots_, .remove_file = std::move(remove_file)} {
  slots_.Declare({.name = "Macros",
                  .grammar = "<text>",
                  .access = vm::Access::kReadOnly,
                  .help = "The names of all macros.",
                  .on_inq = [this] {
                    std::string names;
                    for (const auto& [name, macro] : macros_)
                      names += (names.empty() ? "" : " ") + name;
                    return names;
                  }});
  slots_.set_definition_hook([this](const Message& message, vm::PeerId, const Reply& reply) {
    return OnDefinition(message, reply);
  });
}

Result<void> MacroLayer::Define(Macro macro) {
  const std::string name = macro.name;
  if (!vm::IsSlotName(name))
    return vm::Fail(Errc::kBadValue, "'" + name + "' cannot be a macro's name");
  const auto before = macros_.find(name);
  if (before == macros_.end() && slots_.Has(name))
    return vm::Fail(Errc::kAccess, "'" + name + "' is a slot of @AM-MCL and no macro");
  if (!macro.reads.empty() && !readers_.contains(macro.reads))
    return vm::Fail(Errc::kBadValue,
                    name + ".reads: there is no way to read '" + macro.reads + "'");
  const std::size_t replaced = before == macros_.end() ? 0 : before->second->bytes;
  if (before == macros_.end() && macros_.size() >= kMaxMacros)
    return vm::Fail(Errc::kLimit, "more than " + std::to_string(kMaxMacros) + " macros");
  if (bytes_ - replaced + macro.bytes > kMaxMacroBytes)
    return vm::Fail(Errc::kLimit,
                    "macros hold more than " + std::to_string(kMaxMacroBytes) + " bytes");
  if (const auto checked = CheckAwaited(macro); !checked) return checked;
  const bool same_slot = before != macros_.end() && before->second->grammar == macro.grammar &&
                         before->second->help == macro.help;
  if (before != macros_.end() && !same_slot) slots_.Remove(name);
  if (!same_slot) {
    slots_.Declare({.name = name,
                    .grammar = macro.grammar,
                    .access = vm::Access::kWriteOnly,
                    .help = macro.help,
                    .on_set_later = [this, name](const vm::SetValue& value, const Reply& reply) {
                      Start(name, value, reply);
                    }});
  }
  bytes_ += macro.bytes - replaced;
  macros_[name] = std::make_shared<const Macro>(std::move(macro));
  CollectAwaited();
  for (const std::string& module : hub_.directory().Names()) SwitchOn(module);
  return {};
}

Result<void> MacroLayer::Remove(const std::string& name) {
  const auto found = macros_.find(name);
  if (found == macros_.end())
    return vm::Fail(Errc::kUnknownSlot, "there is no macro '" + name + "'");
  bytes_ -= found->second->bytes;
  macros_.erase(found);
  slots_.Remove(name);
  CollectAwaited();
  return {};
}

void MacroLayer::CollectFrom(const Macro& macro, std::map<Place, Awaited>& awaited) {
  const auto collect = [&awaited](const MacroStep& step) {
    if (const auto* const wait = std::get_if<WaitStep>(&step.action)) {
      Awaited& place = awaited[{wait->from, wait->slot}];
      place.is_value = true;
      if (wait->last) place.remembered = std::max(place.remembered.value_or(0), wait->value.size());
    }
    if (const auto* const follow = std::get_if<FollowStep>(&step.action))
      awaited.try_emplace({follow->from, follow->tell});
    if (const auto* const mirror = std::get_if<MirrorStep>(&step.action)) {
      for (const std::string& slot : mirror->slots) awaited[{mirror->from, slot}].is_value = true;
    }
  };
  for (const auto& steps : {macro.steps, macro.on_stop, macro.finally}) ForEachStep(steps, collect);
}

Result<void> MacroLayer::CheckAwaited(const Macro& macro) const {
  std::map<Place, Awaited> own;
  CollectFrom(macro, own);
  std::erase_if(own, [this](const auto& entry) { return awaited_.contains(entry.first); });
  if (awaited_.size() + own.size() <= kMaxAwaited) return {};
  return vm::Fail(Errc::kLimit,
                  "macros wait for more than " + std::to_string(kMaxAwaited) + " slots and events");
}

void MacroLayer::CollectAwaited() {
  const auto before = std::exchange(awaited_, {});
  for (const auto& [name, macro] : macros_) CollectFrom(*macro, awaited_);
  for (auto& [place, awaited] : awaited_) {
    const auto known = before.find(place);
    awaited.switched_on = known != before.end() && known->second.switched_on;
  }
  std::erase_if(services_.last, [this](const auto& entry) {
    const auto found = awaited_.find(entry.first);
    return found == awaited_.end() || !found->second.remembered;
  });
}

void MacroLayer::SwitchOn(const std::string& module) {
  // The original's face reports a slot only if AutoOutput is set; set it for each awaited slot.
  for (auto at = awaited_.lower_bound({module, ""});
       at != awaited_.end() && at->first.first == module; ++at) {
    if (!at->second.is_value || std::exchange(at->second.switched_on, true)) continue;
    hub_.Ask(
        own_name::kMacros,
        vm::To(module,
               {{}, "", Command::kProp, "", at->first.second, vm::Relation::kAssign, "AutoOutput"}),
        IgnoreAnswer);
  }
}

void MacroLayer::Abandon(const vm::Error& error) {
  for (const auto& [name, run] : runs_) run->Abandon(error);
}

bool MacroLayer::IsAwaitedBy(PeerKey peer) const {
  return std::ranges::any_of(runs_, [&](const auto& run) { return run.second->IsAwaitedBy(peer); });
}

void MacroLayer::Handle(const Envelope& envelope) {
  origin_ = envelope.origin;
  slots_.Handle(envelope.message, envelope.machine.empty() ? envelope.origin.peer : kHub);
}

bool MacroLayer::OnDefinition(const Message& message, const Reply& reply) {
  const auto found = macros_.find(message.slot);
  if (message.command == Command::kDo) {
    if (message.slot.empty() || found == macros_.end()) return false;
    Begin(message.slot, {{{"value", message.value}, {"text", message.value}}, origin_, reply});
    return true;
  }
  const bool plain = message.relation == vm::Relation::kAssign && !message.value.starts_with('[') &&
                     !message.value.starts_with('{');
  if (found == macros_.end() && (plain || message.command == Command::kDel))
    return false;  // a user's slot
  const auto allowed =
      hub_.access().CheckPermission(origin_.role, Permission::kDefine, "define macros");
  Result<std::string> done = "deleted";
  if (!allowed) {
    done = std::unexpected(allowed.error());
  } else if (message.command != Command::kDel) {
    done = DefineBy(message);
  } else if (const auto removed = Remove(message.slot); !removed) {
    done = std::unexpected(removed.error());
  }
  done ? reply.Ok(*done) : reply.Fail(done.error());
  return true;
}

Result<std::string> MacroLayer::DefineBy(const Message& message) {
  const auto found = macros_.find(message.slot);
  Result<Macro> macro;
  std::string said = "defined";
  if (message.relation == vm::Relation::kAppend) {  // def NAME << LINE
    macro = WithLine(found == macros_.end() ? nullptr : found->second.get(), message.slot,
                     message.value);
    said = message.value;
  } else if (message.relation == vm::Relation::kFromFile) {
    const auto text = read_file_(message.value);
    if (!text) return std::unexpected(text.error());
    macro = ParseMacro(message.slot, *text);
  } else {
    macro = ParseMacro(message.slot, message.value);
  }
  if (!macro) return std::unexpected(macro.error());
  macro->name = message.slot;
  // An added line is sent on behalf of everyone who starts the macro: the lesser rights count.
  macro->definer = found == macros_.end() || message.relation != vm::Relation::kAppend
                       ? origin_.role
                       : std::max(origin_.role, found->second->definer);
  if (const auto defined = Define(std::move(*macro)); !defined)
    return std::unexpected(defined.error());
  return said;
}

void MacroLayer::StopWithoutRun(const Macro& macro) {
  // A peer may have started the modules directly, without the macro: stop them too.
  if (macro.on_stop == nullptr) return;
  for (const MacroStep& step : *macro.on_stop) {
    const auto* const send = std::get_if<SendStep>(&step.action);
    const auto* const request = std::get_if<RequestStep>(&step.action);
    if (send == nullptr && request == nullptr) continue;
    auto message = (send ? send->message : request->message).Expand([](const std::string&) {
      return std::string();
    });
    if (message && hub_.directory().IsPresent(message->to.front()))
      hub_.Ask(own_name::kMacros, std::move(*message), IgnoreAnswer, origin_);
  }
}

void MacroLayer::Start(const std::string& name, const vm::SetValue& value, const Reply& reply) {
  const std::shared_ptr<const Macro> macro = macros_.at(name);
  if (!macro->stops_on.empty() && value.size() > 0 && value.word(0) == macro->stops_on) {
    const auto running = runs_.find(name);
    if (running != runs_.end()) return running->second->Stop(reply);
    StopWithoutRun(*macro);
    return reply.Ok(macro->stops_on);
  }
  Variables variables{{"value", value.text}, {"text", value.text}};
  for (std::size_t i = 0; i < value.size() && i < kMaxWords; ++i)
    variables[std::to_string(i + 1)] = value.word(i);
  if (const auto reader = readers_.find(macro->reads); reader != readers_.end())
    reader->second(variables);
  Begin(name, {std::move(variables), origin_, reply});
}

void MacroLayer::Begin(const std::string& name, MacroRun::Successor start) {
  if (const auto running = runs_.find(name); running != runs_.end())
    return running->second->ReplaceBy(std::move(start));
  auto& run = runs_[name];
  run = std::make_unique<MacroRun>(services_, macros_.at(name), std::move(start),
                                   [this, name] { Finish(name); });
  run->Begin();
}

void MacroLayer::Finish(const std::string& name) {
  const auto found = runs_.find(name);
  if (found == runs_.end()) return;
  const std::unique_ptr<MacroRun> ended = std::move(found->second);
  runs_.erase(found);
  auto successor = ended->Finish();
  if (!successor) return;
  if (!macros_.contains(name))
    return successor->reply.Fail({Errc::kUnknownSlot, "macro '" + name + "' was deleted", 0});
  Begin(name, std::move(*successor));
}

void MacroLayer::OnReport(const std::string& from, const Message& message) {
  std::string slot = message.slot, value = message.value;
  const bool told = message.command == Command::kTell;
  if (told) {  // "Speak.sync = 1000"
    const std::size_t equals = value.find(" = ");
    if (equals == std::string::npos) return;
    slot = value.substr(0, equals);
    value.erase(0, equals + 3);
  }
  const auto awaited = awaited_.find({from, slot});
  if (awaited == awaited_.end()) return;
  if (!told && awaited->second.remembered) {
    if (value.size() <= *awaited->second.remembered) {
      services_.last[{from, slot}] = value;
    } else {
      services_.last.erase({from, slot});  // none that a step compares it to
    }
  }
  for (const auto& [name, run] : runs_) run->OnReport(from, slot, value, told);
}

void MacroLayer::OnPresence(const std::string& name, bool present, const std::string& reason) {
  if (present) return SwitchOn(name);
  std::erase_if(services_.last, [&](const auto& entry) { return entry.first.first == name; });
  for (auto& [place, awaited] : awaited_) {
    if (place.first == name) awaited.switched_on = false;
  }
  for (const auto& [macro, run] : runs_) run->OnGone(name, reason);
}

}  // namespace am
