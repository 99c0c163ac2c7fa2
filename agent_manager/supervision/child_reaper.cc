#include "agent_manager/supervision/child_reaper.h"

#include <sys/wait.h>

#include <csignal>
#include <utility>
#include <vector>

namespace am {

ChildReaper::ChildReaper(boost::asio::io_context& io) : signals_(io, SIGCHLD) { AwaitSignal(); }

void ChildReaper::AwaitSignal() {
  signals_.async_wait([this](const auto& error, int) {
    if (error) return;
    ReapEnded();
    AwaitSignal();
  });
}

void ChildReaper::ReapEnded() {
  // One signal can stand for several processes, so all are looked at.
  std::vector<std::pair<OnExit, int>> ended;
  for (auto at = watched_.begin(); at != watched_.end();) {
    int status = 0;
    if (waitpid(at->first, &status, WNOHANG) != at->first) {
      ++at;
      continue;
    }
    ended.emplace_back(std::move(at->second), status);
    at = watched_.erase(at);
  }
  for (const auto& [on_exit, status] : ended) on_exit(status);
}

}  // namespace am
