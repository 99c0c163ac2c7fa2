#include "agent_manager/agent_manager.h"

#include <unistd.h>

#include <algorithm>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/steady_timer.hpp>
#include <csignal>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "agent_manager/macros/speak.h"
#include "agent_manager/routing/own_names.h"
#include "agent_manager/slots/metrics.h"
#include "agent_manager/supervision/service_notify.h"
#include "vm_protocol/core/guarded.h"
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
constexpr milliseconds kAnswerPatience{200};
constexpr milliseconds kFlushPatience{2000};
constexpr std::size_t kMaxFileBytes = 4u << 20;  // of `<`, `do FILE` and macros

Result<std::string> ReadFile(const std::string& path) {
  return vm::ReadTextFile(path, kMaxFileBytes);
}

std::unique_ptr<LogWriter> OpenLog(const LogConfig& config, ErrorStream& errors) {
  if (config.file.empty()) return nullptr;
  return std::make_unique<LogWriter>(config,
                                     [&errors](const std::string& text) { errors.Write(text); });
}

}  // namespace

AgentManager::AgentManager(Config config, Options options)
    : options_(std::move(options)),
      clock_(io_, !config.virtual_clock),
      log_writer_(OpenLog(config.log, people_)),
      flow_watchers_([this](PeerKey peer, std::string_view comment) {
        return hub_.SendComment(peer, comment);
      }),
      log_([this](std::string_view line) {
        if (log_writer_) log_writer_->Write(line);
        flow_watchers_.Write(line);
        EnableLog();
      }),
      hub_(clock_, log_),
      slots_(own_name::kHub),
      macros_(clock_, hub_, ReadFile, [](const std::string& path) { unlink(path.c_str()); }),
      parallel_(clock_, hub_),
      sounds_(hub_),
      supervisor_(
          io_, hub_, [this](const std::string& text) { Say(text); },
          [this](const std::string& module, const OutputLine& line) {
            OnModuleOutput(module, line);
          }),
      console_(io_, clock_, hub_, ConsoleHooks()),
      hub_slots_(clock_, hub_, supervisor_, slots_, SlotHooks()),
      dispatcher_(hub_, slots_, macros_, built_in_machines_, ReadFile),
      listeners_(
          io_, hub_, [this](const std::string& text) { Say(text); },
          [this](const std::string& text) { Refused(text); }),
      lockstep_(
          io_, clock_, hub_,
          [this](PeerKey module, const std::string& why) { OnModuleWithoutClock(module, why); }),
      quiet_(clock_, hub_, [this] { return macros_.Busy(); }),
      config_(std::move(config), ConfigParts()),
      end_probes_(io_),
      measure_clocks_(io_),
      feed_watchdog_(io_),
      flush_log_(io_),
      reload_signal_(io_),
      person_(isatty(STDOUT_FILENO) != 0 && isatty(STDERR_FILENO) != 0) {
  EnableLog();
  if (!clock_.real()) {
    supervisor_.set_watch_health(false);
    clock_.Advance(kVirtualStart);
    hub_.set_lockstep(true);
    macros_.set_lockstep(true);
  }
  ConnectParts();
  LoadBuiltInMacros();
  if (options_.replay) StartReplay();
}

AgentManager::~AgentManager() = default;

void AgentManager::StartReplay() {
  std::set<std::string> modules;
  for (const ModuleConfig& module : config_.config().modules) modules.insert(module.name);
  replay_.emplace(clock_, hub_, *options_.replay, std::move(modules), options_.replay_speed);
}

Console::Hooks AgentManager::ConsoleHooks() {
  return {.started = [this] { return Started(); },
          .on_said = [this] { quiet_.Disturb(); },
          .on_quit = [this] { stop_ = true; },
          .on_told =
              [this](const std::string& line) {
                if (person_) told_.Told(line);
              },
          .on_lost =
              [this](const std::string& why) {
                SayError("console: " + why);
                console_lost_ = true;
              }};
}

HubSlots::Hooks AgentManager::SlotHooks() {
  return {.on_exit = [this] { stop_ = true; },
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
              [this](const std::string& name, Role role) {
                if (auto* const bridge = config_.bridge()) bridge->Want(name, role);
              },
          .on_flow =
              [this](PeerKey peer, bool on) {
                flow_watchers_.Set(peer, on);
                EnableLog();
              }};
}

LiveConfig::Parts AgentManager::ConfigParts() {
  return {.io = io_,
          .clock = clock_,
          .hub = hub_,
          .slots = slots_,
          .hub_slots = hub_slots_,
          .macros = macros_,
          .listeners = listeners_,
          .supervisor = supervisor_,
          .say = [this](const std::string& text) { Say(text); },
          .say_error = [this](const std::string& text) { SayError(text); },
          .read = options_.read_config};
}

