#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <memory>
#include <utility>

namespace vm {

/// Lets those who wait go on one after the other, in the order of their coming, and the loop looks
/// at everything else in between: for work that is long, and that many can ask for at once.
/// Lifetime: kept alive by those who wait. Thread: the io_context's.
class Turns : public std::enable_shared_from_this<Turns> {
 public:
  explicit Turns(boost::asio::io_context& io)
      : io_(io), waiting_(io, boost::asio::steady_timer::time_point::max()) {}

  /// Calls `act(error_code)`, whose value means nothing, from the loop.
  template <typename Act>
  void Wait(Act act) {
    waiting_.async_wait(std::move(act));
    if (!std::exchange(going_, true)) Next();
  }

 private:
  void Next() {
    going_ = waiting_.cancel_one() > 0;
    if (going_) boost::asio::post(io_, [self = shared_from_this()] { self->Next(); });
  }

  boost::asio::io_context& io_;
  boost::asio::steady_timer waiting_;  // never expires; cancelled once for each turn
  bool going_ = false;
};

}  // namespace vm
