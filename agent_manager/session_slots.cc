// The slots of @AM.

#include "agent_manager/mqtt/bridge.h"
#include "agent_manager/session.h"
#include "vm_protocol/core/module.h"

namespace am {

using vm::Reply;
using vm::Result;
using vm::SetValue;

void Session::DeclareSlots() {
  vm::DeclareCommonSlots(slots_, {.module_version = "Galatea agent_manager " GALATEA_VERSION,
                                  .protocol_version = "Galatea protocol 1.0",
                                  .on_exit = [this] { stop_ = true; }});
  slots_.Declare({.name = "Name",
                  .grammar = "<word>",
                  .access = vm::Access::kWriteOnly,
                  .help = "The name you want to be known by: to @NAME reaches you.",
                  .on_set = [this](const SetValue& value) -> Result<std::string> {
                    if (const auto renamed = hub_.Rename(value.peer, value.word(0)); !renamed)
                      return std::unexpected(renamed.error());
                    return value.word(0);
                  }});
  slots_.Declare({.name = "Subscribe",
                  .grammar = "NONE | <word>...",
                  .access = vm::Access::kWriteOnly,
                  .help = "Whose reports you want to hear: names without @, * for all, or NONE.",
                  .on_set = [this](const SetValue& value) -> Result<std::string> {
                    std::set<std::string> names;
                    for (const auto& item : value.items) {
                      if (item.text != "NONE") names.insert(item.text);
                    }
                    hub_.Subscribe(value.peer, names);
                    for (const std::string& name : names) {
                      if (mqtt_ != nullptr) mqtt_->Want(name);
                    }
                    return value.text;
                  }});
  slots_.Declare({.name = "Modules",
                  .grammar = "<text>",
                  .access = vm::Access::kReadOnly,
                  .help = "The names of all that can be spoken to now.",
                  .on_inq = [this] {
                    std::string names;
                    for (const std::string& name : hub_.Names())
                      names += (names.empty() ? "" : " ") + name;
                    return names;
                  }});
  slots_.Declare({.name = "Processes",
                  .grammar = "<text>",
                  .access = vm::Access::kReadOnly,
                  .help = "The configured modules, their state and process id.",
                  .on_inq = [this] {
                    std::string text;
                    for (const ModuleStatus& module : supervisor_.Status()) {
                      const bool runs = module.state == "READY" || module.state == "STARTING";
                      text += (text.empty() ? "" : ", ") + module.name + " " +
                              (runs ? "RUNNING" : module.state);
                      if (module.pid > 0) text += " " + std::to_string(module.pid);
                    }
                    return text;
                  }});
  slots_.Declare({.name = "Clocks",
                  .grammar = "<text>",
                  .access = vm::Access::kReadOnly,
                  .help = "Of each module: NAME OFFSET DELAY in ms; its clock minus the session's, "
                          "and the time there and back.",
                  .on_inq = [this] {
                    std::string text;
                    for (const std::string& name : hub_.Names()) {
                      const auto state = hub_.ClockOf(name);
                      if (state.known)
                        text += (text.empty() ? "" : ", ") + name + " " +
                                vm::FormatMs(state.offset) + " " + vm::FormatMs(state.delay);
                    }
                    return text;
                  }});
  slots_.Declare({.name = "Clock",
                  .grammar = "<number>",
                  .access = vm::Access::kReadOnly,
                  .help = "The session's clock in ms.",
                  .on_inq = [this] { return vm::FormatMs(clock_.Now()); }});
  slots_.Declare({.name = "Wait",
                  .grammar = "IDLE | <ms>",
                  .access = vm::Access::kWriteOnly,
                  .help = "Holds the console's further lines for so many ms of the session's "
                          "clock, or until nothing goes on (IDLE).",
                  .on_set_later = [this](const SetValue& value, const Reply& reply) {
                    AskWait(value, reply);
                  }});
  DeclareModuleSlots();
  DeclareLimitSlots();
}

void Session::DeclareModuleSlots() {
  const auto declare = [this](const std::string& name, const std::string& help, auto act) {
    slots_.Declare({.name = name,
                    .grammar = "<word>",
                    .access = vm::Access::kWriteOnly,
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
  slots_.Declare({.name = "Reload",
                  .grammar = "NOW",
                  .access = vm::Access::kWriteOnly,
                  .help = "Reads the configuration again; what is configured as before goes on.",
                  .on_set = [this](const SetValue&) { return Reload(); }});
}

void Session::DeclareSlotsOf(const std::string& module) {
  const std::string prefix = "Module." + module;
  if (slots_.Has(prefix + ".state")) return;
  const auto status = [this, module] {
    for (ModuleStatus& known : supervisor_.Status()) {
      if (known.name == module) return std::move(known);
    }
    return ModuleStatus{.name = module, .state = "REMOVED", .starts = 0, .ending = ""};
  };
  const auto declare = [&](const std::string& name, const std::string& help,
                           std::function<std::string()> inq) {
    slots_.Declare({.name = prefix + name,
                    .grammar = "<text>",
                    .access = vm::Access::kReadOnly,
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
  declare(".output", "The last line of its stderr, with its level: ERROR, WARNING or INFO.",
          nullptr);
  declare(".log", "The last lines of its stderr, with | between.", [this, module] {
    constexpr std::size_t kShown = 20;
    const auto lines = supervisor_.Output(module);
    std::string text;
    for (std::size_t i = lines.size() > kShown ? lines.size() - kShown : 0; i < lines.size(); ++i)
      text += (text.empty() ? "" : " | ") + lines[i].level + " " + lines[i].text;
    return text;
  });
}

}  // namespace am