void AgentManager::ConnectParts() {
  hub_.set_on_notice([this](const std::string& text, PeerKey about) { SayError(text, about); });
  hub_.router().set_on_report([this](const std::string& from, const vm::Message& message) {
    for (BuiltInMachine* const machine : built_in_machines_) machine->OnReport(from, message);
  });
  hub_.set_awaited_by([this](PeerKey peer) {
    return std::ranges::any_of(built_in_machines_,
                               [peer](const auto* m) { return m->IsAwaitedBy(peer); });
  });
  hub_.set_on_presence([this](const std::string& name, bool present, const std::string& reason) {
    OnPresence(name, present, reason);
  });
  hub_.router().set_on_unknown([this](const std::string& name, Role asker) -> Result<bool> {
    return config_.bridge() != nullptr ? config_.bridge()->Open(name, asker) : Result<bool>(false);
  });
  hub_.AddMachine(slots_);
  hub_.AddMachine(macros_.slots(), {own_name::kMacrosOfTheOriginal});
  hub_.AddMachine(parallel_.slots(), {}, true);
  hub_.AddMachine(sounds_.slots(), {}, true);
  for (auto* const machine : {&slots_, &macros_.slots(), &parallel_.slots(), &sounds_.slots()}) {
    machine->set_on_error([this](vm::PeerId peer, const std::string& line, const vm::Error& error) {
      OnSlotError(peer, line, error);
    });
    machine->set_read_file(ReadFile);
  }
}

void AgentManager::OnPresence(const std::string& name, bool present, const std::string& reason) {
  if (!present) slots_.TellAll("@" + name + " has gone: " + reason);
  for (BuiltInMachine* const machine : built_in_machines_)
    machine->OnPresence(name, present, reason);
  if (auto* const bridge = config_.bridge()) bridge->OnPresence(name, present, reason);
  if (!present) return lockstep_.ForgetGone();
  lockstep_.Forget();
  supervisor_.OnPresent(name);
}

void AgentManager::OnSlotError(PeerKey peer, const std::string& line, const vm::Error& error) {
  if (error.code == vm::Errc::kStopped) return;  // somebody's wish, not a fault
  SayError("error: " + vm::FormatError(error) + (line.empty() ? "" : " (in: " + line + ")"), peer);
}

void AgentManager::OnModuleOutput(const std::string& module, const OutputLine& line) {
  const std::string text = module + " " + line.level + ": " + line.text;
  if (person_ && ToldErrors::IsComplaint(line.text)) {
    SayUnlessTold(text);
  } else {
    Say(text);
  }
  // A module that a reload has taken out writes on until it has gone.
  const std::string slot = "Module." + module + ".output";
  if (slots_.Has(slot)) slots_.Report(slot, line.level + " " + line.text);
}

void AgentManager::SayUnlessTold(const std::string& text) {
  // The answer comes by another pipe, before or after.
  const auto wait = std::make_shared<boost::asio::steady_timer>(io_, kAnswerPatience);
  wait->async_wait([this, wait, text](const auto&) {
    if (!told_.Take(text)) Say(text);
  });
}

