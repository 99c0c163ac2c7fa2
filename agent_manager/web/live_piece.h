#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "vm_protocol/web/live_records.h"

namespace am {

using vm::LivePiece;  ///< with the session's time: what /face and /voice send

/// Those who follow a stream of live pieces, by number. A member may come and go while the others
/// are told. Thread: none of its own; one instance, one thread.
class Audience {
 public:
  using Piece = std::shared_ptr<const LivePiece>;
  struct Member {
    std::function<void(const Piece& piece)> on_piece;
    /// Nothing follows; the member has left already.
    std::function<void(const std::string& why)> on_end;
  };
  /// Returns the member's number, from 1.
  unsigned Join(Member member) {
    members_[++last_] = std::move(member);
    return last_;
  }
  void Leave(unsigned member) { members_.erase(member); }
  bool empty() const { return members_.empty(); }
  void Tell(const Piece& piece) const {
    const auto members = members_;
    for (const auto& [number, member] : members) member.on_piece(piece);
  }
  void End(const std::string& why) {
    const auto members = std::exchange(members_, {});
    for (const auto& [number, member] : members) member.on_end(why);
  }

 private:
  std::map<unsigned, Member> members_;
  unsigned last_ = 0;
};

}  // namespace am
