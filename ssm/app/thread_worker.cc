#include "ssm/app/thread_worker.h"

#include <boost/asio/post.hpp>
#include <utility>

namespace ssm {

ThreadWorker::ThreadWorker(boost::asio::io_context& io, const vm::ClockScheduler& clock)
    : io_(io), clock_(clock), thread_([this] { Work(); }) {}

ThreadWorker::~ThreadWorker() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
    tasks_.clear();
  }
  changed_.notify_one();
  thread_.join();
}

void ThreadWorker::Run(std::function<void()> job, std::function<void()> done) {
  if (immediate()) {
    job();
    return done();
  }
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back({std::move(job), std::move(done)});
  }
  changed_.notify_one();
}

void ThreadWorker::Work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ending_ || !tasks_.empty(); });
    if (ending_) return;
    Task task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    task.job();
    boost::asio::post(io_, std::move(task.done));
    task = {};
    lock.lock();
  }
}

}  // namespace ssm
