#pragma once

#include <functional>
#include <set>
#include <string>
#include <string_view>

#include "agent_manager/routing/envelope.h"

namespace am {

/// The peers that have said `set Flow = ON`: each is shown every line of the session log as a
/// comment. Thread: one. Limits: one entry for each peer.
class FlowWatchers {
 public:
  /// False if the peer is gone.
  using Show = std::function<bool(PeerKey peer, std::string_view comment)>;
  explicit FlowWatchers(Show show) : show_(std::move(show)) {}
  void Set(PeerKey peer, bool on) {
    if (on) {
      peers_.insert(peer);
    } else {
      peers_.erase(peer);
    }
  }
  void Write(std::string_view log_line) {
    if (peers_.empty()) return;
    const std::string comment = "# flow " + std::string(log_line);
    std::erase_if(peers_, [&](PeerKey peer) { return !show_(peer, comment); });
  }
  bool empty() const { return peers_.empty(); }

 private:
  Show show_;
  std::set<PeerKey> peers_;
};

}  // namespace am
