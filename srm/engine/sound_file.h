#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vm_protocol/core/result.h"

namespace srm {

/// Any sound file libsndfile reads, as 16 kHz mono; a file *.raw is 16 kHz 16 bit little endian. At
/// most two hours. Errors: kUnavailable (cannot be read), kBadValue (no sound, a rate out of
/// range), kTooLong.
vm::Result<std::vector<std::int16_t>> ReadSound(const std::string& path);

}  // namespace srm
