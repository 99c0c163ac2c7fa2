#pragma once

#include <memory>

#include "fsm/head/make_head.h"
#include "fsm/head/photo_head.h"

namespace fsm {

/// A head that wears a photo: its skin fades into the neck, and a sheet of hair that is seen
/// through hangs before one of its sides.
inline std::unique_ptr<Head> WearingPhoto() {
  PhotoHead set;
  for (const glm::vec3 at : {glm::vec3(0), {50, 0, 0}, {0, 50, 0}, {0, 0, 50}, {50, 50, 20}}) {
    set.points.push_back({at, glm::vec3(0)});
  }
  set.atlas =
      std::make_shared<Image>(Image{2, 1, {200, 120, 90, 255, 60, 140, 50, 115}});  // skin, hair
  set.skin_low = {0.24F, 0.9F};
  set.skin_high = {0.26F, 0.1F};
  for (const glm::vec3 at : {glm::vec3(-90, 120, 60), {-90, -60, 60}, {0, -60, 60}, {0, 120, 60}}) {
    set.sheet.push_back({at, {0.75F, 0.5F}});
  }
  set.sheet_triangles = {0, 1, 2, 0, 2, 3};
  return MakeHead(set);
}

}  // namespace fsm