void AgentManager::OnModuleWithoutClock(PeerKey module, const std::string& why) {
  const std::string name = hub_.directory().NameOf(module);
  SayError("@" + name + " does not follow the clock: it " + why + "; it is ended");
  if (!supervisor_.Kill(name, "does not follow the clock"))
    hub_.Leave(module, "does not follow the clock");
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

void AgentManager::Say(const std::string& text) { people_.Write(text); }

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

Result<std::string> AgentManager::Reload() {
  NotifyService("RELOADING=1");
  const milliseconds start_limit = config_.config().start_limit;
  auto reloaded = config_.Reload();
  if (config_.config().start_limit != start_limit) EndProbesInTime();
  NotifyService("READY=1");
  return reloaded;
}

void AgentManager::ReloadOnSignal() {
  reload_signal_.async_wait([this](const auto& error, int) {
    if (error) return;
    hub_.Post([this] {
      if (const auto reloaded = Reload(); !reloaded) SayError(reloaded.error().text);
    });
    ReloadOnSignal();
  });
}

void AgentManager::OpenPage() {
  if (config_.config().web.at.empty()) return;
  web_ = std::make_unique<WebServer>(
      io_, config_.config().web, hub_, [this] { return Metrics(); },
      [this](const std::string& text) { Refused(text); });
  Say("the page is at " + web_->Address());
}

void AgentManager::EndProbesInTime() {
  probed_ = hub_.clocks().Probing();
  end_probes_.Start(config_.config().start_limit, [this] {
    hub_.clocks().EndProbes(probed_);
    probed_ = hub_.clocks().Probing();
  });
}

void AgentManager::StartTasks() {
  EndProbesInTime();
  if (!clock_.real()) return;
  measure_clocks_.Start(kMeasureEvery, [this] { hub_.clocks().MeasureAll(); });
  if (log_writer_) {
    log_writer_->Flush();
    flush_log_.Start(kFlushLogEvery, [this] { log_writer_->Flush(); });
  }
}

int AgentManager::Run() {
  const auto work = boost::asio::make_work_guard(io_);
  boost::asio::signal_set signals(io_, SIGINT, SIGTERM);
  signals.async_wait([this](const auto& error, int) {
    if (!error) stop_ = true;
  });
  config_.Apply();
  reload_signal_.add(SIGHUP);
  ReloadOnSignal();
  OpenPage();
  StartTasks();
  if (options_.console) {
    if (!options_.read_config)
      Say("no configuration (--config FILE), so no modules are started; type help or quit");
    console_.Start(options_.first_lines);
  }
  while (!Over()) Guarded([this] { Step(); });
  Shutdown();
  return console_lost_ || (options_.strict && errors_ > 0) ? 1 : 0;
}

void AgentManager::Step() {
  if (!started_once_ && Started()) OnStarted();
  // Also the lines held back while a module that was started again is being asked what it knows.
  if (console_.has_lines()) console_.Feed();
  if (!clock_.real()) return StepVirtual();
  if (IdleIsWanted()) quiet_.Ask();
  if (console_.waits_for_idle() && !SomethingGoesOn()) console_.OnIdle();
  if (!Over()) RunSome();
}

template <typename Act>
void AgentManager::Guarded(const Act& act) {
  if (const auto done = vm::Guarded(act); !done) SayError("internal error: " + done.error().text);
}

void AgentManager::OnStarted() {
  started_once_ = true;
  NotifyService("READY=1");
  if (const auto period = WatchdogPeriod()) {
    NotifyService("WATCHDOG=1");
    feed_watchdog_.Start(std::chrono::duration_cast<milliseconds>(*period / 2),
                         [] { NotifyService("WATCHDOG=1"); });
  }
  if (replay_) replay_->Start([this] { quiet_.Disturb(); });
}

void AgentManager::RunSome() {
  // What parts have said to each other meanwhile is dealt with before anybody waits.
  const vm::WriteBatch batch;  // everything said in one round goes out in one write each
  Guarded([this] {
    std::size_t done = 0;
    if (!hub_.idle()) {
      done = io_.poll_one();
    } else if (config_.config().spin.count() > 0) {
      const auto until = std::chrono::steady_clock::now() + config_.config().spin;
      do {
        done = io_.poll_one();
      } while (done == 0 && std::chrono::steady_clock::now() < until);
    }
    if (done == 0 && hub_.idle()) io_.run_one();
  });
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
  if (!hub_.idle() || hub_.AnyGrantOutdated() || (clock_.Next() && *clock_.Next() <= clock_.Now()))
    return;
  const bool time_wanted =
      SomethingGoesOn() || console_.waits_for_time() || console_.waits_for_idle();
  if (time_wanted && lockstep_.StepOn()) return;
  if (!Over() && !console_.has_lines()) io_.run_one();
}

bool AgentManager::Started() const {
  const bool known = !hub_.clocks().ProbingConfigured();
  return started_once_ ? known : known && supervisor_.AllReady();
}

bool AgentManager::SomethingGoesOn() const {
  const auto busy = [](const BuiltInMachine* machine) { return machine->Busy(); };
  if (std::ranges::any_of(built_in_machines_, busy) || hub_.HoldsBack() || !hub_.idle() ||
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
  for (BuiltInMachine* const machine : built_in_machines_)
    machine->Abandon({vm::Errc::kStopped, "the hub ends", 0});
  bool done = false;
  supervisor_.StopAll([&done] { done = true; });
  while (!done) RunSome();
  web_.reset();  // after the face, which may be writing pictures for it
  config_.LeaveBroker();
  while (hub_.Drain()) {
  }
  hub_.FailRequests({vm::Errc::kStopped, "the hub ends", 0});
  // Shared: a peer that does not read lets go of it only when the hub is taken apart.
  const auto flushed = std::make_shared<bool>(false);
  boost::asio::steady_timer limit(io_, kFlushPatience);
  limit.async_wait([flushed](const auto&) { *flushed = true; });
  hub_.WhenAllSent([flushed] { *flushed = true; });
  while (!*flushed) RunSome();
}

void AgentManager::EnableLog() {
  log_.set_enabled(log_writer_ != nullptr || !flow_watchers_.empty());
}

std::string AgentManager::Metrics() const {
  const mqtt::Bridge* const bridge = config_.bridge();
  return FormatMetrics({.peers = hub_.Status(),
                        .modules = supervisor_.Status(),
                        .errors = errors_,
                        .refused = refused_,
                        .mqtt_dropped = bridge != nullptr ? bridge->dropped() : 0,
                        .log_lost_bytes = log_writer_ ? log_writer_->lost() : 0,
                        .mqtt_online = bridge != nullptr && bridge->online(),
                        .clock = clock_.Now()});
}

}  // namespace am
