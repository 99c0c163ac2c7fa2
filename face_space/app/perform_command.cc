#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "face_space/app/commands.h"
#include "face_space/perform/performer.h"
#include "fsm/head/make_head.h"
#include "fsm/motion/base/unit_names.h"
#include "vm_protocol/core/or_throw.h"
#include "vm_protocol/core/text_file.h"

namespace facespace {
namespace {

struct Options {
  std::string folder, face = "galatea";
  std::vector<std::string> units = PaperUnits();
  std::size_t mixtures = 52;
  bool alone = true, any = false, quiet = false;
  Performer performer;
};

std::string CsvOf(const Recording& recording) {
  std::string text = "ms";
  for (const std::string& marker : recording.markers)
    text += fmt::format(",{0}_x,{0}_y,{0}_z", marker);
  for (Eigen::Index t = 0; t < recording.frames(); ++t) {
    text += fmt::format("\n{:.3f}", recording.ms[static_cast<std::size_t>(t)]);
    for (const double number : recording.places.col(t)) text += fmt::format(",{:.3f}", number);
  }
  return text + "\n";
}

void Run(const Options& options) {
  const std::unique_ptr<fsm::Head> head = fsm::MakeSymmetricHead(options.face);
  for (const std::string& unit : options.units) {
    if (!fsm::ParseUnitName(unit, fsm::UnitNames::BuiltIn()) ||
        unit.find_first_not_of("0123456789") != unit.npos) {
      throw std::runtime_error("'" + unit + "' is no number of a unit");
    }
  }
  const std::filesystem::path folder(options.folder);
  std::filesystem::create_directories(folder);
  const HeadSites sites = SitesOf(*head);
  std::string places = "# Where the markers lie on the built-in head, mm.\n",
              labels = "# Which units each recording shows.\n";
  for (const auto& [name, at] : sites.places) {
    places += fmt::format("place {} {:.3f} {:.3f} {:.3f}\n", name, at.x, at.y, at.z);
  }
  std::vector<std::vector<Label>> shown;
  if (options.alone) {
    for (const std::string& unit : options.units) shown.push_back({{unit, 1}});
  }
  for (auto& mixture :
       Mixtures(options.units, options.mixtures, *head, !options.any, options.performer.seed)) {
    shown.push_back(std::move(mixture));
  }
  Progress progress("performing", options.quiet);
  for (std::size_t i = 0; i < shown.size(); ++i) {
    std::string name;
    for (const Label& label : shown[i]) name += (name.empty() ? "au" : "+") + label.unit;
    name += ".csv";
    labels += name;
    for (const Label& label : shown[i]) labels += " " + label.unit;
    labels += "\n";
    vm::OrThrow(vm::WriteTextFile((folder / name).string(),
                                  CsvOf(Perform(options.performer, *head, sites, name, shown[i]))));
    progress.At(static_cast<double>(i + 1) / static_cast<double>(shown.size()));
  }
  vm::OrThrow(vm::WriteTextFile((folder / "places.txt").string(), places));
  vm::OrThrow(vm::WriteTextFile((folder / "labels.txt").string(), labels));
  if (!options.quiet)
    std::cerr << fmt::format("face_space: {} recordings in '{}'\n", shown.size(), options.folder);
}

}  // namespace

Command AddPerform(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App& perform = *app.add_subcommand(
      "perform",
      "Recordings of a built-in head that shows units alone and in mixtures, to try `units` on");
  perform.add_option("folder", options->folder, "Where recordings, labels.txt and places.txt go")
      ->required();
  perform.add_option("--units", options->units, "Units of FACS, by number")->delimiter(',');
  perform
      .add_option("--mixtures", options->mixtures, "How many mixtures of two to four of them (52)")
      ->check(CLI::Range(0, 1000));
  perform.add_flag("!--mixtures-only", options->alone, "None of a unit alone");
  perform.add_flag("--any", options->any,
                   "Mixtures, too, of units that act against each other in fsm's table");
  perform.add_option("--face", options->face, "A built-in face (galatea)");
  perform.add_option("--rate", options->performer.rate, "Frames a second (120)")
      ->check(CLI::Range(5.0, 1000.0));
  perform.add_option("--times", options->performer.times, "How often each (1)")
      ->check(CLI::Range(1, 20));
  perform.add_option("--noise", options->performer.noise_mm, "Deviation of coordinates, mm (0.15)")
      ->check(CLI::Range(0.0, 20.0));
  perform
      .add_option("--turn", options->performer.head_degrees,
                  "Degrees by which the head turns meanwhile (6)")
      ->check(CLI::Range(0.0, 45.0));
  perform.add_option("--seed", options->performer.seed, "Of all that happens by chance (1)");
  perform.add_flag("--quiet", options->quiet, "No progress on standard error");
  return [options] { Run(*options); };
}

}  // namespace facespace
