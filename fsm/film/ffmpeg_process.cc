#include "fsm/film/ffmpeg_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "vm_protocol/core/spawn.h"

namespace fsm {
namespace {

void CloseFd(int& fd) {
  if (fd >= 0) close(std::exchange(fd, -1));
}

std::unexpected<vm::Error> FailToStart(int error) {
  std::string text = "cannot start ffmpeg: " + std::generic_category().message(error);
  if (error == ENOENT) text += " (ffmpeg must be installed and found along PATH)";
  return vm::Fail(vm::Errc::kUnavailable, std::move(text));
}

}  // namespace

vm::Result<std::unique_ptr<FfmpegProcess>> FfmpegProcess::Start(
    const std::vector<std::string>& arguments) {
  // Its input is a socket, not a pipe, because only for sockets can SIGPIPE be suppressed in a
  // write to a dead process.
  int input[2];
  int errors[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, input) != 0) return FailToStart(errno);
  if (pipe2(errors, O_CLOEXEC) != 0) {
    const int error = errno;
    close(input[0]);
    close(input[1]);
    return FailToStart(error);
  }
  std::vector<std::string> argv{"ffmpeg"};
  argv.insert(argv.end(), arguments.begin(), arguments.end());
  vm::Spawn spawn;
  spawn.Give(input[1], STDIN_FILENO);
  spawn.Open("/dev/null", O_WRONLY, STDOUT_FILENO);
  spawn.Give(errors[1], STDERR_FILENO);
  pid_t pid = 0;
  const int error = spawn.Start(argv, pid);
  close(input[1]);
  close(errors[1]);
  if (error != 0) {
    close(input[0]);
    close(errors[0]);
    return FailToStart(error);
  }
  fcntl(input[0], F_SETFL, O_NONBLOCK);
  fcntl(errors[0], F_SETFL, O_NONBLOCK);
  return std::unique_ptr<FfmpegProcess>(new FfmpegProcess(pid, input[0], errors[0]));
}

FfmpegProcess::~FfmpegProcess() {
  CloseFd(input_);
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    Reap();
  }
  CloseFd(errors_);
}

vm::Result<void> FfmpegProcess::Write(std::span<const std::uint8_t> bytes) {
  auto deadline = std::chrono::steady_clock::now() + kStallLimit;
  while (!bytes.empty()) {
    if (input_ < 0) return Fail("ended before the film did");
    const auto sent = send(input_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(sent));
      deadline = std::chrono::steady_clock::now() + kStallLimit;
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      if (!Wait(true, deadline)) return Fail("stopped taking pictures");
    } else if (errno != EINTR) {
      return Fail("ended before the film did");
    }
  }
  return {};
}

vm::Result<void> FfmpegProcess::Finish() {
  CloseFd(input_);
  const auto deadline = std::chrono::steady_clock::now() + kStallLimit;
  while (errors_ >= 0) {
    if (!Wait(false, deadline)) return Fail("did not come to an end");
  }
  const int status = Reap();
  if (status != -1 && WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  return Fail("failed");
}

bool FfmpegProcess::Wait(bool for_writing, Deadline deadline) {
  constexpr std::chrono::milliseconds kPollInterval{100};  // how often cancelled_ is checked
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        deadline - std::chrono::steady_clock::now());
    if (left.count() <= 0 || cancelled_) return false;
    pollfd wanted[2] = {{errors_, POLLIN, 0}, {for_writing ? input_ : -1, POLLOUT, 0}};
    // poll ignores negative descriptors, so closed ones need no special case.
    if (poll(wanted, 2, static_cast<int>(std::min(left, kPollInterval).count())) == 0) continue;
    if (wanted[0].revents != 0) ReadErrors();
    return true;
  }
}

void FfmpegProcess::ReadErrors() {
  char block[512];
  for (;;) {
    const auto got = read(errors_, block, sizeof block);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
    if (got <= 0) break;
    for (const char c : std::span(block, static_cast<std::size_t>(got))) {
      if (c != '\n' && c != '\r') {
        if (line_.size() >= kMaxLineBytes) line_.erase(0, kMaxLineBytes / 2);
        line_ += c;
      } else if (!line_.empty()) {
        last_line_ = std::exchange(line_, {});
      }
    }
  }
  if (!line_.empty()) last_line_ = std::exchange(line_, {});
  CloseFd(errors_);
}

std::unexpected<vm::Error> FfmpegProcess::Fail(const std::string& what) {
  CloseFd(input_);
  int status = -1;
  if (pid_ > 0) {
    // A process that closed its input gets some time to print the reason before it is killed.
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(2);
    while (errors_ >= 0 && Wait(false, deadline)) {
    }
    kill(pid_, SIGKILL);
    status = Reap();
  }
  std::string text = "ffmpeg " + what;
  if (!last_line_.empty()) {
    text += ": " + last_line_;
  } else if (status != -1 && WIFSIGNALED(status)) {
    text += " (signal " + std::to_string(WTERMSIG(status)) + ")";
  }
  return vm::Fail(vm::Errc::kUnavailable, std::move(text));
}

int FfmpegProcess::Reap() {
  int status = -1;
  while (waitpid(pid_, &status, 0) < 0) {
    if (errno == EINTR) continue;
    status = -1;
    break;
  }
  pid_ = 0;
  return status;
}

}  // namespace fsm
