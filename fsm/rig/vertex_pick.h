#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace fsm {

/// Reduces data of a head to some of its vertices, which get new indices (OnlyVertices).
class VertexPick {
 public:
  /// `chosen`: vertices of the head, of which there are `count`, in their new order; outlives this.
  VertexPick(std::size_t count, std::span<const std::uint32_t> chosen)
      : chosen_(chosen), now_(count, kLeftOut) {
    for (std::uint32_t i = 0; i < chosen.size(); ++i) now_[chosen[i]] = i;
  }

  /// Returns the new index of a vertex. REQUIRES: it is chosen.
  std::uint32_t operator[](std::uint32_t vertex) const { return now_[vertex]; }
  /// Reduces an array that is per vertex, or empty.
  template <typename T>
  void PerVertex(std::vector<T>& all) const {
    if (all.empty()) return;
    std::vector<T> some;
    for (const std::uint32_t vertex : chosen_) some.push_back(all[vertex]);
    all = std::move(some);
  }
  /// Keeps the elements that name a chosen vertex in their member `vertex`.
  void VerticesOf(auto& list) const {
    std::erase_if(list, [this](const auto& item) { return now_[item.vertex] == kLeftOut; });
    for (auto& item : list) item.vertex = now_[item.vertex];
  }

 private:
  static constexpr std::uint32_t kLeftOut = ~0u;
  const std::span<const std::uint32_t> chosen_;
  std::vector<std::uint32_t> now_;  // new index by old index
};

}  // namespace fsm
