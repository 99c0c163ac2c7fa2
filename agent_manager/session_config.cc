// What the configuration says, at the start and when it is read again.

#include <algorithm>
#include <csignal>
#include <iostream>
#include <stdexcept>

#include "agent_manager/mqtt/bridge.h"
#include "agent_manager/service_notify.h"
#include "agent_manager/session.h"

namespace am {

using vm::Errc;
using vm::Result;

void Session::ApplyConfig() {
  std::set<std::string> names;
  for (const ModuleConfig& module : config_.modules) {
    names.insert(module.name);
    DeclareSlotsOf(module.name);
  }
  names.insert(mqtt::Bridge::kName);
  hub_.Reserve(std::move(names));
  hub_.limits() = config_.limits;
  hub_.rules().set_rules(config_.rules);
  hub_.set_broadcast({config_.broadcast.begin(), config_.broadcast.end()});
  for (const auto& [name, text] : config_.macros) {
    auto macro = ParseMacro(name, text);
    if (macro) macro->name = name;
    const auto defined =
        macro ? mcl_.Define(std::move(*macro)) : Result<void>(std::unexpected(macro.error()));
    if (!defined) throw std::runtime_error("macro " + name + ": " + defined.error().text);
  }
  Listen();
  JoinBroker();
  supervisor_.Apply(config_.modules);
}

void Session::Listen() {
  std::erase_if(doors_, [this](const auto& door) {
    return std::ranges::find(config_.listen, door.first) == config_.listen.end();
  });
  for (const ListenConfig& listen : config_.listen) {
    if (std::ranges::any_of(doors_, [&](const auto& door) { return door.first == listen; }))
      continue;
    const auto endpoint = vm::ParseEndpoint(listen.at);
    if (!endpoint) throw std::runtime_error("listen: " + endpoint.error().text);
    auto door = vm::Doorkeeper::Open(
        io_, *endpoint, listen.credentials, vm::Framing::kAuto, vm::Encoding::kUtf8,
        [this](const vm::Doorkeeper::Guest& guest) { OnGuest(guest); },
        [this](const std::string& text) { Refused(text); });
    std::cerr << "agent_manager: listening on " << vm::FormatEndpoint(door->endpoint())
              << std::endl;
    doors_.emplace_back(listen, std::move(door));
  }
}

void Session::JoinBroker() {
  if (joined_ == config_.mqtt) return;
  mqtt_.reset();
  joined_ = {};
  if (config_.mqtt.broker.empty()) return slots_.Report("Mqtt", "NONE");
  mqtt::Bridge::Hooks hooks;
  hooks.on_notice = [this](const std::string& text) {
    ++errors_;
    std::cerr << "agent_manager: " << text << std::endl;
  };
  hooks.on_state = [this](const std::string& state) {
    std::cerr << "agent_manager: mqtt: " << state << std::endl;
    slots_.Report("Mqtt", state);
  };
  mqtt_ = std::make_unique<mqtt::Bridge>(
      clock_, hub_, config_.mqtt, std::move(hooks),
      [this](const mqtt::Packet& will, mqtt::Broker::Events events) {
        return mqtt::ConnectToBroker(io_, config_.mqtt, will, std::move(events));
      });
  joined_ = config_.mqtt;
}

void Session::Refused(const std::string& text) {
  // Counted apart from errors: what strangers try is no fault of ours.
  ++refused_;
  std::cerr << "agent_manager: " << text << std::endl;
  slots_.Report("Refused", std::to_string(refused_) + " " + text);
}

void Session::OnGuest(const vm::Doorkeeper::Guest& guest) {
  const auto& stream = guest.stream;
  const auto key =
      hub_.Attach(std::make_unique<StreamLink>(stream), PeerKind::kClient, "", Dialect::kAuto);
  if (!key) return Refused(guest.from + ": " + key.error().text);
  stream->Start(
      [this, peer = *key](Result<std::string_view> line) { hub_.OnLine(peer, std::move(line)); },
      [this, peer = *key](const std::string& reason) {
        if (reason != "end of input")
          std::cerr << "agent_manager: @" << hub_.NameOf(peer) << ": " << reason << std::endl;
        hub_.Detach(peer, reason);
      });
  stream->ResumeReading();
}

void Session::ReloadOnSignal() {
  reload_signal_.add(SIGHUP);
  reload_signal_.async_wait([this](const auto& error, int) {
    if (error) return;
    if (const auto reloaded = Reload(); !reloaded)
      std::cerr << "agent_manager: " << reloaded.error().text << std::endl;
    ReloadOnSignal();
  });
}

Result<std::string> Session::Reload() {
  if (!options_.read_config)
    return vm::Fail(Errc::kUnavailable, "the hub was started without a configuration file");
  auto read = options_.read_config();
  if (!read) return std::unexpected(read.error());
  if (read->virtual_clock != config_.virtual_clock || read->log != config_.log ||
      read->web != config_.web)
    return vm::Fail(Errc::kBadValue,
                    "clock, log and web cannot change while the hub runs; nothing was changed");
  NotifyService("RELOADING=1");
  const Config before = std::exchange(config_, std::move(*read));
  try {
    ApplyConfig();
  } catch (const std::runtime_error& error) {
    // Back to what worked: half a configuration helps nobody.
    config_ = before;
    ApplyConfig();
    return vm::Fail(Errc::kBadValue, std::string(error.what()) + "; nothing was changed");
  }
  NotifyService("READY=1");
  std::cerr << "agent_manager: the configuration was read again" << std::endl;
  return "NOW";
}

}  // namespace am
