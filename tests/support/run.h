#pragma once

#include <string>
#include <vector>

#include "tests/support/process.h"

namespace support {

/// What a program said from its start to its end.
struct Ran {
  int code = -1;
  std::vector<std::string> lines;
  std::string error;
  /// The lines as one text.
  std::string out() const {
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    return text;
  }
};

/// Runs a program to its end, at most four minutes; -1 where it had not ended.
inline Ran RunToEnd(const std::vector<std::string>& words, const std::string& input = "") {
  Process program(words);
  if (!input.empty()) program.Write(input);
  program.CloseInput();
  Ran ran;
  ran.lines = program.ReadAll(Millis{240'000});
  ran.code = program.Wait().value_or(-1);
  ran.error = program.ErrorText();
  return ran;
}

}  // namespace support
