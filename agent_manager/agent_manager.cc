#include "agent_manager/agent_manager.h"

#include <unistd.h>

#include <algorithm>
#include <boost/asio/executor_work_guard.hpp>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <stdexcept>
#include <utility>

#include "agent_manager/macros/speak.h"
#include "agent_manager/slots/metrics.h"
#include "agent_manager/supervision/service_notify.h"
#include "vm_protocol/core/text_file.h"
#include "vm_protocol/core/utf8.h"
#include "vm_protocol/runtime/stream_peer.h"

namespace am {

using std::chrono::milliseconds;
using vm::Reply;
using vm::Result;
using vm::SetValue;

namespace {

constexpr milliseconds kMeasureEvery{2000};
/// Past every module's own clock at its start.
constexpr vm::Time kVirtualStart = milliseconds(10000);
constexpr milliseconds kFlushLogEvery{500};
constexpr milliseconds kFlushPatience{2000};
constexpr std::size_t kMaxFileBytes = 4u << 20;  // of `<`, `do FILE` and macros

Result<std::string> ReadFile(const std::string& path) {
  return vm::ReadTextFile(path, kMaxFileBytes);
}

std::unique_ptr<LogWriter> OpenLog(const LogConfig& config) {
  if (config.file.empty()) return nullptr;
  return std::make_unique<LogWriter>(
      config, [](const std::string& text) { std::cerr << "agent_manager: " << text << std::endl; });
}

}  // namespace

AgentManager::AgentManager(Config config, Options options)
    : config_(std::move(config)),
      options_(std::move(options)),
      clock_(io_, !config_.virtual_clock),
      log_writer_(OpenLog(config_.log)),
      log_([this](std::string_view line) {
        if (log_writer_) log_writer_->Write(line);
        if (!onlookers_.empty()) ShowOnlookers(line);
      }),
      hub_(clock_, log_),
      slots_("AM"),
      macros_(clock_, hub_, ReadFile, [](const std::string& path) { unlink(path.c_str()); }),
      parallel_(clock_, hub_),
      sounds_(hub_),
      supervisor_(
          io_, hub_, [this](const std::string& text) { Say(text); },
          [this](const std::string& module, const OutputLine& line) {
            Say(module + " " + line.level + ": " + line.text);
            slots_.Report("Module." + module + ".output", line.level + " " + line.text);
          }),
      console_(io_, clock_, hub_,
               {.started = [this] { return Started(); },
                .on_said = [this] { quiet_.Disturb(); },
                .on_quit = [this] { stop_ = true; },
                .on_lost =
                    [this](const std::string& why) {
                      SayError("console: " + why);
                      console_lost_ = true;
                    }}),
      hub_slots_(clock_, hub_, supervisor_, slots_,
                 {.on_exit = [this] { stop_ = true; },
                  .on_wait = [this](const SetValue& value,
                                    const Reply& reply) { console_.AskWait(value, reply); },
                  .on_reload =
                      [this](const Reply& reply) {
                        hub_.Post([this, reply] {
                          const auto reloaded = Reload();
                          reloaded ? reply.Ok(*reloaded) : reply.Fail(reloaded.error());
                        });
                      },
                  .on_want =
                      [this](const std::string& name) {
                        if (mqtt_ != nullptr) mqtt_->Want(name);
                      },
                  .on_flow = [this](PeerKey peer, bool on) { Watch(peer, on); }}),
      hub_machines_(hub_, slots_, macros_, own_machines_, ReadFile),
      listeners_(
          io_, hub_, [this](const std::string& text) { Say(text); },
          [this](const std::string& text) { Refused(text); }),
      lockstep_(io_, clock_, hub_,
                [this](PeerKey module) {
                  const std::string name = hub_.NameOf(module);
                  SayError("@" + name + " has not followed the clock for " +
                           std::to_string(Lockstep::kPatience.count()) + " ms, it is ended");
                  if (!supervisor_.Kill(name, "has not followed the clock"))
                    hub_.Leave(module, "does not follow the clock");
                }),
      quiet_(clock_, hub_, [this] { return macros_.Busy(); }),
      probe_timer_(io_),
      measure_timer_(io_),
      watchdog_timer_(io_),
      log_timer_(io_),
      reload_signal_(io_),
      person_(isatty(STDOUT_FILENO) != 0 && isatty(STDERR_FILENO) != 0) {
  log_.set_enabled(log_writer_ != nullptr);
  if (config_.virtual_clock) {
    supervisor_.set_watch_health(false);
    clock_.Advance(kVirtualStart);
    hub_.set_lockstep(true);
    macros_.set_lockstep(true);
  }
  ConnectParts();
  LoadBuiltInMacros();
  if (!options_.replay) return;
  std::set<std::string> modules;
  for (const ModuleConfig& module : config_.modules) modules.insert(module.name);
  replay_.emplace(clock_, hub_, *options_.replay, std::move(modules), options_.replay_speed);
}

AgentManager::~AgentManager() = default;

void AgentManager::ConnectParts() {
  hub_.set_on_notice([this](const std::string& text, PeerKey about) { SayError(text, about); });
  hub_.set_on_report([this](const std::string& from, const vm::Message& message) {
    for (OwnMachine* const machine : own_machines_) machine->OnReport(from, message);
  });
  hub_.set_awaited_by([this](PeerKey peer) {
    return std::ranges::any_of(own_machines_, [peer](const auto* m) { return m->Owes(peer); });
  });
  hub_.set_on_presence([this](const std::string& name, bool present, const std::string& reason) {
    if (!present) slots_.TellAll("@" + name + " has gone: " + reason);
    for (OwnMachine* const machine : own_machines_) machine->OnPresence(name, present, reason);
    if (mqtt_ != nullptr) mqtt_->OnPresence(name, present, reason);
    if (!present) return;
    lockstep_.Forget();
    supervisor_.OnPresent(name);
  });
  hub_.set_on_unknown([this](const std::string& name) -> Result<bool> {
    return mqtt_ != nullptr ? mqtt_->Open(name) : Result<bool>(false);
  });
  hub_.AddMachine(slots_);
  hub_.AddMachine(macros_.slots(), {"FS-MCL"});
  hub_.AddMachine(parallel_.slots(), {}, true);
  hub_.AddMachine(sounds_.slots(), {}, true);
  for (auto* const machine : {&slots_, &macros_.slots(), &parallel_.slots(), &sounds_.slots()}) {
    machine->set_on_error([this](vm::PeerId peer, const std::string& line, const vm::Error& error) {
      if (error.code == vm::Errc::kStopped) return;  // somebody's wish, not a fault
      SayError("error: " + vm::FormatError(error) + (line.empty() ? "" : " (in: " + line + ")"),
               peer);
    });
    machine->set_read_file(ReadFile);
  }
}

void AgentManager::LoadBuiltInMacros() {
  macros_.AddReader("emotion", ReadEmotion);
  auto file = ParseMacroFile(BuiltInMacros());
  if (!file) throw std::runtime_error("built-in macros: " + file.error().text);
  for (vm::SlotSpec& slot : file->slots) macros_.Declare(std::move(slot));
  for (Macro& macro : file->macros) {
    if (const auto defined = macros_.Define(std::move(macro)); !defined)
      throw std::runtime_error("built-in macros: " + defined.error().text);
  }
}

std::string AgentManager::SlotsMarkdown() {
  return "### @AM\n\n" + slots_.DocsMarkdown() + "\n### @AM-MCL, @FS-MCL\n\n" +
         macros_.slots().DocsMarkdown() + "\n### @PAR\n\n" + parallel_.slots().DocsMarkdown() +
         "\n### @SND\n\n" + sounds_.slots().DocsMarkdown();
}

void AgentManager::Say(const std::string& text) const {
  std::cerr << "agent_manager: " << vm::ShownUtf8(text) << std::endl;
}

void AgentManager::SayError(const std::string& text, PeerKey about) {
  ++errors_;
  // Somebody who types at the console and sees both streams has read it already.
  if (!person_ || about == kHub || about != console_.key()) Say(text);
}

void AgentManager::Refused(const std::string& text) {
  // Counted apart from errors: what strangers try is no fault of ours.
  ++refused_;
  Say(text);
  slots_.Report("Refused", std::to_string(refused_) + " " + vm::ShownUtf8(text));
}

void AgentManager::Apply(const Config& config) {
  for (const std::string& note : config.notes) Say(note);
  // What can fail comes first, and changes nothing.
  std::vector<Macro> macros;
  for (const auto& [name, text] : config.macros) {
    auto macro = ParseMacro(name, text);
    if (!macro) throw std::runtime_error("macro " + name + ": " + macro.error().text);
    macro->name = name;
    macros.push_back(std::move(*macro));
  }
  auto opened = listeners_.OpenMissing(config.listen);
  if (!applied_ || config.mqtt != config_.mqtt) JoinBroker(config.mqtt);

  std::set<std::string> names;
  for (const ModuleConfig& module : config.modules) names.insert(module.name);
  hub_slots_.DeclareModules(names);
  names.insert(mqtt::Bridge::kName);
  hub_.Reserve(std::move(names));
  hub_.set_limits(config.limits);
  hub_.set_rights(config.rights);
  hub_.set_rules(config.rules);
  hub_.set_broadcast({config.broadcast.begin(), config.broadcast.end()});
  listeners_.Commit(config.listen, std::move(opened));
  for (const std::string& name : std::exchange(configured_macros_, {})) {
    if (!config.macros.contains(name)) static_cast<void>(macros_.Remove(name));
  }
  for (Macro& macro : macros) {
    const std::string name = macro.name;
    if (const auto defined = macros_.Define(std::move(macro)); !defined) {
      if (!applied_) throw std::runtime_error("macro " + name + ": " + defined.error().text);
      SayError("macro " + name + ": " + defined.error().text);
    }
    configured_macros_.insert(name);
  }
  supervisor_.Apply(config.modules);
  applied_ = true;
}

void AgentManager::JoinBroker(const MqttConfig& config) {
  if (config.broker.empty()) {
    mqtt_.reset();
    return slots_.Report("Mqtt", "NONE");
  }
  mqtt::Bridge::Hooks hooks;
  hooks.on_notice = [this](const std::string& text) { SayError(text); };
  hooks.on_state = [this](const std::string& state) {
    Say("mqtt: " + state);
    slots_.Report("Mqtt", state);
  };
  mqtt_.reset();
  mqtt_ = std::make_unique<mqtt::Bridge>(
      clock_, hub_, config, std::move(hooks),
      [this, config](const mqtt::Packet& will, mqtt::Broker::Events events) {
        return mqtt::ConnectToBroker(io_, config, will, std::move(events));
      });
}

Result<std::string> AgentManager::Reload() {
  if (!options_.read_config)
    return vm::Fail(vm::Errc::kUnavailable, "the hub was started without a configuration file");
  auto read = options_.read_config();
  if (!read) return std::unexpected(read.error());
  if (read->virtual_clock != config_.virtual_clock || read->log != config_.log ||
      read->web != config_.web)
    return vm::Fail(vm::Errc::kBadValue,
                    "clock, log and web cannot change while the hub runs; nothing was changed");
  NotifyService("RELOADING=1");
  Result<std::string> done = "NOW";
  try {
    Apply(*read);
    config_ = std::move(*read);
    Say("the configuration was read again");
  } catch (const std::exception& error) {
    if (mqtt_ == nullptr && !config_.mqtt.broker.empty()) JoinBroker(config_.mqtt);
    done = vm::Fail(vm::Errc::kBadValue, std::string(error.what()) + "; nothing was changed");
  }
  NotifyService("READY=1");
  return done;
}

void AgentManager::ReloadOnSignal() {
  reload_signal_.add(SIGHUP);
  reload_signal_.async_wait([this](const auto& error, int) {
    if (error) return;
    hub_.Post([this] {
      if (const auto reloaded = Reload(); !reloaded) SayError(reloaded.error().text);
    });
    ReloadOnSignal();
  });
}

int AgentManager::Run() {
  const auto work = boost::asio::make_work_guard(io_);
  boost::asio::signal_set signals(io_, SIGINT, SIGTERM);
  signals.async_wait([this](const auto& error, int) {
    if (!error) stop_ = true;
  });
  Apply(config_);
  ReloadOnSignal();
  if (!config_.web.at.empty()) {
    web_ = std::make_unique<WebServer>(
        io_, config_.web, hub_, [this] { return Metrics(); },
        [this](const std::string& text) { Refused(text); });
    Say("the page is at " + web_->Address());
  }
  EndProbesInTime({});
  if (clock_.real()) {
    FlushLog();
    MeasureClocks();
  }
  if (options_.console) {
    if (!options_.read_config)
      Say("no configuration (--config FILE), so no modules are started; type help or quit");
    console_.Start(options_.first_lines);
  }
  while (!Over()) {
    if (!started_once_ && Started()) OnStarted();
    // Also the lines held back while a module that was started again is being asked what it knows.
    if (console_.has_lines()) console_.Feed();
    if (!clock_.real()) {
      StepVirtual();
      continue;
    }
    if (IdleIsWanted()) quiet_.Ask();
    if (console_.waits_for_idle() && !SomethingGoesOn()) console_.OnIdle();
    if (!Over()) RunSome();
  }
  Shutdown();
  return console_lost_ || (options_.strict && errors_ > 0) ? 1 : 0;
}

void AgentManager::OnStarted() {
  started_once_ = true;
  NotifyService("READY=1");
  FeedWatchdog();
  if (replay_) replay_->Start([this] { quiet_.Disturb(); });
}

void AgentManager::RunSome() {
  // What parts have said to each other meanwhile is dealt with before anybody waits.
  const vm::WriteBatch batch;  // everything said in one round goes out in one write each
  try {
    std::size_t done = 0;
    if (!hub_.idle()) {
      done = io_.poll_one();
    } else if (config_.spin.count() > 0) {
      const auto until = std::chrono::steady_clock::now() + config_.spin;
      do {
        done = io_.poll_one();
      } while (done == 0 && std::chrono::steady_clock::now() < until);
    }
    if (done == 0 && hub_.idle()) io_.run_one();
  } catch (const std::exception& error) {
    SayError(std::string("internal error: ") + error.what());
  }
  hub_.Drain();
}

void AgentManager::StepVirtual() {
  const vm::WriteBatch batch;
  if (hub_.Drain()) return;
  // Time goes on only when nothing is on its way: all grants answered, nothing due here, nobody
  // newly spoken to.
  if (lockstep_.Waiting() || !Started()) {
    io_.run_one();
    return;
  }
  if (io_.poll() > 0 || lockstep_.StepNow()) return;
  if (!SomethingGoesOn()) console_.OnIdle();
  if (!hub_.idle() || hub_.AnyGrantOutdated() ||
      (clock_.Next() && *clock_.Next() <= clock_.Now()))
    return;
  const bool time_wanted =
      SomethingGoesOn() || console_.waits_for_time() || console_.waits_for_idle();
  if (time_wanted && lockstep_.StepOn()) return;
  if (!Over() && !console_.has_lines()) io_.run_one();
}

bool AgentManager::Started() const {
  const bool known = !hub_.clocks().ProbingForUs();
  return started_once_ ? known : known && supervisor_.AllReady();
}

bool AgentManager::SomethingGoesOn() const {
  const auto busy = [](const OwnMachine* machine) { return machine->Busy(); };
  if (std::ranges::any_of(own_machines_, busy) || hub_.HoldsBack() || !hub_.idle() ||
      (replay_ && replay_->pending() > 0))
    return true;
  return clock_.real() ? !quiet_.quiet() : lockstep_.Busy();
}

bool AgentManager::IdleIsWanted() const {
  return console_.waits_for_idle() || (console_.input_ended() && !options_.serve) ||
         (replay_ && replay_->pending() == 0);
}

bool AgentManager::Over() const {
  if (stop_) return true;
  if (replay_ && !options_.console) return started_once_ && !SomethingGoesOn();
  if (options_.serve || !options_.console) return false;
  return console_.input_ended() && !console_.has_lines() && !console_.waits_for_time() &&
         !console_.waits_for_idle() && !SomethingGoesOn();
}

void AgentManager::Shutdown() {
  NotifyService("STOPPING=1");
  listeners_.CloseAll();
  for (OwnMachine* const machine : own_machines_)
    machine->Abandon({vm::Errc::kStopped, "the hub ends", 0});
  bool done = false;
  supervisor_.StopAll([&done] { done = true; });
  while (!done) RunSome();
  web_.reset();  // after the face, which may be writing pictures for it
  mqtt_.reset();
  while (hub_.Drain()) {
  }
  hub_.FailRequests({vm::Errc::kStopped, "the hub ends", 0});
  bool flushed = false;
  boost::asio::steady_timer limit(io_, kFlushPatience);
  limit.async_wait([&flushed](const auto&) { flushed = true; });
  hub_.WhenAllSent([&flushed] { flushed = true; });
  while (!flushed) RunSome();
}

void AgentManager::EndProbesInTime(const std::set<PeerKey>& asked_before) {
  hub_.EndProbes(asked_before);
  probe_timer_.expires_after(config_.start_limit);
  probe_timer_.async_wait([this, probing = hub_.clocks().Probing()](const auto& error) {
    if (!error) EndProbesInTime(probing);
  });
}

void AgentManager::MeasureClocks() {
  measure_timer_.expires_after(kMeasureEvery);
  measure_timer_.async_wait([this](const auto& error) {
    if (error) return;
    hub_.MeasureClocks();
    MeasureClocks();
  });
}

void AgentManager::FlushLog() {
  if (!log_writer_) return;
  log_writer_->Flush();
  log_timer_.expires_after(kFlushLogEvery);
  log_timer_.async_wait([this](const auto& error) {
    if (!error) FlushLog();
  });
}

void AgentManager::FeedWatchdog() {
  const auto period = WatchdogPeriod();
  if (!period) return;
  NotifyService("WATCHDOG=1");
  watchdog_timer_.expires_after(*period / 2);
  watchdog_timer_.async_wait([this](const auto& error) {
    if (!error) FeedWatchdog();
  });
}

void AgentManager::Watch(PeerKey peer, bool on) {
  if (on) {
    onlookers_.insert(peer);
  } else {
    onlookers_.erase(peer);
  }
  log_.set_enabled(log_writer_ != nullptr || !onlookers_.empty());
}

void AgentManager::ShowOnlookers(std::string_view line) {
  std::string comment = "# flow ";  // a comment: whoever does not know it passes over it
  comment += line;
  std::erase_if(onlookers_, [&](PeerKey peer) { return !hub_.SendComment(peer, comment); });
  log_.set_enabled(log_writer_ != nullptr || !onlookers_.empty());
}

std::string AgentManager::Metrics() const {
  return FormatMetrics({.peers = hub_.Status(),
                        .modules = supervisor_.Status(),
                        .errors = errors_,
                        .refused = refused_,
                        .mqtt_dropped = mqtt_ != nullptr ? mqtt_->dropped() : 0,
                        .log_lost_bytes = log_writer_ ? log_writer_->lost() : 0,
                        .mqtt_online = mqtt_ != nullptr && mqtt_->online(),
                        .clock = clock_.Now()});
}

}  // namespace am
