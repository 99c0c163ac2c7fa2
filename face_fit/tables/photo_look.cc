#include "face_fit/tables/photo_look.h"

#include "embedded/photo_look.h"

namespace facefit {
namespace {

const fsm::NumberTable& BuiltIn() {
  static const fsm::NumberTable table("tables/photo_look.txt", embedded::photo_look());
  return table;
}

}  // namespace

const PhotoLookNumbers& PhotoLook() {
  static const PhotoLookNumbers look(BuiltIn());
  return look;
}

PhotoLookNumbers PhotoLookOf(const std::string& name, std::string_view text) {
  return PhotoLookNumbers(fsm::NumberTable(name, text, &BuiltIn()));
}

}  // namespace facefit
