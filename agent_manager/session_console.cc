// What people type, what a log says again, and when nothing goes on any more.

#include <unistd.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "agent_manager/session.h"

namespace am {

using std::chrono::milliseconds;
using vm::Errc;
using vm::Reply;
using vm::Result;
using vm::SetValue;

namespace {

constexpr vm::Time kQuietAgain = milliseconds(30);

}  // namespace

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
  std::istringstream text(ReadLog(path));
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
  return hub_.Probing().empty() && supervisor_.AllReady();
}

bool Session::SomethingGoesOn() const {
  if (mcl_.Busy() || hub_.HasHeld() || replay_pending_ > 0) return true;
  if (clock_.real()) return !quiet_;
  return std::ranges::any_of(next_, [](const auto& entry) { return entry.second.busy; });
}

void Session::AskQuiet() {
  // Only asked when somebody waits for it. Each module answers after all that was said to it
  // before.
  const bool wanted = idle_wait_ || (console_ended_ && !options_.serve) ||
                      (options_.replay && replay_pending_ == 0);
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

}  // namespace am
