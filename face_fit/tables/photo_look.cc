#include "face_fit/tables/photo_look.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "embedded/photo_look.h"

namespace facefit {

const PhotoLookNumbers& PhotoLook() {
  static const PhotoLookNumbers look =
      CheckedPhotoLook(fsm::NumberTable("tables/photo_look.txt", embedded::photo_look()));
  return look;
}

PhotoLookNumbers CheckedPhotoLook(const fsm::NumberTable& table) {
  const PhotoLookNumbers look(table);
  struct Limits {
    const char* row;
    float least, greatest;
  };
  const glm::vec2 dome = look.hair.dome_by_width, width = look.bust.width_ratio;
  for (const auto& [row, least, greatest] :
       {Limits{"light_gain", look.light_gain.x, look.light_gain.y},
        {"other_side darkest", look.other_side.darkest, look.other_side.brightest},
        {"lips darkest", look.lips.darkest, 1},
        {"smile grain most_share", 0, look.smile.grain.most_share},
        {"bust width_ratio", width.x, width.y},
        {"bust width_ratio", 1, width.y},
        {"bust width_ratio_at_jaw", std::max(width.x, 1.0F), look.bust.width_ratio_at_jaw},
        {"shoulder fall_per_px", look.shoulder.fall_per_px.x, look.shoulder.fall_per_px.y},
        {"hair dome_by_width", dome.x, dome.y},
        {"hair dome_of_whole_edge", look.hair.dome_of_whole_edge, dome.y}}) {
    if (least <= greatest) continue;
    throw std::runtime_error("photo_look.txt: row '" + std::string(row) +
                             "': the least value exceeds the greatest");
  }
  return look;
}

}  // namespace facefit
