#pragma once

#include <vector>

#include "fsm/image/image.h"

namespace facetrack {

/// Tells where a film is cut: a picture looks unlike the one before, and not only because
/// something has moved within it.
class CutFinder {
 public:
  /// Whether `picture` is the first after a cut; the first of all is none. Not for several threads.
  bool IsCut(const fsm::Image& picture);

 private:
  std::vector<float> cells_;  // of the picture before; empty before the first
};

}  // namespace facetrack
