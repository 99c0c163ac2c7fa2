#include "ssm/process/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include "vm_protocol/core/spawn.h"

namespace ssm {
namespace {

constexpr int kStepMs = 20;  // how soon a cancelled wait is noticed

vm::Error Failed(const std::string& name, const std::string& what) {
  return {vm::Errc::kUnavailable, "program '" + name + "' " + what, 0};
}

/// Both ends close themselves in programs started later.
struct Pipe {
  int read = -1;
  int write = -1;
  bool Open() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return false;
    read = ends[0];
    write = ends[1];
    return true;
  }
  void Close() {
    if (read >= 0) close(std::exchange(read, -1));
    if (write >= 0) close(std::exchange(write, -1));
  }
};

/// A write to a program that has ended must be an error here, not our end.
void IgnoreBrokenPipes() {
  static const auto previous = std::signal(SIGPIPE, SIG_IGN);
  static_cast<void>(previous);
}

int StartProgram(const std::vector<std::string>& argv, int in, int out, bool quiet, pid_t& pid) {
  vm::Spawn spawn;
  spawn.Give(in, STDIN_FILENO);
  spawn.Give(out, STDOUT_FILENO);
  if (quiet) spawn.Open("/dev/null", O_WRONLY, STDERR_FILENO);
  return spawn.Start(argv, pid);
}

}  // namespace

vm::Result<std::unique_ptr<ChildProcess>> ChildProcess::Start(const std::vector<std::string>& argv,
                                                              bool quiet) {
  if (argv.empty()) return vm::Fail(vm::Errc::kBadValue, "no program is named");
  IgnoreBrokenPipes();
  Pipe in, out;
  pid_t pid = -1;
  const int error =
      in.Open() && out.Open() ? StartProgram(argv, in.read, out.write, quiet, pid) : errno;
  if (error != 0) {
    in.Close();
    out.Close();
    return std::unexpected(
        Failed(argv[0], std::string("cannot be started: ") + std::strerror(error)));
  }
  close(in.read);
  close(out.write);
  for (const int fd : {in.write, out.read}) fcntl(fd, F_SETFL, O_NONBLOCK);
  return std::unique_ptr<ChildProcess>(new ChildProcess(argv[0], pid, in.write, out.read));
}

ChildProcess::ChildProcess(std::string name, pid_t pid, int in, int out)
    : name_(std::move(name)), pid_(pid), in_(in), out_(out) {}

ChildProcess::~ChildProcess() {
  CloseInput();
  if (out_ >= 0) close(out_);
  if (reaped_) return;
  kill(-pid_, SIGKILL);
  while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void ChildProcess::CloseInput() {
  if (in_ >= 0) close(std::exchange(in_, -1));
}

vm::Result<void> ChildProcess::Poll(int fd, short events, const Wait& wait) const {
  while (true) {
    if (wait.cancelled != nullptr && *wait.cancelled) {
      return vm::Fail(vm::Errc::kStopped, "program '" + name_ + "' was stopped");
    }
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(wait.until - Clock::now());
    if (left.count() <= 0) {
      return vm::Fail(vm::Errc::kTimeout, "program '" + name_ + "' gave no answer in time");
    }
    pollfd ready{fd, events, 0};
    const auto step = std::min<std::int64_t>(left.count(), kStepMs);
    if (poll(&ready, 1, static_cast<int>(step)) > 0) return {};
  }
}

vm::Result<void> ChildProcess::Write(std::string_view bytes, const Wait& wait) {
  while (!bytes.empty()) {
    if (in_ < 0) return std::unexpected(Failed(name_, "takes no more input"));
    const ssize_t n = write(in_, bytes.data(), bytes.size());
    if (n >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(n));
    } else if (errno == EAGAIN) {
      if (auto polled = Poll(in_, POLLOUT, wait); !polled) return polled;
    } else if (errno != EINTR) {
      return std::unexpected(Failed(name_, "has ended"));
    }
  }
  return {};
}

vm::Result<bool> ChildProcess::Fill(const Wait& wait) {
  char buffer[65536];
  while (true) {
    const ssize_t n = read(out_, buffer, sizeof buffer);
    if (n > 0) read_.append(buffer, static_cast<std::size_t>(n));
    if (n >= 0) return n > 0;
    if (errno == EAGAIN) {
      if (auto polled = Poll(out_, POLLIN, wait); !polled) return std::unexpected(polled.error());
    } else if (errno != EINTR) {
      return std::unexpected(Failed(name_, std::string("cannot be read: ") + std::strerror(errno)));
    }
  }
}

vm::Result<std::string> ChildProcess::ReadLine(const Wait& wait) {
  std::size_t searched = 0;
  while (true) {
    const std::size_t end = read_.find('\n', searched);
    if (end != std::string::npos) {
      std::string line = read_.substr(0, end);
      read_.erase(0, end + 1);
      return line;
    }
    searched = read_.size();
    if (searched > kMaxLineBytes) {
      return vm::Fail(vm::Errc::kTooLong, "program '" + name_ + "' gave a line without an end");
    }
    const auto more = Fill(wait);
    if (!more) return std::unexpected(more.error());
    if (!*more) return std::unexpected(Failed(name_, "has ended"));
  }
}

vm::Result<std::string> ChildProcess::ReadBytes(std::size_t count, const Wait& wait) {
  while (read_.size() < count) {
    const auto more = Fill(wait);
    if (!more) return std::unexpected(more.error());
    if (!*more) return std::unexpected(Failed(name_, "has ended in the middle of its answer"));
  }
  std::string bytes = read_.substr(0, count);
  read_.erase(0, count);
  return bytes;
}

vm::Result<std::string> ChildProcess::ReadAll(std::size_t most, const Wait& wait) {
  while (true) {
    const auto more = Fill(wait);
    if (!more) return std::unexpected(more.error());
    if (!*more) return std::exchange(read_, {});
    if (read_.size() > most) {
      return vm::Fail(vm::Errc::kTooLong,
                      "program '" + name_ + "' wrote more than " + std::to_string(most) + " bytes");
    }
  }
}

vm::Result<int> ChildProcess::WaitForEnd(const Wait& wait) {
  while (true) {
    int status = 0;
    const pid_t ended = waitpid(pid_, &status, WNOHANG);
    if (ended == pid_) {
      reaped_ = true;
      return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    if (wait.cancelled != nullptr && *wait.cancelled) {
      return vm::Fail(vm::Errc::kStopped, "program '" + name_ + "' was stopped");
    }
    if (Clock::now() >= wait.until) {
      return vm::Fail(vm::Errc::kTimeout, "program '" + name_ + "' did not end in time");
    }
    // Its output has ended, so its end is near; there is no descriptor to wait on.
    poll(nullptr, 0, 1);
  }
}

vm::Result<std::string> RunProgram(const ProgramRun& run, const std::atomic<bool>* cancelled) {
  auto child = ChildProcess::Start(run.argv, true);
  if (!child) return std::unexpected(child.error());
  const ChildProcess::Wait wait{ChildProcess::Clock::now() + run.limit, cancelled};
  // A program that reads only a part of its input may be right all the same.
  static_cast<void>((*child)->Write(run.input, wait));
  (*child)->CloseInput();
  auto output = (*child)->ReadAll(run.max_output, wait);
  if (!output) return output;
  const auto status = (*child)->WaitForEnd(wait);
  if (!status) return std::unexpected(status.error());
  if (*status != 0) {
    return std::unexpected(Failed(run.argv[0], "ended with status " + std::to_string(*status)));
  }
  return output;
}

}  // namespace ssm
