#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "embedded/base_emotions.h"
#include "face_space/app/commands.h"
#include "face_space/app/onset_plot.h"
#include "face_space/table/unit_tables.h"
#include "face_space/timing/onsets.h"
#include "vm_protocol/core/or_throw.h"
#include "vm_protocol/core/text_file.h"

namespace facespace {
namespace {

struct Options : TrackOptions {
  std::vector<std::string> tracks, timing;
  std::string plot, table_out;
};

constexpr double kFineMs = 10;  // between frames: lags of a few ms need as fine a track

std::string Lag(const std::optional<double>& lag) { return lag ? fmt::format("{:.1f}", *lag) : ""; }

void Run(const Options& options) {
  for (const std::string& track : options.tracks) {
    if (!options.plot.empty()) NotTheInput(options.plot, track);
    if (!options.table_out.empty()) NotTheInput(options.table_out, track);
  }
  if (options.timing.empty() != options.table_out.empty())
    throw std::runtime_error("--timing KIND EMOTION and --table-out FILE go together");
  const fsm::MotionTables tables = vm::OrThrow(fsm::MotionTables::Load(options.tables));
  OnsetPlot plot;
  std::vector<Onset> all;
  double widest_ms = 0;
  std::cout << "track,begins_ms,onset_ms,eye_lag_ms,brow_lag_ms,mouth_lag_ms,eye,brow,mouth\n";
  for (const std::string& path : options.tracks) {
    const UnitTrack track = ReadUnitTrack(path, options, tables);
    const std::vector<Onset> onsets = FindOnsets(track, tables.unit_list.regions);
    for (const Onset& onset : onsets) {
      std::cout << fmt::format("{},{:.1f},{:.1f},{},{},{},{:.3f},{:.3f},{:.3f}\n", path,
                               onset.begins_ms, onset.onset_ms, Lag(onset.lag_ms[0]),
                               Lag(onset.lag_ms[1]), Lag(onset.lag_ms[2]), onset.moved[0],
                               onset.moved[1], onset.moved[2]);
    }
    widest_ms = std::max(
        widest_ms, (track.ms.back() - track.ms.front()) / static_cast<double>(track.ms.size() - 1));
    if (!options.plot.empty())
      plot.Add(track, RegionCourses(track, tables.unit_list.regions), onsets);
    all.insert(all.end(), onsets.begin(), onsets.end());
  }
  if (!options.plot.empty()) vm::OrThrow(vm::WriteTextFile(options.plot, plot.Svg()));
  if (all.empty()) {
    throw std::runtime_error(fmt::format(
        "no expression comes in these tracks: a rise of all units together by {} expected",
        kLeastRise));
  }
  const Onset median = MedianOnset(all);
  if (!options.quiet) {
    std::cerr << fmt::format(
        "face_space: {} expressions; median: onset {:.0f} ms, lags of eyes {}, brows {}, mouth "
        "{}\n",
        all.size(), median.onset_ms, Lag(median.lag_ms[0]), Lag(median.lag_ms[1]),
        Lag(median.lag_ms[2]));
    if (widest_ms > kFineMs) {
      std::cerr << fmt::format(
          "face_space: frames are {:.0f} ms apart; lags of a few ms need a camera of {:.0f} frames "
          "a second or more\n",
          widest_ms, 1000 / kFineMs);
    }
  }
  if (options.table_out.empty()) return;
  const std::string table =
      vm::OrThrow(BaseTable(options.tables, "emotions.txt", embedded::base_emotions()));
  vm::OrThrow(vm::WriteTextFile(
      options.table_out,
      vm::OrThrow(WithTiming(table, options.timing[0], options.timing[1], median))));
}

}  // namespace

Command AddOnsets(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App& onsets = *app.add_subcommand(
      "onsets", "How expressions come in tracks: onset, and lags of eyes, brows and mouth");
  onsets
      .add_option("tracks", options->tracks,
                  "Tracks of units or of ARKit's shapes, as face_track prints them")
      ->required();
  onsets.add_option("--plot", options->plot, "Draws the three parts over time: a file .svg");
  onsets
      .add_option("--timing", options->timing,
                  "posed or elicited, and an emotion: whose row in fsm's emotions.txt is to have "
                  "the median of these onsets")
      ->expected(2);
  onsets.add_option("--table-out", options->table_out,
                    "Where that table goes: FOLDER/emotions.txt for fsm --tables FOLDER");
  AddTrackOptions(onsets, *options);
  return [options] { Run(*options); };
}

}  // namespace facespace
