#include "agent_manager/supervisor.h"

#include <fcntl.h>
#include <linux/close_range.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <deque>
#include <stdexcept>

#include "vm_protocol/runtime/endpoint.h"

namespace am {

using std::chrono::milliseconds;
using SteadyClock = std::chrono::steady_clock;

namespace {

constexpr milliseconds kFirstRestart{200};
constexpr milliseconds kLongestRestart{10000};
constexpr std::size_t kMaxRestartsPerMinute = 8;
constexpr milliseconds kExitPatience{4000};       // after Run = EXIT
constexpr milliseconds kClosedPatience{500};      // after it closed its output
constexpr milliseconds kTerminatePatience{1000};  // after SIGTERM

struct Pipe {
  int read_end = -1;
  int write_end = -1;
  Pipe() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
      throw std::runtime_error(std::string("cannot make a pipe: ") + std::strerror(errno));
    read_end = ends[0];
    write_end = ends[1];
  }
};

std::string Ending(int status) {
  if (WIFSIGNALED(status))
    return std::string("killed by signal ") + std::to_string(WTERMSIG(status)) + ", " +
           strsignal(WTERMSIG(status));
  return "ended with code " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

struct Supervisor::Signals {
  explicit Signals(boost::asio::io_context& io) : set(io, SIGCHLD) {}
  boost::asio::signal_set set;
};

struct Supervisor::Child {
  Child(boost::asio::io_context& io, const ModuleConfig& module)
      : config(module), restart_timer(io), stop_timer(io) {}
  ModuleConfig config;
  pid_t pid = -1;
  PeerKey peer = 0;
  std::shared_ptr<vm::StreamPeer> stream, errors;
  boost::asio::steady_timer restart_timer, stop_timer;
  milliseconds backoff = kFirstRestart;
  std::deque<SteadyClock::time_point> starts;
  bool restarting = false;
  bool gave_up = false;
  bool stop_asked = false;
};

Supervisor::Supervisor(boost::asio::io_context& io, Hub& hub, OnNotice on_notice)
    : io_(io),
      hub_(hub),
      on_notice_(std::move(on_notice)),
      signals_(std::make_unique<Signals>(io)) {
  OnSignal();
}

Supervisor::~Supervisor() {
  for (const auto& child : children_) {
    if (child->pid > 0) kill(child->pid, SIGKILL);
  }
}

void Supervisor::OnSignal() {
  signals_->set.async_wait([this](const auto& error, int) {
    if (error) return;
    for (const auto& child : children_) {
      int status = 0;
      if (child->pid > 0 && waitpid(child->pid, &status, WNOHANG) == child->pid)
        Reap(*child, status);
    }
    OnSignal();
  });
}

void Supervisor::StartAll(const std::vector<ModuleConfig>& modules) {
  for (const ModuleConfig& module : modules) {
    children_.push_back(std::make_unique<Child>(io_, module));
    Start(*children_.back());
  }
}

void Supervisor::Start(Child& child) {
  child.restarting = false;
  child.starts.push_back(SteadyClock::now());
  if (child.config.command.empty()) {
    Dial(child);
  } else {
    Spawn(child);
  }
}

void Supervisor::Spawn(Child& child) {
  Pipe input, output, errors, failure;
  std::vector<char*> argv;
  for (const std::string& word : child.config.command)
    argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  const pid_t hub = getpid();
  const pid_t pid = fork();
  if (pid == 0) {
    // Between fork and exec only calls that are safe in a copy of a process.
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != hub) _exit(127);  // the hub died in between
    setpgid(0, 0);                     // a Ctrl-C at the terminal is the hub's to handle
    dup2(input.read_end, STDIN_FILENO);
    dup2(output.write_end, STDOUT_FILENO);
    dup2(errors.write_end, STDERR_FILENO);
    close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);
    signal(SIGPIPE, SIG_DFL);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    for (const std::string& entry : child.config.env) putenv(const_cast<char*>(entry.c_str()));
    if (child.config.cwd.empty() || chdir(child.config.cwd.c_str()) == 0)
      execvp(argv[0], argv.data());
    const int why = errno;
    static_cast<void>(!write(failure.write_end, &why, sizeof(why)));
    _exit(127);
  }
  close(input.read_end);
  close(output.write_end);
  close(errors.write_end);
  close(failure.write_end);
  int why = pid < 0 ? errno : 0;
  if (pid > 0 && read(failure.read_end, &why, sizeof(why)) != sizeof(why)) why = 0;
  close(failure.read_end);
  if (why != 0) {
    close(input.write_end);
    close(output.read_end);
    close(errors.read_end);
    if (pid > 0) waitpid(pid, nullptr, 0);
    const std::string text = "@" + child.config.name + ": cannot start '" +
                             child.config.command.front() + "': " + std::strerror(why);
    if (child.starts.size() <= 1) throw std::runtime_error(text);
    on_notice_(text);
    return MaybeRestart(child, true);
  }
  child.pid = pid;
  ReadErrors(child, errors.read_end);
  Join(child, output.read_end, input.write_end);
}

void Supervisor::Dial(Child& child) {
  const auto endpoint = vm::ParseEndpoint(child.config.connect);
  if (!endpoint) throw std::runtime_error("@" + child.config.name + ": " + endpoint.error().text);
  vm::ConnectTo(io_, *endpoint, [this, &child](vm::Result<int> fd) {
    if (fd) return Join(child, *fd, *fd);
    on_notice_("@" + child.config.name + ": " + fd.error().text);
    MaybeRestart(child, true);
  });
}

