#pragma once

#include <string>

#include "fsm/image/image.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// Writes in the format of the name's extension: .png, .bmp (24 bit), .rgb (SGI, uncompressed RGB).
/// Errors: kBadValue for another ending, kUnavailable if the file cannot be written.
vm::Result<void> WriteImage(const Image& image, const std::string& path);
/// Reads .png, .bmp (24/32 bit uncompressed), .rgb (SGI) and .jpg, at most kMaxImageSide on each
/// side. Errors: those of vm::ReadTextFile; kBadValue.
vm::Result<Image> ReadImage(const std::string& path);

}  // namespace fsm
