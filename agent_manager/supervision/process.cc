#include "agent_manager/supervision/process.h"

#include <fcntl.h>
#include <linux/close_range.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <utility>
#include <vector>

namespace am {
namespace {

/// Both ends close with it unless they are taken.
struct Pipe {
  std::array<int, 2> ends{-1, -1};
  Pipe() {
    if (pipe2(ends.data(), O_CLOEXEC) != 0) ends = {-1, -1};
  }
  ~Pipe() {
    for (const int end : ends) {
      if (end >= 0) close(end);
    }
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  bool ok() const { return ends[0] >= 0; }
  int TakeRead() { return std::exchange(ends[0], -1); }
  int TakeWrite() { return std::exchange(ends[1], -1); }
};

/// A system call, once more if a signal came in between.
template <typename Call>
auto Again(const Call& call) {
  auto result = call();
  while (result == -1 && errno == EINTR) result = call();
  return result;
}

bool Limit(__rlimit_resource what, unsigned long most) {
  if (most == 0) return true;
  const rlimit limit{most, most};
  return setrlimit(what, &limit) == 0;
}

/// In the child, between fork and exec: only calls that are safe in a copy of a process.
bool ApplyLimits(const ResourceLimits& limits) {
  constexpr unsigned long kMiB = 1ul << 20;
  errno = 0;
  if (limits.nice != 0 && nice(limits.nice) == -1 && errno != 0) return false;
  return Limit(RLIMIT_CPU, limits.cpu_s) && Limit(RLIMIT_AS, limits.memory_mb * kMiB) &&
         Limit(RLIMIT_NOFILE, limits.files) && Limit(RLIMIT_FSIZE, limits.file_mb * kMiB);
}

}  // namespace

vm::Result<Spawned> SpawnProcess(const ModuleConfig& module) {
  Pipe input, output, errors, failure;
  const auto refuse = [&](int why) {
    const std::string& program = module.command.front();
    std::string text =
        "@" + module.name + ": cannot start '" + program + "': " + std::strerror(why);
    // Our own configurations name programs by where they are built.
    if (why == ENOENT && program.front() != '/' && program.find('/') != std::string::npos)
      text += " (it is looked for from " + std::filesystem::current_path().string() +
              ": start from the root of the toolkit)";
    const bool for_now = why == EMFILE || why == ENFILE || why == EAGAIN || why == ENOMEM;
    return vm::Fail(for_now ? vm::Errc::kBusy : vm::Errc::kUnavailable, text);
  };
  if (!input.ok() || !output.ok() || !errors.ok() || !failure.ok()) return refuse(errno);
  std::vector<char*> argv;
  for (const std::string& word : module.command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  const pid_t hub = getpid();
  const pid_t pid = fork();
  if (pid == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != hub) _exit(127);  // the hub died in between
    setpgid(0, 0);                     // a Ctrl-C at the terminal is the hub's to handle
    dup2(input.ends[0], STDIN_FILENO);
    dup2(output.ends[1], STDOUT_FILENO);
    dup2(errors.ends[1], STDERR_FILENO);
    close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);
    signal(SIGPIPE, SIG_DFL);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    for (const std::string& entry : module.env) putenv(const_cast<char*>(entry.c_str()));
    if (ApplyLimits(module.limits) && (module.cwd.empty() || chdir(module.cwd.c_str()) == 0))
      execvp(argv[0], argv.data());
    const int why = errno;
    static_cast<void>(!write(failure.ends[1], &why, sizeof(why)));
    _exit(127);
  }
  if (pid < 0) return refuse(errno);
  close(failure.TakeWrite());
  int why = 0;
  if (Again([&] { return read(failure.ends[0], &why, sizeof(why)); }) == sizeof(why)) {
    Again([&] { return waitpid(pid, nullptr, 0); });
    return refuse(why);
  }
  return Spawned{pid, input.TakeWrite(), output.TakeRead(), errors.TakeRead()};
}

std::string DescribeEnding(int status) {
  if (WIFSIGNALED(status))
    return std::string("killed by signal ") + std::to_string(WTERMSIG(status)) + ", " +
           strsignal(WTERMSIG(status));
  return "ended with code " + std::to_string(WEXITSTATUS(status));
}

}  // namespace am
