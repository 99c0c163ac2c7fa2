#pragma once

#include <functional>
#include <iostream>
#include <string>
#include <utility>

namespace fsm {

/// Takes a line for people. One that begins with "notice: " warns: something is unusual, but the
/// program can go on.
using Log = std::function<void(const std::string& line)>;

/// Returns a log that writes "PROGRAM: LINE" to stderr.
inline Log StderrLog(std::string program) {
  return [program = std::move(program)](const std::string& line) {
    std::cerr << program << ": " << line << "\n";
  };
}

}  // namespace fsm
