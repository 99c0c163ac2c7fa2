#include "fsm/head/hair_springs.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <utility>
#include <vector>

#include "fsm/base/pi.h"
#include "fsm/base/smooth_step.h"

namespace fsm {
namespace {

struct SpringRow {
  float y;
  Spring spring;  // its positions are not set
};

class HairSprings {
 public:
  explicit HairSprings(const Table& table) {
    const TableRow& axis = table.Only("axis");
    axis_ = {axis.Number(1), 0, axis.Number(2)};
    around_ = static_cast<int>(table.Only("around").Within(1, 3, 64));
    still_ = table.Only("still").Number(1);
    float above = still_;
    for (const TableRow& row : table.RowsOf("row")) {
      rows_.push_back(RowOf(row, above));
      above = rows_.back().y;
    }
  }

  void Hang(std::size_t first, RigData& rig) {
    for (std::size_t v = first; v < rig.rest.size(); ++v) {
      HangVertex(static_cast<std::uint32_t>(v), rig);
    }
    for (const auto& [vertex, spring, weight] : rig.spring_rig.weights) {
      rig.spring_rig.springs[spring].rest += weight * rig.rest[vertex];
      hung_[spring] += weight;
    }
    for (std::size_t i = 0; i < rig.spring_rig.springs.size(); ++i) {
      Spring& spring = rig.spring_rig.springs[i];
      spring.rest /= hung_[i];
      const glm::vec3 beside = (spring.rest - axis_) * glm::vec3(1, 0, 1);
      spring.outward = glm::normalize(beside + glm::vec3(0, 0, 1e-3f));
      spring.root = glm::vec3(spring.rest.x, still_, spring.rest.z);
    }
  }

 private:
  static constexpr float kMinWeight = 0.01f;

  static SpringRow RowOf(const TableRow& row, float above) {
    constexpr float kMinApart = 1, kMinY = -1000;
    SpringRow made{.y = row.Within(1, kMinY, above - kMinApart), .spring = {}};
    made.spring.frequency_hz = row.Within(2, Spring::kMinHz, Spring::kMaxHz);
    made.spring.damping = row.Within(3, Spring::kMinDamping, Spring::kMaxDamping);
    made.spring.hang = row.Within(4, 0, 1);
    made.spring.reach_mm = row.Within(5, Spring::kMinReachMm, Spring::kMaxReachMm);
    row.EndsAt(6);
    return made;
  }

  void HangVertex(std::uint32_t v, RigData& rig) {
    const glm::vec3 p = rig.rest[v];
    if (p.y >= still_ || rows_.empty()) return;
    // The weight blends from the row above, or the height where hair stands still, to the row
    // below.
    std::size_t below = 0;
    while (below + 1 < rows_.size() && p.y < rows_[below].y) ++below;
    const float above_y = below == 0 ? still_ : rows_[below - 1].y;
    const float share = SmoothStep(above_y, rows_[below].y, p.y);
    HangOnRow(v, below, share, rig);
    if (below > 0) HangOnRow(v, below - 1, 1 - share, rig);
  }

  void HangOnRow(std::uint32_t v, std::size_t row, float weight, RigData& rig) {
    const glm::vec3 beside = rig.rest[v] - axis_;
    const float turn = std::atan2(beside.x, beside.z) / (2 * kPi) + 0.5f;
    const float place = turn * static_cast<float>(around_);
    const float second = place - std::floor(place);
    const int one = static_cast<int>(std::floor(place)) % around_;
    for (const auto& [column, share] :
         {std::pair(one, 1 - second), std::pair((one + 1) % around_, second)}) {
      // What does not turn with the head does not swing either.
      const float swings = weight * share * rig.weights[v].neck;
      if (swings < kMinWeight) continue;
      rig.spring_rig.weights.push_back({v, SpringAt(row, column, rig), swings});
    }
  }

  std::uint32_t SpringAt(std::size_t row, int column, RigData& rig) {
    const auto next = static_cast<std::uint32_t>(rig.spring_rig.springs.size());
    const auto [at, fresh] = at_.try_emplace({row, column}, next);
    if (fresh) {
      rig.spring_rig.springs.push_back(rows_[row].spring);
      hung_.push_back(0);
    }
    return at->second;
  }

  glm::vec3 axis_{0};
  int around_ = 0;
  float still_ = 0;
  std::vector<SpringRow> rows_;
  std::map<std::pair<std::size_t, int>, std::uint32_t> at_;
  std::vector<float> hung_;  // sum of the weights on each spring
};

}  // namespace

void AddHairSprings(const Table& table, std::size_t first, RigData& rig) {
  HairSprings(table).Hang(first, rig);
}

}  // namespace fsm
