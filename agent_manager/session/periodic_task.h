#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <functional>

namespace am {

/// Does something again and again on the real clock, also after it has thrown. Thread: the
/// context's.
class PeriodicTask {
 public:
  explicit PeriodicTask(boost::asio::io_context& io) : timer_(io) {}
  /// The first time after `every`. If it goes on already, it goes on like this instead.
  void Start(std::chrono::milliseconds every, std::function<void()> act) {
    every_ = every;
    act_ = std::move(act);
    Wait();
  }

 private:
  void Wait() {
    timer_.expires_after(every_);
    timer_.async_wait([this](const auto& error) {
      if (error) return;
      Wait();
      act_();
    });
  }

  boost::asio::steady_timer timer_;
  std::chrono::milliseconds every_{0};
  std::function<void()> act_;
};

}  // namespace am
