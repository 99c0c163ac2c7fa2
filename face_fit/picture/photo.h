#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "fsm/image/image.h"
#include "vm_protocol/core/result.h"

namespace facefit {

/// The most pixels a photo may have, the longest side it is worked on with, and the longest that a
/// part of it is cut from.
inline constexpr std::int64_t kMaxPixels = 50'000'000;
inline constexpr int kWorkingSize = 1600, kFineSize = 4800;

/// Reads a photo, JPEG or PNG told apart by content, upright after its EXIF orientation, scaled
/// down to `most_size`. 16-bit and grey pictures become 8-bit RGB, CMYK is converted plainly.
/// Errors: kUnavailable (cannot be read), kBadValue (what is wrong with it, and what is expected).
vm::Result<fsm::Image> ReadPhoto(const std::string& path, int most_size = kWorkingSize);
vm::Result<fsm::Image> DecodePhoto(std::span<const std::uint8_t> bytes,
                                   int most_size = kWorkingSize);

/// The orientation 1..8 in an EXIF block ("Exif\0\0" and a TIFF file); 1 if it says nothing or is
/// damaged.
int ExifOrientation(std::span<const std::uint8_t> block);

}  // namespace facefit
