#include "agent_manager/session/console.h"

#include <unistd.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "agent_manager/routing/own_names.h"
#include "agent_manager/session/stream_link.h"
#include "vm_protocol/core/nearest_word.h"

namespace am {

using vm::Errc;
using vm::Reply;
using vm::Result;

namespace {

constexpr const char* kHelp[] = {
    "# to @NAME set SLOT = VALUE       set a module's slot          to @SSM set Volume = 80",
    "# to @NAME inq SLOT               ask its value                to @SSM inq Speaker",
    "# help NAME                       the slots of a module          help FSM",
    "# inq Modules                     who can be spoken to",
    "# to @NAME inq Slots              what a module knows; inq SLOT.help explains one",
    "# to @AM-MCL set Speak = TEXT     speak, with the lips in step",
    "# set Wait = IDLE                 hold the next lines until nothing goes on",
    "# quit                            end the hub and its modules (as set Run = EXIT)",
    "# docs/protocol.md has the rest"};

/// The word behind `first`, if a line is these two and no more; nothing for any other line.
std::optional<std::string> WordBehind(std::string_view first, std::string_view line) {
  if (!line.starts_with(first) || line.size() <= first.size() || line[first.size()] != ' ')
    return {};
  line.remove_prefix(std::min(line.find_first_not_of(' ', first.size()), line.size()));
  line = line.substr(0, line.find_last_not_of(" \r") + 1);
  if (line.starts_with('@')) line.remove_prefix(1);
  if (line.empty() || line.contains(' ')) return {};
  return std::string(line);
}

bool IsQuit(std::string_view line) { return line == "quit" || line == "exit"; }

}  // namespace

Console::Console(boost::asio::io_context& io, vm::Scheduler& clock, Hub& hub, Hooks hooks)
    : io_(io), clock_(clock), hub_(hub), hooks_(std::move(hooks)) {}

void Console::Start(const std::vector<std::string>& first_lines) {
  stream_ = vm::StreamPeer::Make(io_, STDIN_FILENO, STDOUT_FILENO, vm::Framing::kLf);
  key_ = hub_.Attach(std::make_unique<StreamLink>(stream_, hooks_.on_told), PeerKind::kConsole,
                     Role::kOwner, own_name::kConsole, Dialect::kAuto)
             .value();
  for (const char* const machine : {own_name::kHub, own_name::kMacros})
    hub_.SayAs(
        {.peer = key_, .role = Role::kOwner},
        vm::To(machine,
               {{}, "", vm::Command::kProp, "", "Error", vm::Relation::kAssign, "AutoOutput"}));
  lines_.assign(first_lines.begin(), first_lines.end());
  stream_->Start([this](Result<std::string_view> line) { OnLine(std::move(line)); },
                 [this](const vm::StreamEnd& end) {
                   ended_ = true;
                   if (!end.orderly) hooks_.on_lost(end.reason);
                 });
}

bool Console::TakeWord(const std::string& line) {
  if (line == "help" || line == "?") {
    for (const char* const text : kHelp) hub_.SendComment(key_, text);
    return true;
  }
  if (const auto name = WordBehind("help", line)) {
    Help(*name);
    return true;
  }
  if (line.starts_with("help ")) {
    hub_.SendComment(key_, "# help takes the name of a module or nothing");
    return true;
  }
  if (line.starts_with("quit ") || line.starts_with("exit ")) {
    hub_.SendComment(key_, "# " + line.substr(0, 4) + " takes no words; say it alone");
    return true;
  }
  if (!IsQuit(line)) return false;
  hooks_.on_quit();
  return true;
}

void Console::Help(const std::string& name) {
  const Directory& directory = hub_.directory();
  if (!directory.IsPresent(name) && directory.Machine(name) == nullptr) {
    const std::vector<std::string> known = directory.Addressable();
    std::string names;
    for (const std::string& one : known) names += " " + one;
    hub_.SendComment(key_, "# there is no @" + name + vm::DidYouMean(name, known) +
                               "; help takes one of:" + names);
    return;
  }
  hub_.SendComment(key_, "# the slots of @" + name + "; to @" + name +
                             " inq SLOT.help explains one, docs/reference/slots.md all");
  hub_.Receive(key_, std::string_view("to @" + name + " inq Slots"));
}

void Console::OnLine(Result<std::string_view> line) {
  if (!line) return hub_.Receive(key_, std::unexpected(line.error()));
  // A person who wants to leave does not wait for modules that do not start.
  if (lines_.empty() && !hooks_.started() && IsQuit(*line)) return hooks_.on_quit();
  lines_.emplace_back(*line);
  Feed();
}

void Console::Feed() {
  // One line after the other: what it does, waiting above all, is known before the next.
  while (!lines_.empty() && !timed_wait_ && !idle_wait_ && !saying_ && hooks_.started()) {
    const std::string line = std::move(lines_.front());
    lines_.pop_front();
    hooks_.on_said();
    if (TakeWord(line)) continue;
    saying_ = true;
    hub_.Receive(key_, std::string_view(line));
    hub_.Post([this] {
      saying_ = false;
      Feed();
    });
  }
  if (stream_ == nullptr) return;
  // A script of any length may be piped in.
  if (lines_.size() > kMaxLines) {
    stream_->PauseReading();
  } else {
    stream_->ResumeReading();
  }
}

void Console::AskWait(const vm::SetValue& value, const Reply& reply) {
  if (value.peer != key_ || key_ == kHub)
    return reply.Fail({Errc::kAccess, "only the console's lines can be held", 0});
  if (value.word(0) == "IDLE") {
    idle_wait_ = reply;
    return;
  }
  timed_wait_ = true;
  clock_.After(vm::Time(static_cast<vm::Time::rep>(value.number(0) * 1000)), [this, reply] {
    timed_wait_ = false;
    reply.Ok("0");
    Feed();
  });
}

void Console::OnIdle() {
  if (!idle_wait_) return;
  const Reply reply = *std::exchange(idle_wait_, std::nullopt);
  reply.Ok("IDLE");
  Feed();
}

}  // namespace am
