// Recordings of faces and tables of the emotion space: no input may do more than be refused.

#include <cstdint>
#include <string_view>

#include "face_space/eigen/eigen_units.h"
#include "face_space/emotion/space_training.h"
#include "face_space/record/recording.h"
#include "face_space/record/unit_track.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace facespace;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  static const fsm::MotionTables tables = fsm::MotionTables::Load().value();
  static_cast<void>(fsm::ReadEmotionSpace("e.txt", text, tables.unit_names));
  static_cast<void>(ReadAxes("a.txt", text));
  const auto track = ParseTrack("x.csv", text, {.rate = 30});
  if (!track) return 0;
  static_cast<void>(UnitsOf(*track, tables));
  const auto recording = MarkersOf(*track);
  if (!recording) return 0;
  const auto faces = RemoveHeadMotion({*recording}, {});
  if (!faces) return 0;
  static_cast<void>(FindEigenUnits(*faces, {.count = 3}, {.count = 3}));
  return 0;
}
