#include "agent_manager/session.h"

#include <unistd.h>

#include <algorithm>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/signal_set.hpp>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "embedded/built_in_macros.h"
#include "vm_protocol/core/module.h"

namespace am {

using std::chrono::milliseconds;
using vm::Errc;
using vm::Message;
using vm::Reply;
using vm::Result;
using vm::SetValue;

namespace {

constexpr milliseconds kMeasureEvery{10000};
constexpr vm::Time kVirtualStart =
    milliseconds(10000);  // past every module's own clock at its start
constexpr milliseconds kFlushPatience{2000};
constexpr milliseconds kGrantPatience{60000};  // lockstep: for a module to do what is due
constexpr vm::Time kQuietAgain = milliseconds(30);

std::string ReadWhole(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  if (!file || (!(text << file.rdbuf()) && file.peek() != std::ifstream::traits_type::eof())) {
    throw std::runtime_error("cannot read '" + path + "'");
  }
  return text.str();
}

Result<std::string> ReadFileResult(const std::string& path) {
  try {
    return ReadWhole(path);
  } catch (const std::runtime_error& error) {
    return vm::Fail(Errc::kUnavailable, error.what());
  }
}

}  // namespace

Session::Session(const Config& config, Options options)
    : config_(config),
      options_(std::move(options)),
      clock_(io_, !config.virtual_clock),
      log_(config.log.empty() ? SessionLog() : SessionLog([this](std::string_view line) {
        log_file_ << line << '\n';
      })),
      hub_(clock_, log_),
      slots_("AM"),
      mcl_(clock_, hub_, ReadFileResult,
           [](const std::string& path) { std::remove(path.c_str()); }),
      supervisor_(io_, hub_,
                  [this](const std::string& text) {
                    std::cerr << "agent_manager: " << text << std::endl;
                    static_cast<void>(this);
                  }),
      probe_timer_(io_),
      grant_timer_(io_) {
  if (!config.log.empty()) {
    log_file_.open(config.log, std::ios::trunc);
    if (!log_file_) throw std::runtime_error("cannot write the session log '" + config.log + "'");
  }
  if (config.virtual_clock) {
    clock_.Advance(kVirtualStart);
    hub_.set_lockstep(true);
    mcl_.set_lockstep(true);
  }
  hub_.set_on_notice([this](const std::string& text) {
    ++errors_;
    std::cerr << "agent_manager: " << text << std::endl;
  });
  hub_.set_on_report(
      [this](const std::string& from, const Message& message) { mcl_.OnReport(from, message); });
  hub_.set_on_presence([this](const std::string& name, bool present, const std::string& reason) {
    if (!present) slots_.TellAll("@" + name + " has gone: " + reason);
    mcl_.OnPresence(name, present, reason);
    if (!present) return;
    next_.clear();
  });
  std::set<std::string> names;
  for (const ModuleConfig& module : config.modules) names.insert(module.name);
  hub_.Reserve(std::move(names));
  hub_.set_broadcast({config.broadcast.begin(), config.broadcast.end()});
  DeclareSlots();
  hub_.AddInternal(slots_);
  hub_.AddInternal(mcl_.slots(), {"FS-MCL"});
  for (auto* machine : {&slots_, &mcl_.slots()}) {
    machine->set_on_error([this](vm::PeerId, const std::string& line, const vm::Error& error) {
      if (error.code == Errc::kStopped) return;  // somebody's wish, not a fault
      ++errors_;
      std::cerr << "agent_manager: error: " << vm::FormatError(error)
                << (line.empty() ? "" : " (in: " + line + ")") << std::endl;
    });
    machine->set_read_file(ReadFileResult);
  }
  auto built_in = ParseMacros(embedded::built_in_macros());
  if (!built_in) throw std::runtime_error("built-in macros: " + built_in.error().text);
  for (Macro& macro : *built_in) {
    if (const auto defined = mcl_.Define(std::move(macro)); !defined)
      throw std::runtime_error("built-in macros: " + defined.error().text);
  }
  for (const auto& [name, text] : config.macros) {
    auto macro = ParseMacro(name, text);
    if (macro) macro->name = name;
    const auto defined =
        macro ? mcl_.Define(std::move(*macro)) : Result<void>(std::unexpected(macro.error()));
    if (!defined) throw std::runtime_error("macro " + name + ": " + defined.error().text);
  }
  if (options_.replay) LoadReplay(*options_.replay);
}

Session::~Session() = default;

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
                  .on_inq = [this] { return supervisor_.Summary(); }});
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
}

