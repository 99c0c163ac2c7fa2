#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "fsm/motion/easing.h"

namespace fsm {

inline float Mix(float a, float b, double share_of_b) {
  return static_cast<float>(a + (b - a) * share_of_b);
}

template <std::size_t N>
std::array<float, N> Mix(const std::array<float, N>& a, const std::array<float, N>& b,
                         double share_of_b) {
  std::array<float, N> out{};
  for (std::size_t i = 0; i < N; ++i) out[i] = Mix(a[i], b[i], share_of_b);
  return out;
}

/// A value that is told to go somewhere else, again and again, and never jumps: each move is a
/// crossfade from wherever the earlier moves would be by then to its target. So a new move in the
/// middle of another one is smooth in value and in speed.
/// T needs `T Mix(const T&, const T&, double)`. A plain value; times of commands never go back.
template <typename T>
class Track {
 public:
  Track() = default;
  explicit Track(T rest) : base_(std::move(rest)) {}

  /// Plans a move that begins at `start` (not before `now`). Moves planned to begin at `start` or
  /// later are forgotten. After this call, `At` is good for times from `now` on.
  void Plan(vm::Time now, T target, vm::Time start, vm::Time duration) {
    Prune(now);
    std::erase_if(moves_,
                  [&](const Move& move) { return move.start >= start && move.start > now; });
    moves_.push_back({start, duration, std::move(target)});
  }
  void MoveTo(vm::Time now, T target, vm::Time duration) {
    Plan(now, std::move(target), now, duration);
  }

  T At(vm::Time t) const {
    T value = base_;
    for (const Move& move : moves_) {
      if (t < move.start) continue;
      value = Mix(value, move.target, SmootherStep(Progress(t, move.start, move.duration)));
    }
    return value;
  }

  /// Where it will be when every move begun by `t` has ended.
  T TargetAt(vm::Time t) const {
    T value = base_;
    for (const Move& move : moves_) {
      if (move.start <= t) value = move.target;
    }
    return value;
  }

  /// When the moves begun by `t` will have ended; `t` if they have.
  vm::Time SettledAt(vm::Time t) const {
    vm::Time settled = t;
    for (const Move& move : moves_) {
      if (move.start <= t) settled = std::max(settled, move.start + move.duration);
    }
    return settled;
  }

  /// `t` while it moves, else when the next planned move begins; none = it stays as it is.
  std::optional<vm::Time> NextActivity(vm::Time t) const {
    std::optional<vm::Time> next;
    for (const Move& move : moves_) {
      if (move.start <= t && t < move.start + move.duration) return t;
      if (move.start > t && (!next || move.start < *next)) next = move.start;
    }
    return next;
  }

 private:
  struct Move {
    vm::Time start;
    vm::Time duration;
    T target;
  };

  // A finished move hides everything before it.
  void Prune(vm::Time now) {
    for (std::size_t i = moves_.size(); i-- > 0;) {
      if (moves_[i].start + moves_[i].duration > now || moves_[i].start > now) continue;
      base_ = moves_[i].target;
      moves_.erase(moves_.begin(), moves_.begin() + static_cast<std::ptrdiff_t>(i) + 1);
      return;
    }
  }

  T base_{};
  std::vector<Move> moves_;
};

/// The earlier of two times of which either may be missing.
inline std::optional<vm::Time> Earlier(std::optional<vm::Time> a, std::optional<vm::Time> b) {
  if (!a) return b;
  if (!b) return a;
  return std::min(*a, *b);
}

}  // namespace fsm
