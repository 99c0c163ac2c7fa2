// Tables of how one person's face moves, and of when a film shows it: no input may do more than be
// refused.

#include <cstdint>
#include <string_view>

#include "face_track/follow/unit_lesson.h"
#include "face_track/model/shown_units.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace facetrack;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const SeenFace& face = SeenFace::Shipped();
  if (const auto shown = ParseShownUnits("me.units", text, face))
    static_cast<void>(FaceOfPerson(face, *shown));
  auto lesson = UnitLesson::Parse("p.txt", text, face);
  if (!lesson) return 0;
  for (double ms = 0; ms < 5000; ms += 500) {
    FaceLine line;
    line.ms = ms;
    line.person = 1;
    line.points = face.rest;
    lesson->Add(line);
  }
  static_cast<void>(lesson->Finish());
  return 0;
}