void Session::AskWait(const SetValue& value, const Reply& reply) {
  if (value.peer != console_)
    return reply.Fail({Errc::kAccess, "only the console's lines can be held", 0});
  if (value.word(0) == "IDLE") {
    idle_wait_ = reply;
    return;
  }
  timed_wait_ = true;
  clock_.After(vm::Time(static_cast<vm::Time::rep>(value.number(0) * 1000)), [this, reply] {
    timed_wait_ = false;
    reply.Ok("0");
    FeedConsole();
  });
}

void Session::StartConsole() {
  console_stream_ = vm::StreamPeer::Make(io_, STDIN_FILENO, STDOUT_FILENO, vm::Framing::kLf);
  const auto key = hub_.Attach(std::make_unique<StreamLink>(console_stream_), PeerKind::kConsole,
                               "CONSOLE", Dialect::kAuto);
  console_ = key.value();
  slots_.HandleLine("prop Error = AutoOutput", console_);
  mcl_.slots().HandleLine("prop Error = AutoOutput", console_);
  for (const std::string& line : options_.first_lines) console_lines_.push_back(line);
  console_stream_->Start([this](Result<std::string_view> line) { OnConsoleLine(std::move(line)); },
                         [this](const std::string&) { console_ended_ = true; });
}

void Session::OnConsoleLine(Result<std::string_view> line) {
  if (!line) return hub_.OnLine(console_, std::unexpected(line.error()));
  console_lines_.emplace_back(*line);
  FeedConsole();
}

void Session::FeedConsole() {
  while (!console_lines_.empty() && !timed_wait_ && !idle_wait_ && Started()) {
    const std::string line = std::move(console_lines_.front());
    console_lines_.pop_front();
    quiet_ = false;
    hub_.OnLine(console_, std::string_view(line));
  }
  // Back-pressure: a script of any length may be piped in.
  if (console_stream_ != nullptr) {
    if (console_lines_.size() > 256) {
      console_stream_->PauseReading();
    } else {
      console_stream_->ResumeReading();
    }
  }
}

void Session::LoadReplay(const std::string& path) {
  std::istringstream text(ReadWhole(path));
  std::set<std::string> modules{"AM", "AM-MCL", "FS-MCL"};
  for (const ModuleConfig& module : config_.modules) modules.insert(module.name);
  std::size_t number = 0;
  for (std::string line; std::getline(text, line);) {
    ++number;
    const auto entry = ParseLogEntry(line);
    if (!entry && entry.error().code == Errc::kEmpty) continue;
    if (!entry)
      throw std::runtime_error(path + " line " + std::to_string(number) + ": " +
                               entry.error().text);
    const auto message = vm::ParseMessage(entry->line);
    // What people and clients said is said again; what modules answered then, they answer now.
    const bool about_the_client = message && (message->slot == "Wait" || message->slot == "Name" ||
                                              message->slot == "Subscribe");
    if (message && !modules.contains(entry->sender) && message->command != vm::Command::kRep &&
        !about_the_client) {
      replay_.push_back(*entry);
    }
  }
  replay_pending_ = replay_.size();
}

void Session::StartReplay() {
  if (replay_.empty()) return;
  class Nowhere final : public Link {  // what is answered is in the session's log
    void Send(std::string_view) override {}
    void Close() override {}
  };
  const auto key =
      hub_.Attach(std::make_unique<Nowhere>(), PeerKind::kClient, "REPLAY", Dialect::kAuto);
  if (!key) throw std::runtime_error("replay: " + key.error().text);
  const vm::Time first = replay_.front().time;
  for (const LogEntry& entry : replay_) {
    const auto offset =
        std::chrono::duration_cast<vm::Time>((entry.time - first) / options_.replay_speed);
    clock_.After(offset, [this, peer = *key, line = entry.line] {
      --replay_pending_;
      quiet_ = false;
      hub_.OnLine(peer, std::string_view(line));
    });
  }
}

