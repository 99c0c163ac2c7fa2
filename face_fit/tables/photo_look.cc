#include "face_fit/tables/photo_look.h"

#include "embedded/photo_look.h"

namespace facefit {

const PhotoLookNumbers& PhotoLook() {
  static const PhotoLookNumbers look(
      fsm::NumberTable("tables/photo_look.txt", embedded::photo_look()));
  return look;
}

}  // namespace facefit
