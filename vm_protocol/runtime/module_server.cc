#include "vm_protocol/runtime/module_server.h"

#include <algorithm>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <utility>

#include "vm_protocol/core/file_kind.h"
#include "vm_protocol/core/limits.h"
#include "vm_protocol/core/text_file.h"
#include "vm_protocol/core/utf8.h"

namespace vm {
namespace {

constexpr auto kFlushLimit = std::chrono::seconds(3);  // for a reader that does not read at the end
constexpr auto kCloseLimit = std::chrono::milliseconds(200);
/// How long a peer whose input has ended is kept for the end of what goes on.
constexpr auto kHalfClosedLimit = std::chrono::seconds(60);
/// A module may become idle by the clock alone, without a timer of its own: we have to look.
constexpr auto kIdleCheck = std::chrono::milliseconds(20);
constexpr std::size_t kMaxFileBytes = 4u << 20;  // read by `<` and `do FILE`

Result<void> AppendTextFile(const std::string& path, const std::string& text) {
  if (auto fit = CheckWritable(path); !fit) return fit;
  std::ofstream file(path, std::ios::binary | std::ios::app);
  if (!file || !(file << text) || !file.flush()) {
    return Fail(Errc::kUnavailable, "cannot write '" + path + "': " + std::strerror(errno));
  }
  return {};
}

}  // namespace

ModuleServer::ModuleServer(boost::asio::io_context& io, ClockScheduler& clock, Module& module,
                           Options options)
    : io_(io), clock_(clock), module_(module), options_(std::move(options)) {
  SlotMachine& slots = module_.slots();
  slots.set_output([this](PeerId id, const Message& message) { Emit(id, message); });
  slots.set_read_file([](const std::string& path) { return ReadTextFile(path, kMaxFileBytes); });
  slots.set_append_file(AppendTextFile);
  slots.set_on_error([this](PeerId, const std::string& line, const Error& error) {
    ++errors_;
    Complain("error: " + FormatError(error) + (line.empty() ? "" : " (in: " + line + ")"));
  });
  // EXIT comes after what was said before it; said again, it comes at once.
  slots.set_exit_gate([this](std::function<void()> exit) {
    held_exits_.push_back(std::move(exit));
    if (module_.Busy() && held_exits_.size() == 1) return;
    for (const auto& held : std::exchange(held_exits_, {})) held();
  });
  DeclareSlots();
}

ModuleServer::~ModuleServer() {
  for (auto& [id, peer] : peers_) peer.stream->Close();
}

void ModuleServer::Complain(std::string_view text) const {
  std::cerr << options_.program_name << ": " << ShownUtf8(text) << std::endl;
}

void ModuleServer::DeclareSlots() {
  SlotMachine& slots = module_.slots();
  slots.Declare(
      {.name = "Clock",
       .grammar = "<number 0..>",
       .initial = "0",
       .help = "This process's clock, in ms since its start. Setting it moves the clock on where "
               "Clock.mode is HUB: everything due until then is done first; the answer is the time "
               "reached and the time of the next thing to do, or - for nothing, and BUSY or IDLE.",
       .on_set = [this](const SetValue& value) { return SetClock(value); },
       .on_inq = [this] { return FormatMs(clock_.Now()); },
       .saved = false});
  slots.Declare(
      {.name = "Clock.mode",
       .grammar = "REAL | VIRTUAL | HUB",
       .help =
           "REAL: the machine's clock. VIRTUAL: time stands while nothing goes on and jumps from "
           "event to event otherwise. HUB: time moves only by set Clock.",
       .on_set = [this](const SetValue& value) -> Result<std::string> {
         hub_clock_ = value.word(0) == "HUB";
         if (value.word(0) == "REAL") {
           clock_.UseReal();
         } else {
           clock_.UseVirtual();
         }
         return value.word(0);
       },
       .on_inq = [this] { return clock_.real() ? "REAL"
                                 : hub_clock_  ? "HUB"
                                               : "VIRTUAL"; },
       .saved = false});
  slots.Declare({.name = "Clock.busy",
                 .grammar = "<text>",
                 .access = Access::kReadOnly,
                 .help = "BUSY while something with an end is going on, else IDLE.",
                 .on_inq = [this] { return module_.Busy() ? "BUSY" : "IDLE"; }});
  slots.Declare(
      {.name = "Wait",
       .grammar = "IDLE | <ms>",
       .access = Access::kWriteOnly,
       .help = "Holds the lines that follow from the same peer for so many ms, or until nothing is "
               "going on (IDLE).",
       .on_set_later = [this](const SetValue& value, const Reply& reply) {
         SetWait(value, reply);
       }});
}

std::string ModuleServer::ClockText() const {
  const auto next = clock_.Next();
  return FormatMs(clock_.Now()) + " " + (next ? FormatMs(*next) : "-") +
         (module_.Busy() ? " BUSY" : " IDLE");
}

Result<std::string> ModuleServer::SetClock(const SetValue& value) {
  if (!hub_clock_ || clock_.real()) {
    return Fail(Errc::kAccess, "the clock can be set only where Clock.mode is HUB");
  }
  const auto until = ParseMs(value.word(0));
  if (!until) return std::unexpected(until.error());
  clock_.Advance(*until);
  return ClockText();
}

void ModuleServer::SetWait(const SetValue& value, const Reply& reply) {
  const auto found = peers_.find(value.peer);
  if (found == peers_.end()) return reply.Ok(value.text);
  Peer& peer = found->second;
  peer.waiting = true;
  peer.stream->PauseReading();
  if (value.word(0) == "IDLE") {
    peer.on_idle = reply;  // Settle ends it
    return;
  }
  const Time delay(static_cast<Time::rep>(value.number(0) * 1000.0));
  clock_.After(delay, [this, id = value.peer, reply] { EndWait(id, reply); });
}

void ModuleServer::EndWait(PeerId id, const Reply& reply) {
  reply.Ok("0");
  const auto found = peers_.find(id);
  if (found == peers_.end()) return;
  found->second.waiting = false;
  found->second.on_idle.reset();
  found->second.stream->ResumeReading();
}

bool ModuleServer::HasRoom() const {
  if (!options_.one_client) return peers_.size() < kMaxConnections;
  return std::ranges::all_of(peers_, [](const auto& entry) { return entry.second.ended; });
}

void ModuleServer::AddPeer(std::shared_ptr<StreamPeer> stream, PeerOptions options) {
  const PeerId id = ++last_peer_;
  Peer& peer = peers_[id];
  peer.stream = std::move(stream);
  peer.ends_module = options.ends_module;
  peer.called = !options.first_lines.empty();
  peer.stream->HoldInputWhileBehind();
  if (!options.already_read.empty()) peer.stream->Prefeed(std::move(options.already_read));
  for (const std::string& line : options.first_lines) peer.stream->Send(line);
  for (const Message& message : module_.Greeting()) Emit(id, message);
  if (options.wants_errors) module_.slots().HandleLine("prop Error = AutoOutput", id);
  peer.stream->Start([this, id](Result<std::string_view> line) { OnLine(id, std::move(line)); },
                     [this, id](const StreamEnd& end) { OnEnd(id, end); });
}

void ModuleServer::OnLine(PeerId id, Result<std::string_view> line) {
  if (const auto found = peers_.find(id); found != peers_.end()) found->second.heard = true;
  if (!line) {
    ++errors_;
    Complain("error: " + FormatError(line.error()));
    Message rep = Rep("Error", FormatError(line.error()));
    if (module_.slots().AutoOutput("Error")) Emit(id, rep);
    return;
  }
  if (options_.original_socket_words) {
    if (*line == "CloseSocket") return RequestStop();
    if (*line == "set Run = CLOSE") return OnEnd(id, {false, "closed on request"});
  }
  module_.slots().HandleLine(*line, id);
}

void ModuleServer::OnEnd(PeerId id, const StreamEnd& end) {
  const auto found = peers_.find(id);
  if (found == peers_.end()) return;
  if (!end.orderly) Complain("peer " + std::to_string(id) + ": " + end.reason);
  if (found->second.ends_module) {
    const bool refused = found->second.called && !found->second.heard;
    if (refused) Complain("the hub has ended the connection without a word");
    failed_ = refused || !end.orderly;
    module_ending_ = true;
    found->second.ended = true;
    return;
  }
  if (end.orderly) {  // it may still read: Settle releases it
    found->second.ended = true;
    found->second.kept_until = std::chrono::steady_clock::now() + kHalfClosedLimit;
    return;
  }
  found->second.stream->Close();
  peers_.erase(found);
  module_.slots().PeerGone(id);
}

void ModuleServer::Release(PeerId id) {
  const auto stream = std::move(peers_.at(id).stream);
  peers_.erase(id);
  module_.slots().PeerGone(id);
  const auto limit = std::make_shared<boost::asio::steady_timer>(io_, kFlushLimit);
  limit->async_wait([stream, limit](const auto&) { stream->Close(); });
  stream->Flush([limit] { limit->cancel(); });
}

void ModuleServer::Emit(PeerId id, const Message& message) {
  const std::string line = FormatMessage(message);
  if (id == kEveryone) {
    for (auto& [peer_id, peer] : peers_) peer.stream->Send(line);
    return;
  }
  if (const auto found = peers_.find(id); found != peers_.end()) found->second.stream->Send(line);
}

bool ModuleServer::TimeIsWanted() const {
  if (module_.Busy()) return true;  // also while a held EXIT waits for it
  for (const auto& [id, peer] : peers_) {
    if (peer.waiting) return true;
  }
  return false;
}

bool ModuleServer::Settle() {
  if (stop_ || module_.ExitRequested()) return true;
  if (!held_exits_.empty() && !module_.Busy()) {
    for (const auto& exit : std::exchange(held_exits_, {})) exit();
    return Settle();
  }
  bool waiting = false;
  for (auto& [id, peer] : peers_) {
    if (peer.ended && !peer.ends_module &&
        (!module_.Busy() || std::chrono::steady_clock::now() > peer.kept_until)) {
      Release(id);
      return false;
    }
    if (peer.on_idle && !module_.Busy()) {
      const Reply reply = *peer.on_idle;
      EndWait(id, reply);
      return false;  // its next lines come first
    }
    waiting = waiting || peer.waiting;
  }
  return module_ending_ && !waiting && !module_.Busy();
}

bool ModuleServer::IdleIsAwaited() const {
  return module_ending_ || !held_exits_.empty() ||
         std::ranges::any_of(peers_, [](const auto& entry) {
           return entry.second.ended || entry.second.on_idle.has_value();
         });
}

void ModuleServer::Step() {
  if (clock_.real() || hub_clock_) {
    if (IdleIsAwaited()) {
      io_.run_one_for(kIdleCheck);
    } else {
      io_.run_one();
    }
    return;
  }
  // Alone on the virtual clock: input first, then time, then wait for input.
  if (io_.poll() > 0) return;
  if (TimeIsWanted() && clock_.AdvanceToNext()) return;
  io_.run_one();
}

int ModuleServer::Run() {
  const auto work = boost::asio::make_work_guard(io_);
  while (!Settle()) Step();
  Finish();
  return errors_;
}

void ModuleServer::Finish() {
  module_.Shutdown();
  // What is not flushed by then may still be told later: the count outlives this call.
  const auto unflushed = std::make_shared<std::size_t>(peers_.size());
  for (auto& [id, peer] : peers_) peer.stream->Flush([unflushed] { --*unflushed; });
  const auto limit = std::chrono::steady_clock::now() + kFlushLimit;
  while (*unflushed > 0 && io_.run_one_until(limit) > 0) {
  }
  for (auto& [id, peer] : peers_) peer.stream->Close();
  // What closing cancels lets go of its streams; whatever else runs here may never end.
  const auto closed = std::chrono::steady_clock::now() + kCloseLimit;
  while (std::chrono::steady_clock::now() < closed && io_.poll_one() > 0) {
  }
}

}  // namespace vm
