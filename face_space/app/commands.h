#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace facespace {

/// Says on standard error how far a command is: at a terminal in one line that changes, else a line
/// for each tenth. Not thread-safe.
class Progress {
 public:
  Progress(std::string what, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  void At(double share);

 private:
  const std::string what_;
  const bool quiet_, terminal_;
  int shown_ = -1;
};

/// What a command of the program does once its options are read; throws what it cannot do.
using Command = std::function<void()>;

// Each adds one command to the program and returns what it does.
Command AddUnits(CLI::App& app);
Command AddEmotions(CLI::App& app);
Command AddWhere(CLI::App& app);
Command AddOnsets(CLI::App& app);
Command AddPerform(CLI::App& app);

/// Throws if a file that is to be written is one that was read.
void NotTheInput(const std::string& out, const std::string& input);

}  // namespace facespace
