#include "fsm/rig/head.h"

#include <stdexcept>
#include <string>

namespace fsm {

Head::Head(HeadAsset asset)
    : topology_(std::make_shared<const HeadTopology>(std::move(asset.topology))),
      landmarks_(std::move(asset.landmarks)),
      view_(asset.view),
      rig_(std::move(asset.rig)) {}

std::unique_ptr<Head> Head::WithUnits(const UnitTable& units) const {
  auto other = std::make_unique<Head>(*this);
  other->rig_ = rig_.WithUnits(units);
  return other;
}

glm::vec3 Head::Landmark(std::string_view name) const {
  const auto found = landmarks_.find(name);
  if (found == landmarks_.end()) {
    throw std::out_of_range("there is no landmark '" + std::string(name) + "'");
  }
  return found->second;
}

}  // namespace fsm
