#include "agent_manager/live_config.h"

#include <stdexcept>
#include <utility>

#include "vm_protocol/core/guarded.h"

namespace am {

using vm::Errc;
using vm::Result;

namespace {

/// Throws std::runtime_error with a sentence.
std::vector<Macro> ParseMacros(const Config& config) {
  std::vector<Macro> macros;
  for (const auto& [name, text] : config.macros) {
    auto macro = ParseMacro(name, text);
    if (!macro) throw std::runtime_error("macro " + name + ": " + macro.error().text);
    macro->name = name;
    macros.push_back(std::move(*macro));
  }
  return macros;
}

}  // namespace

void LiveConfig::Apply(const Config& config) {
  for (const std::string& note : config.notes) parts_.say(note);
  // What can fail comes first, and changes nothing.
  std::vector<Macro> macros = ParseMacros(config);
  auto opened = parts_.listeners.OpenMissing(config.listen);
  if (!applied_ || config.mqtt != config_.mqtt) JoinBroker(config.mqtt);

  std::set<std::string> names;
  for (const ModuleConfig& module : config.modules) names.insert(module.name);
  parts_.hub_slots.DeclareModules(names);
  names.insert(mqtt::Bridge::kName);
  Hub& hub = parts_.hub;
  hub.Reserve(names);
  hub.set_limits(config.limits);
  hub.set_rights(config.rights);
  hub.router().set_rules(config.rules);
  hub.router().set_broadcast({config.broadcast.begin(), config.broadcast.end()});
  parts_.listeners.Commit(config.listen, std::move(opened));
  DefineMacros(config, std::move(macros));
  parts_.supervisor.Apply(config.modules);
  applied_ = true;
}

void LiveConfig::DefineMacros(const Config& config, std::vector<Macro> macros) {
  for (const std::string& name : std::exchange(macros_, {})) {
    if (!config.macros.contains(name)) static_cast<void>(parts_.macros.Remove(name));
  }
  for (Macro& macro : macros) {
    const std::string name = macro.name;
    if (const auto defined = parts_.macros.Define(std::move(macro)); !defined) {
      const std::string text = "macro " + name + ": " + defined.error().text;
      if (!applied_) throw std::runtime_error(text);
      parts_.say_error(text);
    }
    macros_.insert(name);
  }
}

void LiveConfig::JoinBroker(const MqttConfig& config) {
  bridge_.reset();
  if (config.broker.empty()) return parts_.slots.Report("Mqtt", "NONE");
  mqtt::Bridge::Hooks hooks;
  hooks.on_notice = parts_.say_error;
  hooks.on_state = [this](const std::string& state) {
    parts_.say("mqtt: " + state);
    parts_.slots.Report("Mqtt", state);
  };
  bridge_ = std::make_unique<mqtt::Bridge>(
      parts_.clock, parts_.hub, config, std::move(hooks),
      [&io = parts_.io, config](const mqtt::Packet& will, mqtt::Broker::Events events) {
        return mqtt::ConnectToBroker(io, config, will, std::move(events));
      });
}

Result<std::string> LiveConfig::Reload() {
  if (!can_reload())
    return vm::Fail(Errc::kUnavailable, "the hub was started without a configuration file");
  auto read = parts_.read();
  if (!read) return std::unexpected(read.error());
  if (read->virtual_clock != config_.virtual_clock || read->log != config_.log ||
      read->web != config_.web)
    return vm::Fail(Errc::kBadValue,
                    "clock, log and web cannot change while the hub runs; nothing was changed");
  try {
    Apply(*read);
  } catch (const std::exception& error) {
    std::string rest = "nothing was changed";
    if (bridge_ == nullptr && !config_.mqtt.broker.empty()) {
      if (const auto joined = vm::Guarded([this] { JoinBroker(config_.mqtt); }); !joined)
        rest = "and the broker of before cannot be joined again: " + joined.error().text;
    }
    return vm::Fail(Errc::kBadValue, std::string(error.what()) + "; " + rest);
  }
  config_ = std::move(*read);
  parts_.say("the configuration was read again");
  return "NOW";
}

}  // namespace am
