#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "face_space/record/unit_track.h"
#include "fsm/motion/inputs/motion_tables.h"

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

/// What commands that read tracks of units have in common.
struct TrackOptions {
  std::string tables;  ///< a folder; "" = fsm's own
  double rate = 0;     ///< frames a second of tracks without a column of time
  bool quiet = false;
};
void AddTrackOptions(CLI::App& command, TrackOptions& options);
/// Throws what is wrong with the file.
UnitTrack ReadUnitTrack(const std::string& path, const TrackOptions& options,
                        const fsm::MotionTables& tables);

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
