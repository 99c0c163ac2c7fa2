#pragma once

#include <functional>
#include <string>

namespace vxml {

/// Runs sessions each in a process of its own, so that whatever a document makes of its session,
/// the others go on and this one ends in order. REQUIRES: the calling process has one thread.
struct SessionProcesses {
  int count = 1;
  int at_once = 1;
  /// In the new process: runs session 0 ... count-1, writes its transcript with the function it is
  /// given (a line each), returns an exit code below kStuck.
  std::function<int(int session, const std::function<void(const std::string&)>& write)> run;
  /// In this process: a line that a session wrote. Lines of a session keep their order.
  std::function<void(int session, const std::string& line)> on_line;

  /// Returns the highest exit code. A process that does not end by itself (a signal, or EndStuck)
  /// counts as kFailed, and its lines end with an event error.noresource and an exit.
  /// Errors: std::runtime_error if there are no processes to be had.
  int Run() const;

  static constexpr int kStuck = 100;
  /// For a session's process: a script cannot be stopped, so the process ends. Thread: any.
  [[noreturn]] static void EndStuck();
};

}  // namespace vxml
