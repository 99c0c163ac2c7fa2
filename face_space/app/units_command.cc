#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <set>
#include <stdexcept>

#include "face_space/app/commands.h"
#include "face_space/app/unit_report.h"
#include "face_space/eigen/eigen_units.h"
#include "face_space/perform/performer.h"
#include "face_space/place/placement.h"
#include "face_space/record/recording.h"
#include "face_space/record/unit_track.h"
#include "face_space/table/unit_tables.h"
#include "fsm/base/parse_number.h"
#include "fsm/base/table_reader.h"
#include "fsm/head/make_head.h"
#include "vm_protocol/core/or_throw.h"
#include "vm_protocol/core/text_file.h"

namespace facespace {
namespace {

struct Options {
  std::vector<std::string> recordings;
  std::string out, labels, places, vectors, only = "both";
  double keep = 0.99, rate = 0, mm = 1;
  int face_vectors = 0, motion_vectors = 0;
  RestSettings rest;
  TableBase base;
  bool quiet = false;
};

/// Lines `FILE UNIT[:STRENGTH]...`, beside the recordings they speak of.
std::vector<std::vector<Label>> ReadLabels(const std::string& path,
                                           const std::vector<std::string>& recordings) {
  std::vector<std::vector<Label>> labels(recordings.size());
  const fsm::Table table(path, vm::OrThrow(fsm::ReadTableFile(path)));
  for (const fsm::TableRow& row : table.rows()) {
    const auto of = std::ranges::find_if(recordings, [&](const std::string& recording) {
      return recording == row.key() || std::filesystem::path(recording).filename() == row.key();
    });
    if (of == recordings.end()) row.Refuse("'" + row.key() + "' is none of the recordings");
    auto& units = labels[static_cast<std::size_t>(of - recordings.begin())];
    if (!units.empty() || row.size() < 2)
      row.Refuse("one line FILE UNIT[:STRENGTH]... for a recording expected");
    for (std::size_t i = 1; i < row.size(); ++i) {
      const std::string& word = row.Word(i);
      const std::size_t colon = word.find(':');
      Label label{.unit = word.substr(0, colon), .strength = 1};
      if (colon != word.npos) {
        const auto strength = fsm::ParseNumber(word.substr(colon + 1));
        if (!strength || *strength <= 0 || *strength > 2)
          row.Refuse("'" + word + "' found, UNIT:STRENGTH with a strength up to 2 expected");
        label.strength = *strength;
      }
      const bool plain = !label.unit.empty() && label.unit.size() <= 24 &&
                         std::ranges::all_of(label.unit, [](unsigned char c) {
                           return std::isalnum(c) || c == '_';
                         });
      if (!plain)
        row.Refuse("'" + word + "' found; up to 24 letters, digits and _ expected of a unit");
      units.push_back(std::move(label));
    }
  }
  return labels;
}

/// The recordings, and where their markers lie as far as that follows from what they are.
struct Material {
  std::vector<Recording> recordings;
  KnownPlaces places;
};
Material ReadMaterial(const Options& options, const fsm::Head& head) {
  Material out;
  const fsm::MotionTables tables = vm::OrThrow(fsm::MotionTables::Load(options.base.folder));
  std::optional<HeadSites> sites;
  TrackFormat format;
  if (options.rate > 0) format.rate = options.rate;
  Progress progress("reading recordings", options.quiet);
  for (const std::string& path : options.recordings) {
    const Track track = vm::OrThrow(ReadTrack(path, format));
    if (HasMarkers(track)) {
      out.recordings.push_back(vm::OrThrow(MarkersOf(track, options.mm)));
    } else {
      if (!HasUnits(track, tables)) {
        throw std::runtime_error(
            path +
            ": neither markers (NAME_x, NAME_y, NAME_z) nor units (au12L) nor ARKit's "
            "shapes (jawOpen) are among its columns");
      }
      if (!sites) sites = SitesOf(head);
      out.places = sites->places;
      out.recordings.push_back(RecordingOf(vm::OrThrow(UnitsOf(track, tables)), head, *sites));
    }
    if (out.recordings.size() > 1)
      vm::OrThrow(OrderAs(out.recordings.front(), out.recordings.back()));
    progress.At(static_cast<double>(out.recordings.size()) /
                static_cast<double>(options.recordings.size()));
  }
  if (!options.places.empty()) {
    out.places = vm::OrThrow(
        ReadPlaces(options.places, vm::OrThrow(fsm::ReadTableFile(options.places)), head));
  } else if (out.places.empty()) {
    out.places = PlacesByName(out.recordings.front().markers, head);
  }
  return out;
}

void WriteAll(const Options& options, const UnitTables& tables,
              const std::map<std::string, std::string>& moves) {
  const std::filesystem::path folder(options.out);
  std::filesystem::create_directories(folder / "moves");
  for (const auto& [name, text] : tables.files) {
    vm::OrThrow(vm::WriteTextFile((folder / name).string(), text));
  }
  for (const auto& [name, text] : moves) {
    vm::OrThrow(vm::WriteTextFile((folder / "moves" / name).string(), text));
  }
}

void Run(const Options& options) {
  for (const std::string& path : options.recordings) {
    NotTheInput(options.out, path);
    if (!options.vectors.empty()) NotTheInput(options.vectors, path);
  }
  if (!options.base.folder.empty()) NotTheInput(options.out, options.base.folder);
  // Both sides alike, as the tables describe them; which face it is does not matter to the tables.
  const std::unique_ptr<fsm::Head> head = fsm::MakeSymmetricHead("galatea");
  const Material material = ReadMaterial(options, *head);
  std::vector<std::vector<Label>> labels(material.recordings.size());
  if (!options.labels.empty()) labels = ReadLabels(options.labels, options.recordings);

  const StillFaces faces = vm::OrThrow(RemoveHeadMotion(material.recordings, options.rest));
  const EigenUnits eigen =
      vm::OrThrow(FindEigenUnits(faces, {.share = options.keep, .count = options.face_vectors},
                                 {.share = options.keep, .count = options.motion_vectors}));
  std::vector<RecordedUnit> recorded;
  if (!options.labels.empty()) recorded = vm::OrThrow(TakeApart(eigen, labels));
  std::cout << EigenReport(faces, eigen);
  if (!options.vectors.empty()) {
    vm::OrThrow(vm::WriteTextFile(options.vectors, VectorsCsv(faces.rest, eigen, recorded)));
  }
  if (options.out.empty()) return;

  const Placement placement = vm::OrThrow(PlaceMarkers(faces.rest, material.places, *head));
  std::vector<ShapeUnit> shapes;
  const bool both = options.only == "both";
  if (both || options.only == "recorded") {
    for (const RecordedUnit& unit : recorded)
      shapes.push_back({"Recorded" + unit.name, unit.moves});
  }
  if (both || options.only == "eigen") {
    for (const ShapeUnit& shape : EigenShapes(eigen)) shapes.push_back(shape);
  }
  if (shapes.empty()) throw std::runtime_error("--only recorded needs --labels");
  const UnitTables tables = vm::OrThrow(WriteUnits(shapes, placement, *head, options.base));
  WriteAll(options, tables, MotionLines(faces, eigen, tables.units));
  std::cout << TableReport(placement, faces.rest, tables, options.out);
}

}  // namespace

Command AddUnits(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App& units = *app.add_subcommand(
      "units",
      "Eigen-AUs: what a face does in recordings as units of fsm and as movements in time");
  units
      .add_option(
          "recordings", options->recordings,
          "Tracks of face_track with --landmarks, CSV or JSON lines of markers (time, NAME_x, "
          "NAME_y, NAME_z), or tracks of units or ARKit's shapes; each begins at rest")
      ->required();
  units.add_option("--out", options->out,
                   "Folder for the tables, as fsm --tables takes it (none: a report only)");
  units.add_option(
      "--labels", options->labels,
      "Which units recordings show: lines FILE UNIT[:STRENGTH]...; they are taken apart");
  units.add_option(
      "--places", options->places,
      "Where markers lie: lines place MARKER LANDMARK, or place MARKER X Y Z on galatea");
  units
      .add_option("--keep", options->keep,
                  "Part of the variance that is kept of each analysis (0.99)")
      ->check(CLI::Range(0.5, 0.9999));
  units.add_option("--vectors", options->face_vectors, "So many face vectors instead")
      ->check(CLI::Range(1, 100));
  units.add_option("--motions", options->motion_vectors, "So many motion vectors instead")
      ->check(CLI::Range(1, 100));
  units.add_option("--only", options->only, "Which become units: eigen, recorded or both")
      ->check(CLI::IsMember({"eigen", "recorded", "both"}));
  units.add_option("--vectors-out", options->vectors,
                   "The vectors themselves, mm at the markers: a file .csv");
  units
      .add_option("--still", options->rest.still, "Markers the face does not move (default: found)")
      ->delimiter(',');
  units.add_option("--rest", options->rest.rest_ms, "ms at rest at the beginning of each (200)")
      ->check(CLI::Range(0.0, 60'000.0));
  units
      .add_option("--rate", options->rate, "Frames a second of recordings without a column of time")
      ->check(CLI::Range(1.0, 10'000.0));
  units.add_option("--mm", options->mm, "Millimetres of one unit of length of the markers (1)")
      ->check(CLI::Range(1e-3, 1e4));
  units.add_option("--tables", options->base.folder, "Tables to add to, in place of fsm's own");
  units.add_option("--first", options->base.first_number, "Number of the first unit (801)")
      ->check(CLI::Range(47, 999));
  units.add_flag("--quiet", options->quiet, "No progress on standard error");
  return [options] { Run(*options); };
}

}  // namespace facespace
