#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "fsm/image/image.h"
#include "vm_protocol/core/result.h"

namespace facefit {

/// Longest side of a photo that is worked on, and of one that a part is cut from.
inline constexpr int kWorkingSize = 1600, kFineSize = 4800;

/// Reads a photo (JPEG or PNG, detected by content), sets it upright by its EXIF orientation and
/// scales it down until its longer side is at most `most_size`. 16-bit and grey images become
/// 8-bit RGB; CMYK is converted without a colour profile. Errors: kUnavailable (cannot be read),
/// kBadValue (what is wrong with it, and what is expected).
vm::Result<fsm::Image> ReadPhoto(const std::string& path, int most_size = kWorkingSize);
vm::Result<fsm::Image> DecodePhoto(std::span<const std::uint8_t> bytes,
                                   int most_size = kWorkingSize);

/// Returns the orientation, 1..8, of an EXIF block ("Exif\0\0" and a TIFF file); 1 if it has none
/// or is damaged.
int ExifOrientation(std::span<const std::uint8_t> block);

}  // namespace facefit
