// The files of hypermask: whatever they hold, they are read or refused with a place, and what is
// read can be written and read again.

#include <cstdint>
#include <cstdlib>
#include <string>

#include "hypermask/base/mask_layout.h"
#include "hypermask/project/calibration.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto read = hypermask::ParseCalibration("f", text)) {
    if (!hypermask::ParseCalibration("f", hypermask::FormatCalibration(*read))) std::abort();
    const auto& layout = hypermask::MaskLayout::Default();
    for (const auto form :
         {hypermask::Form::kHomography, hypermask::Form::kAffine, hypermask::Form::kSpace}) {
      hypermask::MaskToProjector(*read, form, layout, layout.markers);
    }
  } else if (!read.error().text.starts_with("f:")) {
    std::abort();
  }
  if (const auto layout = hypermask::ParseMaskLayout("m", text);
      !layout && !layout.error().text.starts_with("m:")) {
    std::abort();
  }
  return 0;
}
