#include "fsm/rig/head.h"

#include <stdexcept>
#include <string>

namespace fsm {

Head::Head(HeadAsset asset)
    : surface_(std::make_shared<const HeadSurface>(std::move(asset.surface))),
      landmarks_(std::move(asset.landmarks)),
      view_(asset.view),
      rig_(std::move(asset.rig)) {}

Head::Head(const Head& other, Rig rig)
    : surface_(other.surface_),
      landmarks_(other.landmarks_),
      view_(other.view_),
      rig_(std::move(rig)) {}

std::unique_ptr<Head> Head::WithUnits(const UnitTable& units) const {
  return std::unique_ptr<Head>(new Head(*this, rig_.WithUnits(units)));
}

glm::vec3 Head::Landmark(std::string_view name) const {
  const auto found = landmarks_.find(name);
  if (found == landmarks_.end()) {
    throw std::out_of_range("there is no landmark '" + std::string(name) + "'");
  }
  return found->second;
}

}  // namespace fsm
