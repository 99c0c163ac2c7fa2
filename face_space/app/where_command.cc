#include <fmt/format.h>

#include <fstream>
#include <iostream>
#include <map>
#include <memory>

#include "face_space/app/commands.h"
#include "face_space/emotion/whereabouts.h"
#include "vm_protocol/core/or_throw.h"
#include "vm_protocol/core/text_file.h"

namespace facespace {
namespace {

struct Options : TrackOptions {
  std::string track, out;
};

void Run(const Options& options) {
  if (!options.out.empty()) NotTheInput(options.out, options.track);
  const fsm::MotionTables tables = vm::OrThrow(fsm::MotionTables::Load(options.tables));
  const UnitTrack track = ReadUnitTrack(options.track, options, tables);
  std::string text = "ms,x,y,z,emotion,strength,held\n";
  std::map<std::string, std::size_t> seen;
  for (std::size_t t = 0; t < track.looks.size(); ++t) {
    const Whereabouts where = WhereIs(tables.emotion_space, track.looks[t]);
    ++seen[where.emotion];
    text += fmt::format("{:.1f},{:.3f},{:.3f},{:.3f},{},{:.2f},{:.2f}\n", track.ms[t], where.at[0],
                        where.at[1], where.at[2], where.emotion, where.strength, where.held);
  }
  if (options.out.empty()) {
    std::cout << text;
  } else {
    vm::OrThrow(vm::WriteTextFile(options.out, text));
  }
  if (options.quiet) return;
  std::cerr << "face_space:";
  for (const auto& [emotion, count] : seen) {
    std::cerr << fmt::format(
        " {} {:.0f} %", emotion,
        100.0 * static_cast<double>(count) / static_cast<double>(track.looks.size()));
  }
  std::cerr << std::endl;
}

}  // namespace

Command AddWhere(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App& where = *app.add_subcommand(
      "where", "Where the expressions of a track lie in the emotion space, a line a frame");
  where
      .add_option("track", options->track,
                  "A track of units or of ARKit's shapes, as face_track prints it")
      ->required();
  where.add_option("--out", options->out, "Where the lines go (default: standard output)");
  AddTrackOptions(where, *options);
  return [options] { Run(*options); };
}

}  // namespace facespace
