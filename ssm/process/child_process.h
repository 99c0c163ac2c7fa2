#pragma once

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vm_protocol/core/result.h"

namespace ssm {

/// Another program with its stdin and stdout in our hands; its stderr goes to ours, or nowhere.
/// It is a process group of its own and is killed, with what it started, when this goes away.
/// Thread: one at a time. Every wait has a limit.
/// Errors: kUnavailable (cannot be started, has ended), kTimeout, kStopped (cancelled), kTooLong.
class ChildProcess {
 public:
  using Clock = std::chrono::steady_clock;
  struct Wait {
    Clock::time_point until;                       ///< kTimeout then
    const std::atomic<bool>* cancelled = nullptr;  ///< kStopped soon after it becomes true
  };
  static constexpr std::size_t kMaxLineBytes = 1u << 20;

  /// argv[0] is looked up in PATH unless it has a slash. `quiet`: its stderr is thrown away.
  static vm::Result<std::unique_ptr<ChildProcess>> Start(const std::vector<std::string>& argv,
                                                         bool quiet);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  vm::Result<void> Write(std::string_view bytes, const Wait& wait);
  /// End of input for the program.
  void CloseInput();
  /// The next line without its newline.
  vm::Result<std::string> ReadLine(const Wait& wait);
  vm::Result<std::string> ReadBytes(std::size_t count, const Wait& wait);
  /// Everything up to the end of its output; kTooLong beyond `most`.
  vm::Result<std::string> ReadAll(std::size_t most, const Wait& wait);
  /// Waits for its end; the exit status as a shell gives it (128 + N for signal N).
  vm::Result<int> WaitForEnd(const Wait& wait);
  pid_t pid() const { return pid_; }
  /// Its output and its input, for somebody who does not wait: the caller closes them, and nothing
  /// can be read or written here any more.
  std::pair<int, int> TakeDescriptors() {
    return {std::exchange(out_, -1), std::exchange(in_, -1)};
  }

 private:
  ChildProcess(std::string name, pid_t pid, int in, int out);
  /// Waits until more output is here. True: there is more; false: the output has ended.
  vm::Result<bool> Fill(const Wait& wait);
  vm::Result<void> Poll(int fd, short events, const Wait& wait) const;

  const std::string name_;
  pid_t pid_;
  int in_;
  int out_;
  std::string read_;
  bool reaped_ = false;
};

/// A program run from start to end.
struct ProgramRun {
  std::vector<std::string> argv{};
  std::string input{};
  std::chrono::milliseconds limit{10'000};
  std::size_t max_output = 64u << 20;
};
/// Its stdout. Errors: as ChildProcess, and kUnavailable if it ends with another status than 0.
vm::Result<std::string> RunProgram(const ProgramRun& run, const std::atomic<bool>* cancelled);

}  // namespace ssm
