#pragma once

#include <string>

#include "vm_protocol/core/phonemes.h"
#include "vm_protocol/core/result.h"

namespace vdm {

/// Spoken phonemes of a file, `a[80] k[60]`, as align prints them, in any number of lines. At most
/// 1 MiB. Errors, which name the file: those of vm::ReadTextFile and vm::ParsePhonemes.
vm::Result<vm::PhonemeList> ReadPhonemeFile(const std::string& path);

}  // namespace vdm