void Supervisor::Join(Child& child, int read_fd, int write_fd) {
  child.stream = vm::StreamPeer::Make(
      io_, read_fd, write_fd, child.config.framing == "mmi" ? vm::Framing::kMmi : vm::Framing::kLf,
      vm::ParseEncoding(child.config.encoding).value_or(vm::Encoding::kUtf8));
  const auto key = hub_.Attach(std::make_unique<StreamLink>(child.stream), PeerKind::kModule,
                               child.config.name, child.config.dialect);
  if (!key) {
    on_notice_("@" + child.config.name + ": " + key.error().text);
    return;
  }
  child.peer = *key;
  child.stream->Start(
      [this, peer = *key](vm::Result<std::string_view> line) {
        hub_.OnLine(peer, std::move(line));
      },
      [this, &child, peer = *key](const std::string& reason) {
        if (child.peer == peer) OnEnd(child, reason);
      });
}

void Supervisor::ReadErrors(Child& child, int fd) {
  child.errors =
      vm::StreamPeer::Make(io_, fd, open("/dev/null", O_WRONLY | O_CLOEXEC), vm::Framing::kLf);
  child.errors->Start(
      [this, name = child.config.name](vm::Result<std::string_view> line) {
        on_notice_(name + "| " + (line ? std::string(*line) : vm::FormatError(line.error())));
      },
      [](const std::string&) {});
}

void Supervisor::OnEnd(Child& child, const std::string& reason) {
  if (child.pid > 0) {
    // Usually the process is ending and SIGCHLD will tell why; one that only closed its output, or
    // does not read, is of no use any more and gets a moment to go.
    if (reason != "end of input") on_notice_("@" + child.config.name + ": " + reason);
    child.stop_timer.expires_after(kClosedPatience);
    child.stop_timer.async_wait([&child](const auto& error) {
      if (!error && child.pid > 0) kill(child.pid, SIGKILL);
    });
    return;
  }
  hub_.Detach(std::exchange(child.peer, 0), reason);
  MaybeRestart(child, true);
}

void Supervisor::Reap(Child& child, int status) {
  child.pid = -1;
  child.stop_timer.cancel();  // it was for this process, not for the next one
  const std::string ending = Ending(status);
  const bool failed = !WIFEXITED(status) || WEXITSTATUS(status) != 0;
  if (!stopping_ || failed) on_notice_("@" + child.config.name + " " + ending);
  if (child.peer != 0) hub_.Detach(std::exchange(child.peer, 0), ending);
  MaybeRestart(child, failed);
}

void Supervisor::MaybeRestart(Child& child, bool failed) {
  if (stopping_) return StopNext();
  if (child.config.restart == Restart::kNever ||
      (child.config.restart == Restart::kOnFailure && !failed))
    return;
  const auto now = SteadyClock::now();
  while (!child.starts.empty() && now - child.starts.front() > std::chrono::minutes(1))
    child.starts.pop_front();
  if (child.starts.size() > kMaxRestartsPerMinute) {
    child.gave_up = true;
    on_notice_("@" + child.config.name + " ended " + std::to_string(child.starts.size()) +
               " times within a minute, it is not started again");
    return;
  }
  child.backoff =
      child.starts.size() <= 1 ? kFirstRestart : std::min(child.backoff * 2, kLongestRestart);
  child.restarting = true;
  child.restart_timer.expires_after(child.backoff);
  child.restart_timer.async_wait([this, &child](const auto& error) {
    if (!error && !stopping_) Start(child);
  });
}

bool Supervisor::IsExpected(const std::string& name) const {
  return std::ranges::any_of(children_, [&](const auto& child) {
    return child->config.name == name && (child->pid > 0 || child->restarting);
  });
}

bool Supervisor::Kill(const std::string& name) {
  for (const auto& child : children_) {
    if (child->config.name == name && child->pid > 0) return kill(child->pid, SIGKILL) == 0;
  }
  return false;
}

std::string Supervisor::Summary() const {
  std::string text;
  for (const auto& child : children_) {
    text += (text.empty() ? "" : ", ") + child->config.name + " " +
            (child->peer != 0    ? "RUNNING"
             : child->restarting ? "RESTARTING"
             : child->gave_up    ? "FAILED"
                                 : "ENDED");
    if (child->pid > 0) text += " " + std::to_string(child->pid);
  }
  return text;
}

void Supervisor::StopAll(std::function<void()> done) {
  if (stopping_) return;
  stopping_ = true;
  on_stopped_ = std::move(done);
  for (const auto& child : children_) child->restart_timer.cancel();
  StopNext();
}

void Supervisor::StopNext() {
  for (auto it = children_.rbegin(); it != children_.rend(); ++it) {
    Child& child = **it;
    if (child.peer == 0 && child.pid <= 0) continue;
    if (child.stop_asked) return;  // its end, or the timer, comes back here
    child.stop_asked = true;
    if (child.pid <= 0) {  // connected to: only the connection ends
      hub_.Detach(std::exchange(child.peer, 0), "the hub ends");
      continue;
    }
    if (child.stream) child.stream->Send("set Run = EXIT");
    child.stop_timer.expires_after(kExitPatience);
    child.stop_timer.async_wait([&child](const auto& error) {
      if (error || child.pid <= 0) return;
      kill(child.pid, SIGTERM);
      child.stop_timer.expires_after(kTerminatePatience);
      child.stop_timer.async_wait([&child](const auto& late) {
        if (!late && child.pid > 0) kill(child.pid, SIGKILL);
      });
    });
    return;
  }
  if (auto done = std::exchange(on_stopped_, nullptr)) done();
}

}  // namespace am
