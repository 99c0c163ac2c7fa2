#include "fsm/image/image_codec.h"

namespace fsm {

bool SizeAllowed(std::int64_t width, std::int64_t height, std::string& why) {
  if (width >= 1 && height >= 1 && width <= kMaxImageSide && height <= kMaxImageSide) return true;
  why = "its size " + std::to_string(width) + " x " + std::to_string(height) +
        " is not within 1 to " + std::to_string(kMaxImageSide);
  return false;
}

std::optional<Image> DecodePicture(std::span<const std::uint8_t> bytes, std::string& why) {
  const bool jpeg = bytes.size() > 2 && bytes[0] == 0xff && bytes[1] == 0xd8;
  return jpeg ? DecodeJpeg(bytes, why) : DecodePng(bytes, why);
}

}  // namespace fsm
