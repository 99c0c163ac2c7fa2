#include "agent_manager/supervision/supervisor.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/signal_set.hpp>
#include <cctype>
#include <csignal>
#include <stdexcept>

#include "agent_manager/session/stream_link.h"
#include "agent_manager/supervision/process.h"
#include "agent_manager/supervision/supervisor_child.h"
#include "vm_protocol/core/utf8.h"
#include "vm_protocol/runtime/acceptor.h"

namespace am {

using std::chrono::milliseconds;
using SteadyClock = std::chrono::steady_clock;

namespace {

constexpr milliseconds kClosedPatience{500};  // after it closed its output
constexpr std::size_t kLevelWithin = 80;      // bytes of a line in which its level is looked for

vm::Framing FramingOf(const ModuleConfig& module) {
  return module.framing == "mmi" ? vm::Framing::kMmi : vm::Framing::kLf;
}
vm::Encoding EncodingOf(const ModuleConfig& module) {
  return vm::ParseEncoding(module.encoding).value_or(vm::Encoding::kUtf8);
}

}  // namespace

std::string LevelOf(std::string_view line) {
  std::string start(line.substr(0, kLevelWithin));
  std::ranges::transform(start, start.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto says = [&](std::string_view word) {
    const std::size_t at = start.find(word);
    return at != std::string::npos &&
           (at == 0 || std::isalpha(static_cast<unsigned char>(start[at - 1])) == 0);
  };
  if (says("error") || says("fatal") || says("critical") || says("sanitizer")) return "ERROR";
  return says("warn") ? "WARNING" : "INFO";
}

struct Supervisor::Signals {
  explicit Signals(boost::asio::io_context& io) : set(io, SIGCHLD) {}
  boost::asio::signal_set set;
};

Supervisor::Supervisor(boost::asio::io_context& io, Hub& hub, OnNotice on_notice,
                       OnOutput on_output)
    : io_(io),
      hub_(hub),
      on_notice_(std::move(on_notice)),
      on_output_(std::move(on_output)),
      signals_(std::make_unique<Signals>(io)) {
  OnSignal();
}

Supervisor::~Supervisor() {
  for (const auto& child : children_) {
    child->Signal(SIGKILL);
  }
}

void Supervisor::OnSignal() {
  signals_->set.async_wait([this](const auto& error, int) {
    if (error) return;
    const auto children = children_;
    for (const auto& child : children) {
      int status = 0;
      if (child->pid > 0 && waitpid(child->pid, &status, WNOHANG) == child->pid)
        Reap(child, status);
    }
    OnSignal();
  });
}

Supervisor::ChildPtr Supervisor::Find(const std::string& name) const {
  const auto found = std::ranges::find_if(
      children_, [&](const auto& child) { return child->config.name == name && !child->removed; });
  return found == children_.end() ? nullptr : *found;
}

void Supervisor::StartWhatCan() {
  if (stopping_) return;
  const auto children = children_;
  for (const auto& child : children) {
    if (child->state == State::kWaiting && MayStart(*child)) Start(child);
  }
}

void Supervisor::Start(const ChildPtr& child) {
  child->state = State::kStarting;
  child->killed_for.clear();
  child->health_misses = 0;
  child->history.Started(SteadyClock::now());
  ++child->starts;
  if (child->config.command.empty()) {
    Dial(child);
  } else {
    Spawn(child);
  }
}

void Supervisor::Spawn(const ChildPtr& child) {
  const auto spawned = SpawnProcess(child->config);
  if (!spawned) {
    if (first_apply_) throw std::runtime_error(spawned.error().text);
    on_notice_(spawned.error().text);
    child->ending = spawned.error().text;
    return GiveUp(child, State::kFailed,
                  spawned.error().text);  // it will not be there later either
  }
  child->pid = spawned->pid;
  ReadErrors(child, spawned->from_errors);
  Join(child, vm::StreamPeer::Make(io_, spawned->from_output, spawned->to_input,
                                   FramingOf(child->config), EncodingOf(child->config)));
}

void Supervisor::Dial(const ChildPtr& child) {
  const auto endpoint = vm::ParseEndpoint(child->config.connect);
  if (!endpoint) throw std::runtime_error("@" + child->config.name + ": " + endpoint.error().text);
  vm::Connect(io_, *endpoint, child->config.credentials, FramingOf(child->config),
              EncodingOf(child->config),
              [this, child](const vm::Result<std::shared_ptr<vm::StreamPeer>>& stream) {
                if (stream && child->state == State::kStarting) return Join(child, *stream);
                if (stream) return (*stream)->Close();  // stopped meanwhile
                on_notice_("@" + child->config.name + ": " + stream.error().text);
                Ended(child, stream.error().text, true);
              });
}

void Supervisor::Join(const ChildPtr& child, std::shared_ptr<vm::StreamPeer> stream) {
  child->stream = std::move(stream);
  const auto key = hub_.AttachModule(std::make_unique<StreamLink>(child->stream),
                                     child->config.name, child->config.dialect, child->config.cwd);
  if (!key) return KillChild(child, key.error().text);
  child->peer = *key;
  AwaitReady(child);
  child->stream->Start(
      [this, peer = *key](vm::Result<std::string_view> line) {
        hub_.Receive(peer, std::move(line));
      },
      [this, child, peer = *key](const std::string& reason) {
        if (child->peer == peer) OnEnd(child, reason);
      });
  child->stream->ResumeReading();
}

void Supervisor::ReadErrors(const ChildPtr& child, int fd) {
  child->errors =
      vm::StreamPeer::Make(io_, fd, open("/dev/null", O_WRONLY | O_CLOEXEC), vm::Framing::kLf);
  child->errors->Start(
      [this, child](vm::Result<std::string_view> line) {
        OutputLine said{"", vm::ShownUtf8(line ? *line : vm::FormatError(line.error()))};
        said.level = LevelOf(said.text);
        on_output_(child->config.name, said);
        child->output.push_back(std::move(said));
        if (child->output.size() > kMaxOutputLines) child->output.pop_front();
      },
      // Lets go of the child, which would otherwise own itself through this stream.
      [errors = std::weak_ptr(child->errors)](const std::string&) {
        if (const auto stream = errors.lock()) stream->Close();
      });
}

void Supervisor::OnEnd(const ChildPtr& child, const std::string& reason) {
  if (child->pid > 0) {
    // Usually the process is ending and SIGCHLD will tell why; one that only closed its output, or
    // does not read, is of no use any more and gets a moment to go.
    if (child->state == State::kStopping) return;  // it has the time to stop that it was given
    child->stop_timer.expires_after(kClosedPatience);
    child->stop_timer.async_wait([child, reason](const auto& error) {
      if (error) return;
      child->killed_for = reason;
      child->Signal(SIGKILL);
    });
    return;
  }
  LeaveHub(child, reason, [this, child, reason] { Ended(child, reason, true); });
}

void Supervisor::LeaveHub(const ChildPtr& child, const std::string& reason,
                          std::function<void()> next) {
  if (child->peer != 0) hub_.Leave(std::exchange(child->peer, 0), reason);
  hub_.Post(std::move(next));
}

void Supervisor::Reap(const ChildPtr& child, int status) {
  child->Signal(SIGKILL);  // what it has started and left behind
  child->pid = -1;
  child->stop_timer.cancel();  // it was for this process, not for the next one
  std::string ending = DescribeEnding(status);
  if (!child->killed_for.empty()) ending += " (" + child->killed_for + ")";
  const bool failed = !WIFEXITED(status) || WEXITSTATUS(status) != 0;
  const bool at_start = child->state == State::kStarting && WIFEXITED(status) && failed;
  child->failed_starts = at_start ? child->failed_starts + 1 : 0;
  if (child->state != State::kStopping || failed) {
    const bool told = at_start && !child->output.empty();
    on_notice_("@" + child->config.name + " " + ending + (at_start ? " before it was ready" : "") +
               (told ? ": " + child->output.back().text : ""));
  }
  LeaveHub(child, ending, [this, child, ending, failed] { Ended(child, ending, failed); });
}

void Supervisor::Ended(const ChildPtr& child, const std::string& how, bool failed) {
  child->ready_timer.cancel();
  child->health_timer.cancel();
  child->ending = how;
  if (child->state == State::kStopping || stopping_) return Stopped(child);
  if (child->failed_starts >= kFailedStarts) {
    on_notice_("@" + child->config.name + " has failed to start " +
               std::to_string(child->failed_starts) + " times, it is not started again");
    return GiveUp(child, State::kFailed, how);
  }
  const auto delay = child->history.NextDelay(child->config.restart, failed, SteadyClock::now());
  if (!delay && child->history.gave_up()) {
    on_notice_("@" + child->config.name + " ended " + std::to_string(child->history.recent()) +
               " times within " + vm::FormatMs(child->config.restart.within) +
               " ms, it is not started again");
    return GiveUp(child, State::kFailed, how);
  }
  if (!delay) return GiveUp(child, State::kEnded, how);
  child->state = State::kRestarting;
  child->restart_timer.expires_after(*delay);
  child->restart_timer.async_wait([this, child](const auto& error) {
    if (!error && child->state == State::kRestarting && !stopping_) Start(child);
  });
}

void Supervisor::GiveUp(const ChildPtr& child, State state, const std::string& how) {
  child->ready_timer.cancel();
  child->state = state;
  for (const Done& done : std::exchange(child->on_ready, {}))
    done(vm::Fail(vm::Errc::kUnavailable, "@" + child->config.name + " " + how));
}

}  // namespace am
