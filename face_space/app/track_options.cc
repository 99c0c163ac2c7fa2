#include "face_space/app/commands.h"
#include "vm_protocol/core/or_throw.h"

namespace facespace {

void AddTrackOptions(CLI::App& command, TrackOptions& options) {
  command.add_option("--tables", options.tables, "Tables in place of fsm's own");
  command.add_option("--rate", options.rate, "Frames a second of tracks without a column of time")
      ->check(CLI::Range(1.0, 10'000.0));
  command.add_flag("--quiet", options.quiet, "No summary on standard error");
}

UnitTrack ReadUnitTrack(const std::string& path, const TrackOptions& options,
                        const fsm::MotionTables& tables) {
  TrackFormat format;
  if (options.rate > 0) format.rate = options.rate;
  return vm::OrThrow(UnitsOf(vm::OrThrow(ReadTrack(path, format)), tables));
}

}  // namespace facespace
