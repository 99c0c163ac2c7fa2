#pragma once

#include <sys/types.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <functional>
#include <map>

namespace am {

/// Waits for SIGCHLD and reaps the processes it is told of. It reaps no others.
/// Thread: the context's; there is one reaper for each process of ours.
class ChildReaper {
 public:
  /// `status`: as of waitpid(2).
  using OnExit = std::function<void(int status)>;
  explicit ChildReaper(boost::asio::io_context& io);
  ChildReaper(const ChildReaper&) = delete;

  /// Calls `on_exit` once, from the context, when the process has ended; also if it already has.
  void Watch(pid_t pid, OnExit on_exit) { watched_.emplace(pid, std::move(on_exit)); }

 private:
  void AwaitSignal();
  void ReapEnded();

  boost::asio::signal_set signals_;
  std::map<pid_t, OnExit> watched_;
};

}  // namespace am
