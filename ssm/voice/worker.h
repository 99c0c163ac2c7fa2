#pragma once

#include <functional>

namespace ssm {

/// Does what takes too long for the loop.
class Worker {
 public:
  virtual ~Worker() = default;
  /// Runs `job`, possibly on another thread and after earlier jobs, then `done` on the loop's
  /// thread. Jobs not begun when the worker is destroyed are dropped; `done` is then never called.
  virtual void Run(std::function<void()> job, std::function<void()> done) = 0;
  /// True if Run does everything before it returns.
  virtual bool immediate() const = 0;
};

/// At once, on the spot: the choice for a virtual clock, where work takes no time.
class InlineWorker final : public Worker {
 public:
  void Run(std::function<void()> job, std::function<void()> done) override {
    job();
    done();
  }
  bool immediate() const override { return true; }
};

}  // namespace ssm
