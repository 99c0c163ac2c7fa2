#include "fsm/image/image_codec.h"

#include <string>

namespace fsm {

vm::Result<void> CheckSize(std::int64_t width, std::int64_t height) {
  if (width >= 1 && height >= 1 && width <= kMaxImageSide && height <= kMaxImageSide) return {};
  return vm::Fail(vm::Errc::kBadValue, "its size " + std::to_string(width) + " x " +
                                           std::to_string(height) + " is not within 1 to " +
                                           std::to_string(kMaxImageSide));
}

vm::Result<Image> DecodePngOrJpeg(std::span<const std::uint8_t> bytes) {
  const bool jpeg = bytes.size() > 2 && bytes[0] == 0xff && bytes[1] == 0xd8;
  return jpeg ? DecodeJpeg(bytes) : DecodePng(bytes);
}

}  // namespace fsm
