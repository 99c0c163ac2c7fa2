#pragma once

#include "face_fit/picture/photo.h"

namespace facefit {

/// As stored: not turned. `orientation` is that of its EXIF block. The picture is decoded at the
/// least of 1/1, 1/2, 1/4, 1/8 whose longer side is at least kWorkingSide.
vm::Result<fsm::Image> DecodeJpeg(std::span<const std::uint8_t> bytes, int& orientation);

}  // namespace facefit
