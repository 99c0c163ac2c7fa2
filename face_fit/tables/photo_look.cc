#include "face_fit/tables/photo_look.h"

#include "embedded/face_fit_appearance.h"

namespace facefit {

const fsm::NumberTable& PhotoLook() {
  static const fsm::NumberTable table("tables/appearance.txt", embedded::face_fit_appearance());
  return table;
}

}  // namespace facefit
