#pragma once

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "vm_protocol/core/result.h"

namespace fsm {

/// An ffmpeg process that reads bytes from its standard input; the last line of its standard error
/// is kept for messages. No shell is involved. If the process dies, the caller gets an error, never
/// a signal.
/// Lifetime: the destructor kills and reaps a process that has not ended. Thread: one.
/// Limits:   kStallLimit without reading a byte, or between the last byte and the exit; the last
///           kMaxLineBytes of the last line of standard error are kept.
class FfmpegProcess {
 public:
  static constexpr std::chrono::minutes kStallLimit{5};
  static constexpr std::size_t kMaxLineBytes = 500;

  /// `arguments` without the program's name. Error: kUnavailable if it cannot be started.
  static vm::Result<std::unique_ptr<FfmpegProcess>> Start(
      const std::vector<std::string>& arguments);
  ~FfmpegProcess();
  FfmpegProcess(const FfmpegProcess&) = delete;
  FfmpegProcess& operator=(const FfmpegProcess&) = delete;

  /// Writes all bytes to its standard input. Error: kUnavailable if the process has ended or
  /// stalls; it is then killed.
  vm::Result<void> Write(std::span<const std::uint8_t> bytes);
  /// Makes a Write in another thread fail soon. Thread: any.
  void CancelWrites() { cancelled_ = true; }
  /// Closes its input and waits for its exit. Error: kUnavailable if it reports failure.
  vm::Result<void> Finish();

 private:
  using Deadline = std::chrono::steady_clock::time_point;

  FfmpegProcess(pid_t pid, int input, int errors) : pid_(pid), input_(input), errors_(errors) {}
  /// Waits until standard error or, if `for_writing`, the input is ready. Returns false at the
  /// deadline or when cancelled.
  bool Wait(bool for_writing, Deadline deadline);
  void ReadErrors();
  std::unexpected<vm::Error> Fail(const std::string& what);
  /// The wait status, or -1 if somebody else reaped it.
  int Reap();

  std::atomic<bool> cancelled_ = false;
  pid_t pid_;              // 0 once reaped
  int input_;              // our end of a socket, -1 once closed
  int errors_;             // our end of a pipe, -1 at its end
  std::string line_;       // of standard error, being read
  std::string last_line_;  // the last one that was not empty
};

}  // namespace fsm
