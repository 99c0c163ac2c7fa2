#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "face_fit/find/face/hand_points.h"
#include "face_fit/image/photo.h"
#include "fsm/head/photo_head.h"

/// The first byte chooses the reader: photos, EXIF blocks, points set by hand, face.txt.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::span bytes(data + 1, size - 1);
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0] % 4) {
    case 0: {
      const auto photo = facefit::DecodePhoto(bytes);
      if (photo && photo->rgba.size() != static_cast<std::size_t>(4) *
                                             static_cast<std::size_t>(photo->width) *
                                             static_cast<std::size_t>(photo->height)) {
        __builtin_trap();
      }
      break;
    }
    case 1: {
      const int turn = facefit::ExifOrientation(bytes);
      if (turn < 1 || turn > 8) __builtin_trap();
      break;
    }
    case 2:
      (void)facefit::ParseHandPoints("f", text);
      break;
    default:
      try {
        const auto set = fsm::ReadPhotoHead("f", text);
        for (const std::uint32_t i : set.sheet_triangles) {
          if (i >= set.sheet.size()) __builtin_trap();
        }
      } catch (const std::runtime_error&) {
        // said in words
      }
  }
  return 0;
}
