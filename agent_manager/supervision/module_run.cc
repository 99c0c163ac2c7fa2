#include "agent_manager/supervision/module_run.h"

#include <fcntl.h>
#include <sys/wait.h>

#include <csignal>
#include <utility>

#include "agent_manager/session/stream_link.h"
#include "agent_manager/supervision/process.h"
#include "vm_protocol/core/utf8.h"
#include "vm_protocol/runtime/acceptor.h"

namespace am {

using std::chrono::milliseconds;

namespace {

constexpr milliseconds kClosedPatience{500};      // after the program closed its output
constexpr milliseconds kStopPatience{4000};       // after set Run = EXIT
constexpr milliseconds kTerminatePatience{1000};  // after SIGTERM

vm::Framing FramingOf(const ModuleConfig& module) {
  return module.framing == "mmi" ? vm::Framing::kMmi : vm::Framing::kLf;
}
vm::Encoding EncodingOf(const ModuleConfig& module) {
  return vm::ParseEncoding(module.encoding).value_or(vm::Encoding::kUtf8);
}

}  // namespace

ModuleRun::ModuleRun(boost::asio::io_context& io, Hub& hub, ChildReaper& reaper,
                     const ModuleConfig& module, Events events)
    : io_(io),
      hub_(hub),
      reaper_(reaper),
      config_(module),
      events_(std::move(events)),
      kill_timer_(io) {}

ModuleRun::~ModuleRun() { Signal(SIGKILL); }

/// To the process and what it has started itself, which are a group of their own, and to the
/// process once more in case it has left that group.
void ModuleRun::Signal(int signal) const {
  if (pid_ <= 0) return;
  kill(-pid_, signal);
  kill(pid_, signal);
}

vm::Result<void> ModuleRun::Start() { return is_process() ? Spawn() : Dial(); }

vm::Result<void> ModuleRun::Spawn() {
  const auto spawned = SpawnProcess(config_);
  if (!spawned) return std::unexpected(spawned.error());
  pid_ = spawned->pid;
  reaper_.Watch(pid_, [self = weak_from_this()](int status) {
    if (const auto run = self.lock()) run->OnExit(status);
  });
  ReadErrors(spawned->from_errors);
  Join(vm::StreamPeer::Make(io_, spawned->from_output, spawned->to_input, FramingOf(config_),
                            EncodingOf(config_)));
  return {};
}

vm::Result<void> ModuleRun::Dial() {
  const auto endpoint = vm::ParseEndpoint(config_.connect);
  if (!endpoint) return std::unexpected(endpoint.error());
  vm::Connect(
      io_, *endpoint, config_.credentials, FramingOf(config_), EncodingOf(config_),
      [self = shared_from_this()](const vm::Result<std::shared_ptr<vm::StreamPeer>>& stream) {
        if (stream && self->ended_) return (*stream)->Close();  // stopped meanwhile
        if (stream) return self->Join(*stream);
        if (self->ended_) return;
        self->events_.on_notice(stream.error().text);
        self->End({.how = stream.error().text, .failed = true});
      });
  return {};
}

void ModuleRun::Join(std::shared_ptr<vm::StreamPeer> stream) {
  stream_ = std::move(stream);
  const auto peer = hub_.AttachModule(std::make_unique<StreamLink>(stream_), config_.name,
                                      config_.dialect, config_.cwd);
  if (!peer) {
    events_.on_notice(peer.error().text + ", it is ended by force");
    return Kill(peer.error().text);
  }
  peer_ = *peer;
  events_.on_joined();
  stream_->Start(
      [&hub = hub_, key = *peer, self = weak_from_this()](vm::Result<std::string_view> line) {
        if (const auto run = self.lock()) run->spoke_ = true;
        hub.Receive(key, std::move(line));
      },
      [self = weak_from_this()](const vm::StreamEnd& end) {
        if (const auto run = self.lock()) run->OnInputEnd(end.reason);
      });
  stream_->ResumeReading();
}

void ModuleRun::ReadErrors(int fd) {
  errors_ =
      vm::StreamPeer::Make(io_, fd, open("/dev/null", O_WRONLY | O_CLOEXEC), vm::Framing::kLf);
  errors_->Start(
      // The last lines may be read after the run has ended.
      [self = weak_from_this(), on_output = events_.on_output](vm::Result<std::string_view> line) {
        const OutputLine said =
            ParseOutputLine(vm::ShownUtf8(line ? *line : vm::FormatError(line.error())));
        if (const auto run = self.lock()) run->last_output_ = said.text;
        on_output(said);
      },
      [errors = std::weak_ptr(errors_)](const vm::StreamEnd&) {
        if (const auto stream = errors.lock()) stream->Close();
      });
}

void ModuleRun::OnInputEnd(const std::string& reason) {
  if (pid_ <= 0) return End({.how = reason, .failed = true});
  // Usually the process is ending and SIGCHLD will tell why. One that only closed its output, or
  // does not read, is of no use any more and gets a moment to go; one that was asked to exit has
  // the time it was given.
  if (!stopping_) KillAfter(kClosedPatience, reason, SIGKILL);
}

void ModuleRun::KillAfter(milliseconds patience, const std::string& why, int signal) {
  kill_timer_.expires_after(patience);
  kill_timer_.async_wait([self = weak_from_this(), why, signal](const auto& error) {
    const auto run = self.lock();
    if (error || !run || run->pid_ <= 0) return;
    run->killed_for_ = why;
    run->Signal(signal);
    if (signal != SIGKILL) run->KillAfter(kTerminatePatience, why, SIGKILL);
  });
}

void ModuleRun::Stop() {
  if (std::exchange(stopping_, true) || ended_) return;
  if (!is_process()) {  // only the connection ends
    if (stream_) stream_->Close();
    return End({.how = "the hub lets it go"});
  }
  // The first waits until what was said before is done, the second does not.
  for (int i = 0; i < 2; ++i) stream_->Send("set Run = EXIT");
  const milliseconds within = config_.stop_within.value_or(kStopPatience);
  KillAfter(within, "did not exit within " + vm::FormatMs(within) + " ms", SIGTERM);
}

void ModuleRun::Kill(const std::string& why) {
  killed_for_ = why;
  if (pid_ > 0) return Signal(SIGKILL);
  if (stream_) stream_->Close();
  End({.how = why, .failed = true});
}

void ModuleRun::OnExit(int status) {
  Signal(SIGKILL);  // what it has started and left behind
  pid_ = -1;
  // What has escaped from its group may keep stderr open; its last lines are read for a while.
  const auto last_lines = std::make_shared<boost::asio::steady_timer>(io_, kClosedPatience);
  last_lines->async_wait([last_lines, errors = errors_](const auto&) { errors->Close(); });
  Ending ending{
      .how = DescribeEnding(status),
      .failed = !WIFEXITED(status) || WEXITSTATUS(status) != 0,
      .last_output = last_output_,
      .exited_with_error = WIFEXITED(status) && WEXITSTATUS(status) != 0 && killed_for_.empty(),
      .spoke = spoke_};
  if (!killed_for_.empty()) ending.how += " (" + killed_for_ + ")";
  End(std::move(ending));
}

void ModuleRun::End(Ending ending) {
  if (std::exchange(ended_, true)) return;
  kill_timer_.cancel();
  // It is no peer any more once the hub's queue comes to it.
  if (peer_ != kHub) hub_.Leave(std::exchange(peer_, kHub), ending.how);
  hub_.Post(
      [self = shared_from_this(), ending = std::move(ending)] { self->events_.on_ended(ending); });
}

}  // namespace am
