#pragma once

#include <fstream>
#include <sstream>
#include <string>

#include "fsm/motion/inputs/motion_tables.h"
#include "vm_protocol/core/phonemes.h"

namespace fsm {

/// "k 80 o 120": sounds and their milliseconds.
inline vm::PhonemeList List(const char* text) { return vm::ParsePhonemes(text).value(); }

/// The tables the program carries.
inline MotionTables BuiltIn() { return MotionTables::Load().value(); }

/// The text of a table of movement as the repository has it.
inline std::string TableText(const std::string& table) {
  std::ifstream in(std::string(GALATEA_SOURCE_DIR "/fsm/motion/tables/") + table);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace fsm
