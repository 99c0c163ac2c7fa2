#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "agent_manager/config/config.h"
#include "agent_manager/macros/macro_layer.h"
#include "agent_manager/mqtt/bridge.h"
#include "agent_manager/routing/hub.h"
#include "agent_manager/session/listeners.h"
#include "agent_manager/slots/hub_slots.h"
#include "agent_manager/supervision/supervisor.h"

namespace am {

/// The configuration in force: makes the hub's parts agree with it, at the start and whenever it is
/// read again. Ownership: owns the bridge to the MQTT broker, which comes and goes with it.
/// Thread: the context's. All that it is given outlives it.
class LiveConfig {
 public:
  struct Parts {
    boost::asio::io_context& io;
    vm::Scheduler& clock;
    Hub& hub;
    vm::SlotMachine& slots;
    HubSlots& hub_slots;
    MacroLayer& macros;
    Listeners& listeners;
    Supervisor& supervisor;
    std::function<void(const std::string&text)> say, say_error;  ///< for people
    std::function<vm::Result<Config>()> read;                    ///< empty: nothing to read again
  };
  LiveConfig(Config config, Parts parts) : config_(std::move(config)), parts_(std::move(parts)) {}

  /// For the first time. Throws std::runtime_error with a sentence.
  void Apply() { Apply(config_); }
  /// Reads it again. On an error nothing has changed, and the text says so.
  /// Errors: kUnavailable, kBadValue, kSyntax.
  vm::Result<std::string> Reload();
  void LeaveBroker() { bridge_.reset(); }

  const Config& config() const { return config_; }
  bool can_reload() const { return parts_.read != nullptr; }
  mqtt::Bridge* bridge() const { return bridge_.get(); }  ///< null: no broker

 private:
  void Apply(const Config& config);
  void DefineMacros(const Config& config, std::vector<Macro> macros);
  void JoinBroker(const MqttConfig& config);

  Config config_;
  const Parts parts_;
  std::unique_ptr<mqtt::Bridge> bridge_;
  std::set<std::string> macros_;  // that the configuration has defined
  bool applied_ = false;
};

}  // namespace am