bool Session::Started() const {
  if (started_once_) return hub_.Probing().empty();
  return hub_.Probing().empty() &&
         std::ranges::all_of(config_.modules, [this](const ModuleConfig& module) {
           return hub_.IsReady(module.name) || !supervisor_.IsExpected(module.name);
         });
}

bool Session::SomethingGoesOn() const {
  if (mcl_.Busy() || hub_.HasHeld() || replay_pending_ > 0) return true;
  if (clock_.real()) return !quiet_;
  return std::ranges::any_of(next_, [](const auto& entry) { return entry.second.busy; });
}

void Session::AskQuiet() {
  // Only asked when somebody waits for it. Each module answers after all that was said to it
  // before.
  const bool wanted = idle_wait_ || console_ended_ || (options_.replay && replay_pending_ == 0);
  if (quiet_ || asking_quiet_ || !wanted) return;
  asking_quiet_ = true;
  const auto modules = hub_.ModernModules();
  auto round = std::make_shared<QuietRound>(QuietRound{modules.size() + 1, false});
  const auto answered = [this, round](const Result<std::string>& answer) {
    round->busy = round->busy || (answer && *answer == "BUSY");
    if (--round->open > 0) return;
    clock_.After(round->busy ? kQuietAgain : vm::Time(0), [this, round] {
      asking_quiet_ = false;
      quiet_ = !round->busy && !mcl_.Busy();
      AskQuiet();
    });
  };
  for (const PeerKey module : modules) {
    hub_.Ask("AM", vm::To(hub_.NameOf(module), vm::Inq("Clock.busy")), answered);
  }
  answered("IDLE");
}

void Session::CheckIdleWait() {
  if (!idle_wait_ || SomethingGoesOn()) return;
  const Reply reply = *std::exchange(idle_wait_, std::nullopt);
  reply.Ok("IDLE");
  FeedConsole();
}

bool Session::Over() const {
  if (stop_) return true;
  if (options_.replay && !options_.console) {
    return started_once_ && replay_pending_ == 0 && !SomethingGoesOn();
  }
  if (options_.serve || !options_.console) return false;
  return console_ended_ && console_lines_.empty() && !timed_wait_ && !idle_wait_ &&
         !SomethingGoesOn();
}

void Session::GrantAll(vm::Time time) {
  for (const PeerKey module : hub_.ModernModules()) {
    open_grants_.insert(module);
    hub_.AskClock(module, time, [this, module](const Result<std::string>& answer) {
      OnClockAnswer(module, answer);
    });
  }
  granted_ = time;
  // Real time: the session's own clock stands until all have answered.
  grant_timer_.expires_after(kGrantPatience);
  grant_timer_.async_wait([this](const auto& error) {
    if (error) return;
    const auto late = open_grants_;
    for (const PeerKey module : late) {
      const std::string name = hub_.NameOf(module);
      ++errors_;
      std::cerr << "agent_manager: @" << name << " has not followed the clock for "
                << kGrantPatience.count() << " ms, it is ended" << std::endl;
      if (!supervisor_.Kill(name)) hub_.Detach(module, "does not follow the clock");
    }
  });
}

void Session::OnClockAnswer(PeerKey module, const Result<std::string>& answer) {
  open_grants_.erase(module);
  if (open_grants_.empty()) grant_timer_.cancel();
  if (!answer) {
    next_.erase(module);
    return;
  }
  std::istringstream words(*answer);  // NOW NEXT [BUSY]
  std::string now, next, busy;
  words >> now >> next >> busy;
  NextEvent& event = next_[module];
  event.at.reset();
  if (const auto at = vm::ParseMs(next)) event.at = *at;
  event.busy = busy == "BUSY";
}

