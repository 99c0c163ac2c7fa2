#include "face_fit/find/head/front_view.h"

#include <algorithm>

#include "face_fit/find/head/rasterizer.h"

namespace facefit {

FrontView::FrontView(const fsm::HeadTopology& topology, std::span<const glm::vec3> position,
                     glm::vec2 low, glm::vec2 high)
    : topology_(topology),
      position_(position),
      low_(low),
      columns_(static_cast<int>(std::clamp(high.x - low.x, 1.0F, 200.0F) / kCell)),
      rows_(static_cast<int>(std::clamp(high.y - low.y, 1.0F, 200.0F) / kCell)),
      z_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), -1e9F),
      first_(z_.size(), kNone) {
  for (const auto& part : topology.parts) {
    if (IsHair(part.material) || part.material == fsm::Material::kShutLash) continue;
    for (std::uint32_t k = 0; k + 2 < part.index_count; k += 3) Draw(part.first_index + k);
  }
}

std::uint32_t FrontView::Triangle(int column, int row) const {
  if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return kNone;
  return first_[At(column, row)];
}

MeshPoint FrontView::Place(int column, int row) const {
  const std::uint32_t first = first_[At(column, row)];
  const std::uint32_t* t = &topology_.indices[first];
  const Triangle2 seen{position_[t[0]], position_[t[1]], position_[t[2]]};
  return {{t[0], t[1], t[2]}, seen.WeightsAt(Centre(column, row))};
}

void FrontView::Draw(std::uint32_t first) {
  const std::uint32_t* t = &topology_.indices[first];
  const auto cell = [this](glm::vec3 p) { return (glm::vec2(p) - low_) / kCell - 0.5F; };
  const Triangle2 seen{cell(position_[t[0]]), cell(position_[t[1]]), cell(position_[t[2]])};
  if (seen.SignedArea() <= 0) return;  // from behind
  Rasterize(seen, columns_, rows_, 0, [&](int column, int row, glm::vec3 weights) {
    const float z = Interpolated(position_, t, weights).z;
    if (z <= z_[At(column, row)]) return;
    z_[At(column, row)] = z;
    first_[At(column, row)] = first;
  });
}

}  // namespace facefit
