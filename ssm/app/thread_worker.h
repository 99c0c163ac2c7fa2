#pragma once

#include <boost/asio/io_context.hpp>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

#include "ssm/voice/worker.h"
#include "vm_protocol/runtime/asio_scheduler.h"

namespace ssm {

/// Runs jobs one after another on a thread of its own while the clock is real, and on the spot
/// while it is virtual, where work must take no time. What a job leaves to do comes back on the
/// io_context's thread.
/// Thread: owns one, joined by the destructor after the job in hand; Run is called on the loop's.
class ThreadWorker final : public Worker {
 public:
  /// Both outlive the worker.
  ThreadWorker(boost::asio::io_context& io, const vm::ClockScheduler& clock);
  ~ThreadWorker() override;

  void Run(std::function<void()> job, std::function<void()> done) override;
  bool immediate() const override { return !clock_.real(); }

 private:
  struct Task {
    std::function<void()> job;
    std::function<void()> done;
  };
  void Work();

  // Constant after construction.
  boost::asio::io_context& io_;
  const vm::ClockScheduler& clock_;

  // Guarded by mutex_.
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Task> tasks_;
  bool ending_ = false;

  std::thread thread_;  // last, so that all it uses is there
};

}  // namespace ssm
