#include "task_manager/app/session_processes.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <iostream>
#include <new>
#include <stdexcept>
#include <vector>

#include "task_manager/app/options.h"
#include "task_manager/platform/json_line.h"
#include "task_manager/script/sanitized.h"

namespace vxml {
namespace {

struct Process {
  int session = 0;
  pid_t pid = 0;
  int from = -1;     ///< its transcript
  std::string rest;  ///< of a line that has no end yet
};

/// What scripts hold is bounded far below this, what single calls of the library take on the way is
/// not. The sanitizers reserve more than any limit allows.
void LimitMemory() {
#ifndef GALATEA_SANITIZED
  constexpr rlim_t kMost = rlim_t{768} << 20;
  const rlimit most{kMost, kMost};
  ::setrlimit(RLIMIT_DATA, &most);
#endif
}

void WriteAll(int to, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(to, bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) return;
    bytes.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(written, 0)));
  }
}

[[noreturn]] void RunIn(int to, int session, const SessionProcesses& all) {
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);  // a session does not outlive who asked for it
  LimitMemory();
  int code = kNotStarted;
  try {
    code = all.run(session, [to](const std::string& line) { WriteAll(to, line + "\n"); });
  } catch (const std::exception& error) {
    const std::string which = all.count > 1 ? "session " + std::to_string(session + 1) + ": " : "";
    std::cerr << "task_manager: " << which << error.what() << std::endl;
    if (all.count == 1) code = kUsage;
    if (dynamic_cast<const std::bad_alloc*>(&error)) code = SessionProcesses::kStuck;
  }
  std::cout.flush();
  std::_Exit(code);
}

Process Start(int session, const SessionProcesses& all) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw std::runtime_error(std::string("no pipe for a session: ") + std::strerror(errno));
  }
  std::cout.flush();
  const pid_t pid = ::fork();
  if (pid == 0) {
    ::close(ends[0]);
    RunIn(ends[1], session, all);
  }
  ::close(ends[1]);
  if (pid < 0) {
    ::close(ends[0]);
    throw std::runtime_error(std::string("no process for a session: ") + std::strerror(errno));
  }
  return {session, pid, ends[0], ""};
}

/// False at the end of its transcript.
bool Read(Process& process, const SessionProcesses& all) {
  std::array<char, 65536> bytes{};
  const ssize_t n = ::read(process.from, bytes.data(), bytes.size());
  if (n < 0 && errno == EINTR) return true;
  if (n <= 0) return false;
  process.rest.append(bytes.data(), static_cast<std::size_t>(n));
  std::size_t from = 0;
  for (std::size_t end; (end = process.rest.find('\n', from)) != std::string::npos;
       from = end + 1) {
    all.on_line(process.session, process.rest.substr(from, end - from));
  }
  process.rest.erase(0, from);
  return true;
}

int Finish(const Process& process, const SessionProcesses& all) {
  ::close(process.from);
  int status = 0;
  while (::waitpid(process.pid, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) < SessionProcesses::kStuck) {
    return WEXITSTATUS(status);
  }
  JsonLine event, exit;
  event.Text("type", "event").Text("name", "error.noresource");
  event.Text("message",
             WIFSIGNALED(status)
                 ? "the session's process ended by signal " + std::to_string(WTERMSIG(status))
                 : std::string("a script could not be stopped, or memory ran out"));
  exit.Text("type", "exit").Text("reason", "error.noresource").Raw("value", "null");
  all.on_line(process.session, event.str());
  all.on_line(process.session, exit.str());
  return kFailed;
}

}  // namespace

int SessionProcesses::Run() const {
  std::vector<Process> running;
  int next = 0, worst = kEnded;
  while (next < count || !running.empty()) {
    while (next < count && std::ssize(running) < at_once) running.push_back(Start(next++, *this));
    std::vector<pollfd> waiting;
    for (const Process& process : running) waiting.push_back({process.from, POLLIN, 0});
    if (::poll(waiting.data(), waiting.size(), -1) < 0) {
      if (errno == EINTR) continue;
      throw std::runtime_error(std::string("sessions cannot be waited for: ") +
                               std::strerror(errno));
    }
    for (std::size_t i = waiting.size(); i-- > 0;) {
      if (waiting[i].revents == 0 || Read(running[i], *this)) continue;
      worst = std::max(worst, Finish(running[i], *this));
      running.erase(running.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  return worst;
}

void SessionProcesses::EndStuck() { std::_Exit(kStuck); }

}  // namespace vxml
