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

#include "agent_manager/mqtt/bridge.h"
#include "agent_manager/service_notify.h"
#include "agent_manager/web/web_server.h"
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

constexpr milliseconds kMeasureEvery{2000};
constexpr vm::Time kVirtualStart =
    milliseconds(10000);  // past every module's own clock at its start
constexpr milliseconds kFlushLogEvery{500};
constexpr milliseconds kFlushPatience{2000};

Result<std::string> ReadFileResult(const std::string& path) {
  try {
    return ReadWhole(path);
  } catch (const std::runtime_error& error) {
    return vm::Fail(Errc::kUnavailable, error.what());
  }
}

}  // namespace

std::string ReadWhole(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  if (!file || (!(text << file.rdbuf()) && file.peek() != std::ifstream::traits_type::eof())) {
    throw std::runtime_error("cannot read '" + path + "'");
  }
  return text.str();
}

Session::Session(Config config, Options options)
    : config_(std::move(config)),
      options_(std::move(options)),
      clock_(io_, !config_.virtual_clock),
      log_writer_(config_.log.file.empty()
                      ? nullptr
                      : std::make_unique<LogWriter>(config_.log,
                                                    [](const std::string& text) {
                                                      std::cerr << "agent_manager: " << text
                                                                << std::endl;
                                                    })),
      log_([this](std::string_view line) {
        if (log_writer_) log_writer_->Write(line);
        if (!onlookers_.empty()) ShowOnlookers(line);
      }),
      hub_(clock_, log_),
      slots_("AM"),
      mcl_(clock_, hub_, ReadFileResult,
           [](const std::string& path) { std::remove(path.c_str()); }),
      supervisor_(
          io_, hub_,
          [](const std::string& text) { std::cerr << "agent_manager: " << text << std::endl; },
          [this](const std::string& module, const OutputLine& line) {
            std::cerr << "agent_manager: " << module << " " << line.level << ": " << line.text
                      << std::endl;
            slots_.Report("Module." + module + ".output", line.level + " " + line.text);
          }),
      probe_timer_(io_),
      grant_timer_(io_),
      watchdog_timer_(io_),
      log_timer_(io_),
      reload_signal_(io_) {
  log_.set_enabled(log_writer_ != nullptr);
  if (config_.virtual_clock) {
    supervisor_.set_watch_health(false);
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
    if (mqtt_ != nullptr) mqtt_->OnPresence(name, present, reason);
    if (!present) return;
    next_.clear();
    supervisor_.OnPresent(name);
  });
  hub_.set_on_unknown([this](const std::string& name) -> Result<bool> {
    return mqtt_ != nullptr ? mqtt_->Open(name) : Result<bool>(false);
  });
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
  if (options_.replay) LoadReplay(*options_.replay);
}

Session::~Session() = default;

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
  ApplyConfig();
  ReloadOnSignal();
  StartWeb();
  if (clock_.real()) FlushLog();
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
      NotifyService("READY=1");
      FeedWatchdog();
      StartReplay();
    }
    // Also the lines held back while a module that was started again is being asked what it knows.
    if (!console_lines_.empty()) FeedConsole();
    if (clock_.real()) {
      AskQuiet();
      CheckIdleWait();
      if (!Over()) RunSome();
    } else {
      StepVirtual();
    }
  }
  Shutdown();
  return options_.strict && errors_ > 0 ? 1 : 0;
}

void Session::RunSome() {
  if (config_.spin.count() > 0) {
    const auto until = std::chrono::steady_clock::now() + config_.spin;
    do {
      if (io_.poll_one() > 0) return;
    } while (std::chrono::steady_clock::now() < until);
  }
  io_.run_one();
}

void Session::ShowOnlookers(std::string_view line) {
  std::string comment = "# flow ";  // a comment: whoever does not know it passes over it
  comment += line;
  std::erase_if(onlookers_, [&](PeerKey peer) { return !hub_.SendUnlogged(peer, comment); });
  log_.set_enabled(log_writer_ != nullptr || !onlookers_.empty());
}

void Session::FlushLog() {
  if (!log_writer_) return;
  log_writer_->Flush();
  log_timer_.expires_after(kFlushLogEvery);
  log_timer_.async_wait([this](const auto& error) {
    if (!error) FlushLog();
  });
}

void Session::StartWeb() {
  if (config_.web.at.empty()) return;
  web_ = std::make_unique<WebServer>(
      io_, config_.web, hub_, [this] { return Metrics(); },
      [this](const std::string& text) { Refused(text); });
  std::cerr << "agent_manager: the page is at " << web_->Address() << std::endl;
}

void Session::FeedWatchdog() {
  const auto period = WatchdogPeriod();
  if (!period) return;
  NotifyService("WATCHDOG=1");
  watchdog_timer_.expires_after(*period / 2);
  watchdog_timer_.async_wait([this](const auto& error) {
    if (!error) FeedWatchdog();
  });
}

void Session::Shutdown() {
  NotifyService("STOPPING=1");
  doors_.clear();
  bool done = false;
  supervisor_.StopAll([&done] { done = true; });
  while (!done) io_.run_one();
  web_.reset();  // after the face, which may be writing pictures for it
  mqtt_.reset();
  if (console_stream_ == nullptr) return;
  bool flushed = false;
  boost::asio::steady_timer limit(io_, kFlushPatience);
  limit.async_wait([&flushed](const auto&) { flushed = true; });
  console_stream_->Flush([&flushed] { flushed = true; });
  while (!flushed) io_.run_one();
}

}  // namespace am
