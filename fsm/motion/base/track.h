#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "fsm/motion/base/easing.h"

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

/// Returns the earlier of two times, either of which may be missing.
inline std::optional<vm::Time> Earlier(std::optional<vm::Time> a, std::optional<vm::Time> b) {
  if (!a) return b;
  if (!b) return a;
  return std::min(*a, *b);
}

/// The starts and durations of the moves of a track.
class MoveTimes {
 public:
  /// Returns when the moves begun by `t` will have ended; `t` if they have.
  vm::Time SettledAt(vm::Time t) const {
    vm::Time settled = t;
    for (const Span& move : spans_) {
      if (move.start <= t) settled = std::max(settled, move.start + move.duration);
    }
    return settled;
  }

  /// Returns `t` while it moves, else when the next planned move begins; none: no more moves.
  std::optional<vm::Time> NextMotion(vm::Time t) const {
    std::optional<vm::Time> next;
    for (const Span& move : spans_) {
      if (move.start <= t && t < move.start + move.duration) return t;
      if (move.start > t) next = Earlier(next, move.start);
    }
    return next;
  }

 protected:
  struct Span {
    vm::Time start;
    vm::Time duration;
  };
  std::vector<Span> spans_;
};

/// A value that moves from target to target without jumps: each move is a crossfade from the value
/// that the earlier moves give to its own target. A move that begins during another one is
/// therefore smooth in value and in speed. REQUIRES: `T Mix(const T&, const T&, double)` exists;
/// the times of commands never decrease. A plain value.
template <typename T>
class Track : public MoveTimes {
 public:
  Track() = default;
  explicit Track(T rest) : base_(std::move(rest)) {}

  /// What `At` remembers of the time before a command: springs are simulated from then on.
  static constexpr vm::Time kMemory = std::chrono::seconds(3);
  /// The most moves that are remembered after their end.
  static constexpr std::size_t kMaxEnded = 200;

  /// Plans a move that begins at `start` (not before `now`). Moves that begin at `start` or later
  /// are forgotten, but for a jump (of no duration) at `now` before a move, which has been made.
  /// After this call, `At` is good for times from `now` - kMemory on; earlier by less where more
  /// than kMaxEnded moves have ended since.
  void Plan(vm::Time now, T target, vm::Time start, vm::Time duration) {
    Prune(now);
    const bool jump = start == now && duration <= vm::Time(0);
    for (std::size_t i = spans_.size(); i-- > 0;) {
      const bool made = spans_[i].start < now ||
                        (spans_[i].start == now && spans_[i].duration <= vm::Time(0) && !jump);
      if (spans_[i].start < start || made) continue;
      Erase(i, i + 1);
    }
    spans_.push_back({start, duration});
    targets_.push_back(std::move(target));
  }
  void MoveTo(vm::Time now, T target, vm::Time duration) {
    Plan(now, std::move(target), now, duration);
  }
  /// Moves to `target` until `now` + `move`; begins late by `lag`, but by no more than half of that
  /// time. If `duration` is not zero, returns to T{} by `now` + `duration`, and either way takes at
  /// most half of it. Returns how long either way takes.
  vm::Time Visit(vm::Time now, T target, vm::Time move, vm::Time duration,
                 vm::Time lag = vm::Time(0)) {
    const bool returns = duration > vm::Time(0);
    if (returns) move = std::min(move, duration / 2);
    lag = std::min(lag, move / 2);
    Plan(now, std::move(target), now + lag, move - lag);
    if (returns) Plan(now, T{}, now + duration - move, move);
    return move;
  }

  T At(vm::Time t) const {
    const std::size_t first = RunningFrom(t);
    T value = first == 0 ? base_ : targets_[first - 1];
    for (std::size_t i = first; i < spans_.size(); ++i) {
      if (t < spans_[i].start) continue;
      value =
          Mix(value, targets_[i], SmootherStep(Progress(t, spans_[i].start, spans_[i].duration)));
    }
    return value;
  }

  /// Returns the value when every move begun by `t` will have ended.
  T TargetAt(vm::Time t) const {
    T value = base_;
    for (std::size_t i = 0; i < spans_.size(); ++i) {
      if (spans_[i].start <= t) value = targets_[i];
    }
    return value;
  }

 private:
  // Returns the index of the first move after the last that has ended by `t`, which hides all moves
  // before it.
  std::size_t RunningFrom(vm::Time t) const {
    std::size_t first = spans_.size();
    while (first > 0 && spans_[first - 1].start + spans_[first - 1].duration > t) --first;
    return first;
  }

  // Forgets the moves that are hidden since `now` - kMemory, and of those hidden now all but the
  // last kMaxEnded.
  void Prune(vm::Time now) {
    const std::size_t ended = RunningFrom(now);
    const std::size_t first =
        std::max(RunningFrom(now - kMemory), ended > kMaxEnded ? ended - kMaxEnded : 0);
    if (first == 0) return;
    base_ = targets_[first - 1];
    Erase(0, first);
  }

  void Erase(std::size_t from, std::size_t to) {
    const auto erase = [&](auto& list) {
      list.erase(list.begin() + static_cast<std::ptrdiff_t>(from),
                 list.begin() + static_cast<std::ptrdiff_t>(to));
    };
    erase(spans_);
    erase(targets_);
  }

  T base_{};
  std::vector<T> targets_;  // indexed as spans_
};

}  // namespace fsm