void Session::StepVirtual() {
  // Only when nothing is on its way: all grants answered, nothing due here, nobody newly spoken to.
  if (!open_grants_.empty() || !Started()) {
    io_.run_one();
    return;
  }
  if (io_.poll() > 0) return;
  if (clock_.Next() && *clock_.Next() <= clock_.Now()) {
    clock_.Advance(clock_.Now());
    return;
  }
  if (granted_ != clock_.Now() || !hub_.dirty().empty()) return GrantAll(clock_.Now());
  CheckIdleWait();
  if (!hub_.dirty().empty() || (clock_.Next() && *clock_.Next() <= clock_.Now())) return;
  const bool time_wanted = SomethingGoesOn() || timed_wait_ || idle_wait_;
  std::optional<vm::Time> next = clock_.Next();
  for (const auto& [module, event] : next_) {
    if (event.at && (!next || *event.at < *next)) next = event.at;
  }
  if (time_wanted && next) {
    clock_.Advance(*next);
    return GrantAll(clock_.Now());
  }
  if (!Over()) io_.run_one();
}

void Session::EndProbesInTime(const std::set<PeerKey>& asked_before) {
  hub_.EndProbes(asked_before);
  probe_timer_.expires_after(config_.start_limit);
  probe_timer_.async_wait([this, probing = hub_.Probing()](const auto& error) {
    if (!error) EndProbesInTime(probing);
  });
}

std::string Session::SlotsMarkdown() const {
  return "### @AM\n\n" + slots_.DocsMarkdown() + "\n### @AM-MCL, @FS-MCL\n\n" +
         const_cast<Mcl&>(mcl_).slots().DocsMarkdown();
}

int Session::Run() {
  const auto work = boost::asio::make_work_guard(io_);
  boost::asio::signal_set signals(io_, SIGINT, SIGTERM);
  signals.async_wait([this](const auto& error, int) {
    if (!error) stop_ = true;
  });
  for (const std::string& text : config_.listen) {
    const auto endpoint = vm::ParseEndpoint(text);
    if (!endpoint) throw std::runtime_error("listen: " + endpoint.error().text);
    listeners_.push_back(vm::Listener::Open(io_, *endpoint, [this](int fd, const std::string&) {
      const auto stream = vm::StreamPeer::Make(io_, fd, fd, vm::Framing::kAuto);
      const auto key =
          hub_.Attach(std::make_unique<StreamLink>(stream), PeerKind::kClient, "", Dialect::kAuto);
      if (!key) return;
      stream->Start([this, peer = *key](
                        Result<std::string_view> line) { hub_.OnLine(peer, std::move(line)); },
                    [this, peer = *key](const std::string& reason) { hub_.Detach(peer, reason); });
    }));
    std::cerr << "agent_manager: listening on " << vm::FormatEndpoint(listeners_.back()->endpoint())
              << std::endl;
  }
  supervisor_.StartAll(config_.modules);
  EndProbesInTime({});
  if (options_.console) StartConsole();
  boost::asio::steady_timer measure(io_);
  std::function<void()> measure_again = [&] {
    measure.expires_after(kMeasureEvery);
    measure.async_wait([&](const auto& error) {
      if (error) return;
      hub_.MeasureClocks();
      measure_again();
    });
  };
  if (clock_.real()) measure_again();

  while (!Over()) {
    if (!started_once_ && Started()) {
      started_once_ = true;
      StartReplay();
    }
    // Also the lines held back while a module that was started again is being asked what it knows.
    if (!console_lines_.empty()) FeedConsole();
    if (clock_.real()) {
      AskQuiet();
      CheckIdleWait();
      if (!Over()) io_.run_one();
    } else {
      StepVirtual();
    }
  }
  Shutdown();
  return options_.strict && errors_ > 0 ? 1 : 0;
}

void Session::Shutdown() {
  listeners_.clear();
  bool done = false;
  supervisor_.StopAll([&done] { done = true; });
  while (!done) io_.run_one();
  if (console_stream_ == nullptr) return;
  bool flushed = false;
  boost::asio::steady_timer limit(io_, kFlushPatience);
  limit.async_wait([&flushed](const auto&) { flushed = true; });
  console_stream_->Flush([&flushed] { flushed = true; });
  while (!flushed) io_.run_one();
}

}  // namespace am
