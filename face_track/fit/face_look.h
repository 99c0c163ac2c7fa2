#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "face_fit/find/network/network_crop.h"
#include "face_fit/image/raster.h"

namespace facetrack {

/// A head's square of a picture in grey, each place beside what lies around it: less the mean there
/// and in parts of its deviation, so that light and shade that change slowly over a face are gone.
/// Pure; thread: any.
class FaceLook {
 public:
  static constexpr int kSide = 224;          ///< pixels; about 1.1 mm each
  static constexpr std::size_t kLevels = 2;  ///< from blurred to sharp

  FaceLook(const fsm::Image& picture, const facefit::NetworkCrop& crop);
  const facefit::NetworkCrop& crop() const { return crop_; }
  /// At a place in pixels of the picture: how bright it is, and how that changes to the right and
  /// down, for one pixel of the square.
  glm::vec3 At(std::size_t level, glm::vec2 place) const;
  /// One pixel of the picture to the right, or down, as pixels of the square.
  glm::mat2 Scale() const;

 private:
  facefit::NetworkCrop crop_;
  std::array<facefit::FloatImage, kLevels> levels_;
};

}  // namespace facetrack
