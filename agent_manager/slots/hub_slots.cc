#include "agent_manager/slots/hub_slots.h"

#include <algorithm>
#include <utility>

#include "agent_manager/routing/own_names.h"
#include "vm_protocol/core/module.h"

namespace am {

using vm::Access;
using vm::Reply;
using vm::Result;
using vm::SetValue;

namespace {

/// Joins words with `between`.
template <typename List, typename Word>
std::string Joined(const List& list, const char* between, const Word& word) {
  std::string text;
  for (const auto& item : list) text += (text.empty() ? "" : between) + word(item);
  return text;
}

/// What the names of the slots of configured modules begin with.
constexpr const char* kModuleSlots = "Module.";

constexpr std::size_t kMaxRemotesOfGuest = 32;  // modules of other agents it is subscribed to

std::string_view KindName(PeerKind kind) {
  switch (kind) {
    case PeerKind::kConsole:
      return own_name::kConsole;
    case PeerKind::kModule:
      return "MODULE";
    case PeerKind::kRemote:
      return "REMOTE";
    case PeerKind::kClient:
      break;
  }
  return "CLIENT";
}

std::string TrafficText(const PeerStatus& peer) {
  const Traffic& t = peer.traffic;
  const auto number = [](auto n) { return std::to_string(n); };
  return peer.name + " " + std::string(KindName(peer.kind)) + " " +
         std::string(RoleName(peer.role)) + " in=" + number(t.messages_in) + "/" +
         number(t.bytes_in) + " out=" + number(t.messages_out) + "/" + number(t.bytes_out) +
         " backlog=" + number(peer.backlog_bytes) + " pending=" + number(peer.pending) +
         " slots=" + number(peer.defined) + " refused=" + number(t.refused) +
         " throttled=" + number(t.throttled) + " held=" + number(t.held) +
         (peer.held ? " HELD" : "");
}

}  // namespace

HubSlots::HubSlots(vm::Scheduler& clock, Hub& hub, Supervisor& supervisor, vm::SlotMachine& slots,
                   Hooks hooks)
    : clock_(clock), hub_(hub), supervisor_(supervisor), slots_(slots), hooks_(std::move(hooks)) {
  vm::DeclareCommonSlots(slots_, {.module_version = "Galatea agent_manager " GALATEA_VERSION,
                                  .protocol_version = "Galatea protocol 1.0",
                                  .on_exit = hooks_.on_exit});
  DeclareForPeers();
  DeclareOverviews();
  DeclareProcesses();
  DeclareLimits();
  slots_.Reserve(kModuleSlots);
}

void HubSlots::DeclareForPeers() {
  slots_.Declare({.name = "Name",
                  .grammar = "<word>",
                  .access = Access::kWriteOnly,
                  .help = "The name you want to be known by: to @NAME reaches you.",
                  .on_set = [this](const SetValue& value) -> Result<std::string> {
                    if (const auto renamed = hub_.Rename(value.peer, value.word(0)); !renamed)
                      return std::unexpected(renamed.error());
                    return value.word(0);
                  }});
  slots_.Declare({.name = "Subscribe",
                  .grammar = "NONE | <word>...",
                  .access = Access::kWriteOnly,
                  .help = "Whose reports you want to hear: names without @, * for all, or NONE.",
                  .on_set = [this](const SetValue& value) { return Subscribe(value); }});
  slots_.Declare({.name = "Flow",
                  .grammar = "ON | OFF",
                  .access = Access::kWriteOnly,
                  .help = "ON: you are shown every message, as a comment: # flow TIME_MS SENDER "
                          "RECEIVERS LINE, with tabs between.",
                  .on_set = [this](const SetValue& value) -> Result<std::string> {
                    hooks_.on_flow(value.peer, value.word(0) == "ON");
                    return value.word(0);
                  }});
  slots_.Declare({.name = "Wait",
                  .grammar = "IDLE | <ms>",
                  .access = Access::kWriteOnly,
                  .help = "Holds the console's further lines for so many ms of the session's "
                          "clock, or until nothing goes on (IDLE).",
                  .on_set_later = hooks_.on_wait});
}

Result<std::string> HubSlots::Subscribe(const SetValue& value) {
  std::set<std::string> names;
  for (const auto& item : value.items) {
    if (item.text != "NONE") names.insert(item.text);
  }
  if (names.size() > hub_.limits().slots)
    return vm::Fail(vm::Errc::kLimit,
                    "more than " + std::to_string(hub_.limits().slots) + " names (Limit.slots)");
  // Each of those is looked for at the broker.
  const auto remote = static_cast<std::size_t>(std::ranges::count_if(
      names, [](const std::string& name) { return name.find('/') != std::string::npos; }));
  if (hub_.directory().RoleOf(value.peer) == Role::kGuest && remote > kMaxRemotesOfGuest)
    return vm::Fail(vm::Errc::kLimit,
                    "more than " + std::to_string(kMaxRemotesOfGuest) + " modules of other agents");
  hub_.Subscribe(value.peer, names);
  for (const std::string& name : names) hooks_.on_want(name, hub_.directory().RoleOf(value.peer));
  return value.text;
}

void HubSlots::DeclareOverviews() {
  const auto report = [this](const char* name, const char* help, std::function<std::string()> inq) {
    slots_.Declare({.name = name,
                    .grammar = "<text>",
                    .access = Access::kReadOnly,
                    .help = help,
                    .on_inq = std::move(inq)});
  };
  report("Modules", "The names of all that can be spoken to now.", [this] {
    return Joined(hub_.directory().Names(), " ", [](const std::string& name) { return name; });
  });
  report("Clock", "The session's clock in ms.", [this] { return vm::FormatMs(clock_.Now()); });
  report("Clocks",
         "Of each module: NAME OFFSET DELAY in ms; its clock minus the session's, and the time "
         "there and back.",
         [this] {
           auto names = hub_.directory().Names();
           std::erase_if(names, [this](const std::string& name) {
             return !hub_.clocks().ClockOf(name).known;
           });
           return Joined(names, ", ", [this](const std::string& name) {
             const ClockState state = hub_.clocks().ClockOf(name);
             return name + " " + vm::FormatMs(state.offset) + " " + vm::FormatMs(state.delay);
           });
         });
  report("Traffic",
         "Of each peer: NAME KIND ROLE and, since it came, in=MESSAGES/BYTES, out=MESSAGES/BYTES, "
         "backlog=BYTES not yet read, pending=REQUESTS it has not answered, slots=it has defined, "
         "refused=LINES that were none, throttled= and held=TIMES it was read slower; HELD if it "
         "is now.",
         [this] { return Joined(hub_.Status(), ", ", TrafficText); });
  slots_.Declare({.name = "Refused",
                  .grammar = "<text>",
                  .access = Access::kReadOnly,
                  .initial = "0",
                  .help = "How many connections and requests were turned away so far, and the last "
                          "one."});
  slots_.Declare({.name = "Mqtt",
                  .grammar = "<text>",
                  .access = Access::kReadOnly,
                  .initial = "NONE",
                  .help =
                      "The broker by which other agents are reached: ONLINE and where, AWAY and "
                      "why, or NONE."});
}

void HubSlots::DeclareProcesses() {
  slots_.Declare({.name = "Processes",
                  .grammar = "<text>",
                  .access = Access::kReadOnly,
                  .help = "The configured modules, their state and process id.",
                  .on_inq = [this] {
                    return Joined(supervisor_.Status(), ", ", [](const ModuleStatus& module) {
                      const bool runs = module.state == "READY" || module.state == "STARTING";
                      return module.name + " " + (runs ? "RUNNING" : module.state) +
                             (module.pid > 0 ? " " + std::to_string(module.pid) : "");
                    });
                  }});
  const auto declare = [this](const std::string& name, const std::string& help, auto act) {
    slots_.Declare({.name = name,
                    .grammar = "<word>",
                    .access = Access::kWriteOnly,
                    .help = help,
                    .on_set_later = [this, act](const SetValue& value, const Reply& reply) {
                      (supervisor_.*act)(value.word(0), [reply](const Result<std::string>& state) {
                        state ? reply.Ok(*state) : reply.Fail(state.error());
                      });
                    }});
  };
  declare("Start", "Starts a configured module; answered when it is ready.", &Supervisor::StartOne);
  declare("Stop", "Asks a module to exit; answered when it has gone. It stays away until Start.",
          &Supervisor::StopOne);
  declare("Restart", "Stop and Start.", &Supervisor::RestartOne);
  slots_.Declare(
      {.name = "Reload",
       .grammar = "NOW",
       .access = Access::kWriteOnly,
       .help = "Reads the configuration again; what is configured as before goes on.",
       .on_set_later = [this](const SetValue&, const Reply& reply) { hooks_.on_reload(reply); }});
}

void HubSlots::DeclareLimits() {
  for (const LimitName& limit : LimitNames()) {
    slots_.Declare(
        {.name = std::string("Limit.") + limit.name,
         .grammar = "<int " + std::to_string(limit.least) + ".." + std::to_string(limit.most) + ">",
         .initial = std::to_string(Limits().*limit.member),
         .help = limit.help,
         .on_set = [this, member = limit.member](const SetValue& value) -> Result<std::string> {
           hub_.set_limit(member, static_cast<std::uint64_t>(value.number(0)));
           return value.word(0);
         },
         .on_inq = [this,
                    member = limit.member] { return std::to_string(hub_.limits().*member); }});
  }
}

void HubSlots::DeclareModules(const std::set<std::string>& names) {
  for (const std::string& name : modules_) {
    if (names.contains(name)) continue;
    for (const char* const slot :
         {".state", ".pid", ".starts", ".ending", ".failed", ".output", ".log"})
      slots_.Remove(kModuleSlots + name + slot);
  }
  for (const std::string& name : names) {
    if (!modules_.contains(name)) DeclareModule(name);
  }
  modules_ = names;
}

void HubSlots::DeclareModule(const std::string& module) {
  const auto status = [this, module] {
    for (ModuleStatus& known : supervisor_.Status()) {
      if (known.name == module) return std::move(known);
    }
    return ModuleStatus{
        .name = module, .state = "REMOVED", .starts = 0, .ending = "", .failed = false};
  };
  const auto declare = [&](const std::string& name, const std::string& help,
                           std::function<std::string()> inq) {
    slots_.Declare({.name = kModuleSlots + module + name,
                    .grammar = "<text>",
                    .access = Access::kReadOnly,
                    .help = help,
                    .on_inq = std::move(inq)});
  };
  declare(".state",
          "WAITING, STARTING, READY, RESTARTING, STOPPING, STOPPED, ENDED, FAILED or REMOVED.",
          [status] { return status().state; });
  declare(".pid", "Its process, or -1.", [status] { return std::to_string(status().pid); });
  declare(".starts", "How often it was started.",
          [status] { return std::to_string(status().starts); });
  declare(".ending", "How it ended the last time.", [status] { return status().ending; });
  declare(".failed", "Whether it failed then: YES, or NO also where it has not ended yet.",
          [status] { return status().failed ? "YES" : "NO"; });
  declare(".output", "The last line of its stderr, with its level: ERROR, WARNING or INFO.",
          nullptr);
  declare(".log", "The last lines of its stderr, with | between.", [this, module] {
    constexpr std::size_t kShown = 20;
    auto lines = supervisor_.Output(module);
    if (lines.size() > kShown)
      lines.erase(lines.begin(), lines.end() - static_cast<std::ptrdiff_t>(kShown));
    return Joined(lines, " | ",
                  [](const OutputLine& line) { return line.level + " " + line.text; });
  });
}

}  // namespace am
